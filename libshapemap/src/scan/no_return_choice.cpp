// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <locale>
#include <sstream>

#include "shapemap/core/errors.hpp"
#include "shapemap/scan/no_return.hpp"
#include "shapemap/scan/returns.hpp"

namespace shapemap {
namespace {

ConfigError misread(const std::string& word) {
  return ConfigError("--no-return-m has '" + word +
                     "', expected auto, none, or levels in metres, above 0 and up to 1000, such as 51.15 or "
                     "51.0-51.2, with commas between");
}

double level_m(const std::string& number, const std::string& word) {
  std::istringstream in(number);
  in.imbue(std::locale::classic());
  double value_m = 0.0;
  if (!(in >> value_m) || !in.eof()) throw misread(word);
  if (!(value_m > 0.0 && value_m <= kLongestRange_m)) throw misread(word);
  return value_m;
}

NoReturnChoice::Band band_of(const std::string& word) {
  const std::size_t dash = word.find('-');
  if (dash == std::string::npos) return {level_m(word, word), level_m(word, word)};
  const NoReturnChoice::Band band{level_m(word.substr(0, dash), word), level_m(word.substr(dash + 1), word)};
  if (band.to_m < band.from_m) throw misread(word);
  return band;
}

}  // namespace

NoReturnChoice no_return_choice(const std::string& text) {
  NoReturnChoice choice;
  if (text == "auto") return choice;
  choice.is_learned = false;
  if (text == "none") return choice;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) choice.given.push_back(band_of(word));
  if (choice.given.empty() || text.back() == ',') throw misread(text);
  return choice;
}

}  // namespace shapemap

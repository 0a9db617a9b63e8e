// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "shapemap/core/errors.hpp"
#include "shapemap/io/atomic_file.hpp"
#include "shapemap/io/map_files.hpp"

namespace shapemap {
namespace {

std::string extension_of(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  std::string extension = dot == std::string::npos || path[dot] != '.' ? "" : path.substr(dot);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

constexpr double kUnknownGrey = 127.0;  // the grey of unknown cells

struct Palette {
  cv::Scalar path;
  cv::Scalar start;
  cv::Scalar scale_bar;
};

/// Colours are blue, green and red; a grey picture gets greys that neither walls nor free space have.
Palette palette_for(bool colour) {
  if (colour) return {{30, 30, 220}, {60, 160, 30}, {160, 60, 20}};
  return {cv::Scalar(90), cv::Scalar(60), cv::Scalar(60)};
}

/// Returns 1, 2 or 5 times a power of ten, at most a quarter of the width.
double scale_bar_length_m(double map_width_m) {
  const double longest_m = map_width_m / 4.0;
  const double decade = std::pow(10.0, std::floor(std::log10(longest_m)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * decade <= longest_m) return factor * decade;
  }
  return decade;
}

std::string length_text(double length_m) {
  char text[32];
  if (length_m >= 1.0) {
    std::snprintf(text, sizeof text, "%.0f m", length_m);
  } else {
    std::snprintf(text, sizeof text, "%g cm", length_m * 100.0);
  }
  return text;
}

/// Puts a strip with a scale bar above the picture, where it hides nothing. Below it would move the origin, which is
/// the lower left corner.
cv::Mat with_scale_bar(const cv::Mat& image, const OccupancyGrid& map, const cv::Scalar& ink) {
  const double length_m = scale_bar_length_m(map.width_cells * map.resolution_m);
  const int length = std::max(1, static_cast<int>(std::lround(length_m / map.resolution_m)));
  const int size = std::clamp(std::min(image.cols, image.rows) / 200, 1, 8);
  const int height = 20 * size;
  cv::Mat framed;
  cv::copyMakeBorder(image, framed, height, 0, 0, 0, cv::BORDER_CONSTANT, cv::Scalar::all(kUnknownGrey));
  const cv::Point left(4 * size, height - 1 - 4 * size);
  cv::line(framed, left, left + cv::Point(length, 0), ink, size);
  for (const int end : {0, length}) {
    cv::line(framed, left + cv::Point(end, -2 * size), left + cv::Point(end, 2 * size), ink, size);
  }
  cv::putText(framed, length_text(length_m), left + cv::Point(0, -4 * size), cv::FONT_HERSHEY_SIMPLEX, 0.35 * size, ink,
              std::max(1, size / 2), cv::LINE_8);
  return framed;
}

void draw_path(cv::Mat& image, const OccupancyGrid& map, const std::vector<PlacedScan>& placed,
               const Palette& palette) {
  std::vector<cv::Point> path;
  for (const PlacedScan& place : placed) {
    const Eigen::Vector2i pixel = map.pixel_at(place.map_from_robot.translation());
    path.emplace_back(pixel.x(), pixel.y());
  }
  const int radius = std::clamp(static_cast<int>(0.1 / map.resolution_m), 1, 12);
  cv::polylines(image, path, false, palette.path, std::max(1, radius / 2));
  for (const cv::Point& at : path) cv::circle(image, at, radius, palette.path, cv::FILLED);
  if (!path.empty()) cv::circle(image, path.front(), radius + 1, palette.start, cv::FILLED);
}

}  // namespace

void write_map_image(const OccupancyGrid& map, const std::string& path, const std::vector<PlacedScan>* path_to_draw) {
  const std::string extension = extension_of(path);
  if (extension != ".png" && extension != ".pgm" && extension != ".tif") {
    throw OutputError("'" + path + "' is no picture we write; its name must end in .png, .pgm or .tif");
  }
  // OpenCV only reads from this view; the drawing goes to a copy.
  const cv::Mat grey(map.height_cells, map.width_cells, CV_8UC1, const_cast<std::uint8_t*>(map.grey.data()));
  cv::Mat image = grey;
  std::vector<unsigned char> encoded;
  bool ok = false;
  try {
    if (path_to_draw) {
      const bool colour = extension != ".pgm";
      image = cv::Mat();
      if (colour) {
        cv::cvtColor(grey, image, cv::COLOR_GRAY2BGR);
      } else {
        grey.copyTo(image);
      }
      const Palette palette = palette_for(colour);
      draw_path(image, map, *path_to_draw, palette);
      image = with_scale_bar(image, map, palette.scale_bar);
    }
    ok = cv::imencode(extension, image, encoded);
  } catch (const cv::Exception& e) {
    throw OutputError("cannot draw '" + path + "': OpenCV says: " + e.err);
  }
  if (!ok) throw OutputError("cannot draw '" + path + "': OpenCV could not encode it");
  write_file(path, std::string(encoded.begin(), encoded.end()));
}

}  // namespace shapemap

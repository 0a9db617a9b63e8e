// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/version.h>
#include <mrpt/version.h>

#include <Eigen/Core>
#include <opencv2/core/version.hpp>

#include "shapemap/core/version.hpp"
#include "shapemap/io/report.hpp"

namespace shapemap {
namespace {

/// MRPT gives its version as one number, 0xABC for A.B.C.
std::string mrpt_version() {
  const auto digit = [](int shift) { return std::to_string((MRPT_VERSION >> shift) & 0xF); };
  return digit(8) + "." + digit(4) + "." + digit(0);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> component_versions() {
  const std::string eigen = std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
                            std::to_string(EIGEN_MINOR_VERSION);
  return {{"shapemap", kVersion},
          {"MRPT", mrpt_version()},
          {"OpenCV", CV_VERSION},
          {"CGAL", CGAL_VERSION_STR},
          {"Eigen", eigen}};
}

}  // namespace shapemap

// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/core/version.hpp"

#include "shapemap/io/report.hpp"

namespace shapemap {

std::vector<std::pair<std::string, std::string>> component_versions() {
  // The build system found these packages, so that their headers stay where they are used.
  return {{"shapemap", kVersion},
          {"MRPT", SHAPEMAP_MRPT_VERSION},
          {"OpenCV", SHAPEMAP_OPENCV_VERSION},
          {"CGAL", SHAPEMAP_CGAL_VERSION},
          {"Eigen", SHAPEMAP_EIGEN_VERSION}};
}

}  // namespace shapemap

# SPDX-License-Identifier: GPL-3.0-or-later
# Every third-party package, with its lowest supported version, in one place.
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nanoflann 1.4 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(mrpt-obs 2.5 REQUIRED)   # scan types and the rawlog format
find_package(mrpt-maps 2.5 REQUIRED)  # occupancy grid
find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc imgcodecs)
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
find_package(CGAL 5.5 REQUIRED)       # polyline simplification
find_package(Ceres 2.1 REQUIRED)      # pose graph
if(SHAPEMAP_BUILD_APPS OR SHAPEMAP_BUILD_BASELINES)
  find_package(CLI11 2.1 REQUIRED)
endif()
if(SHAPEMAP_BUILD_BASELINES)
  find_package(mrpt-slam 2.5 REQUIRED)  # the methods of MRPT that ours is compared with
endif()
if(SHAPEMAP_BUILD_TESTS)
  find_package(GTest 1.12 REQUIRED)
  find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)
endif()
if(SHAPEMAP_BUILD_BENCHMARKS)
  find_package(benchmark 1.7 REQUIRED)
endif()

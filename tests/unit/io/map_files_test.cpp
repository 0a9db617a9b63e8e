// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/map_files.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "shapemap/core/errors.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

class MapFiles : public testing::Test {
 protected:
  std::string in_folder(const std::string& name) const { return folder_.path(name); }

  test::TempFolder folder_;
};

/// A robot at (2, 1) faces north and sees a wall 3 m ahead, 1 m to its right, and nothing to its left.
struct World {
  Log log;
  std::vector<PlacedScan> placed;
  Point2 wall_ahead_m{2.0, 4.0};
  Point2 wall_right_m{3.0, 1.0};

  World() {
    Sweep sweep;
    sweep.ranges_m = {1.0F, 3.0F, NAN};
    sweep.first_angle_rad = -kPi / 2;
    sweep.angle_step_rad = kPi / 2;
    log.scans.push_back({12.5, {sweep}, std::nullopt, std::nullopt});
    placed.push_back({0, 12.5, {2.0, 1.0, kPi / 2}, {Pose2{}}});
  }
  OccupancyGrid map() const {
    return build_occupancy_grid(log.scans, placed, ReturnOptions{}, OccupancyGridOptions{0.07});
  }
};

/// Reads the numbers of a map.yaml in the way of ROS map_server.
struct RosMap {
  double resolution = 0.0;
  double origin_x = 0.0;
  double origin_y = 0.0;

  explicit RosMap(const std::string& yaml) {
    const char* const format = "image: \"%*[^\"]\"\nresolution: %lf\norigin: [%lf, %lf, 0]";
    EXPECT_EQ(std::sscanf(yaml.c_str(), format, &resolution, &origin_x, &origin_y), 3) << yaml;
  }
  /// For map_server, the origin is the lower left corner of the lower left pixel, and row 0 is the top of the picture.
  int grey_at(const cv::Mat& image, const Point2& p_m) const {
    const int column = static_cast<int>(std::floor((p_m.x() - origin_x) / resolution));
    const int row = image.rows - 1 - static_cast<int>(std::floor((p_m.y() - origin_y) / resolution));
    return image.at<std::uint8_t>(row, column);
  }
};

TEST_F(MapFiles, RosFindsTheWallsWhereTheyStand) {
  const World world;
  const OccupancyGrid map = world.map();
  const RosMap ros(ros_map_yaml(map, "map.png"));
  for (const char* name : {"map.png", "map.pgm", "map.tif", "map.PNG"}) {
    write_map_image(map, in_folder(name), nullptr);
    const cv::Mat image = cv::imread(in_folder(name), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(image.type(), CV_8UC1) << name;
    ASSERT_EQ(image.cols, map.width_cells);
    EXPECT_LT(ros.grey_at(image, world.wall_ahead_m), 0.35 * 255) << name;
    EXPECT_LT(ros.grey_at(image, world.wall_right_m), 0.35 * 255) << name;
    EXPECT_GT(ros.grey_at(image, {2.0, 2.5}), 0.5 * 255) << name;
    const double unknown_occupancy = (255.0 - ros.grey_at(image, {2.5, 3.0})) / 255.0;
    EXPECT_GT(unknown_occupancy, 0.196);
    EXPECT_LT(unknown_occupancy, 0.65);
  }
}

TEST_F(MapFiles, YamlSaysHowGreysAreMeant) {
  OccupancyGrid map;
  map.resolution_m = 0.05;
  map.origin_m = {-12.35, 0.1 + 0.2};
  EXPECT_EQ(ros_map_yaml(map, "a \"b\".png"),
            "image: \"a \\\"b\\\".png\"\nresolution: 0.05\norigin: [-12.35, 0.30000000000000004, 0]\n"
            "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\nmode: trinary\n");
}

TEST_F(MapFiles, APathIsDrawnInColourOrInGrey) {
  const World world;
  const OccupancyGrid map = world.map();
  const Eigen::Vector2i robot = map.pixel_at(world.placed[0].map_from_robot.translation());
  write_map_image(map, in_folder("map.png"), &world.placed);
  const cv::Mat colour = cv::imread(in_folder("map.png"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(colour.type(), CV_8UC3);
  ASSERT_EQ(colour.cols, map.width_cells);
  // the strip is above the map, whose lower left corner is the origin
  const int strip = colour.rows - map.height_cells;
  ASSERT_GT(strip, 0);
  const cv::Vec3b start = colour.at<cv::Vec3b>(strip + robot.y(), robot.x());
  EXPECT_GT(start[1], start[2]) << "the first scan is green";

  write_map_image(map, in_folder("map.pgm"), &world.placed);
  const cv::Mat grey = cv::imread(in_folder("map.pgm"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(grey.type(), CV_8UC1);
  EXPECT_NE(grey.at<std::uint8_t>(strip + robot.y(), robot.x()),
            map.grey[static_cast<std::size_t>(robot.y() * map.width_cells + robot.x())]);
  const Eigen::Vector2i wall = map.pixel_at(world.wall_ahead_m);
  const std::uint8_t wall_grey = map.grey[static_cast<std::size_t>(wall.y() * map.width_cells + wall.x())];
  EXPECT_EQ(colour.at<cv::Vec3b>(strip + wall.y(), wall.x()), cv::Vec3b(wall_grey, wall_grey, wall_grey));
}

TEST_F(MapFiles, TheScaleBarHidesNothing) {
  const World world;
  const OccupancyGrid map = world.map();
  write_map_image(map, in_folder("map.pgm"), &world.placed);
  const cv::Mat image = cv::imread(in_folder("map.pgm"), cv::IMREAD_UNCHANGED);
  const int strip = image.rows - map.height_cells;
  cv::Mat cells(map.height_cells, map.width_cells, CV_8UC1, const_cast<std::uint8_t*>(map.grey.data()));
  int num_drawn = 0;
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.cols; ++x) {
      if (image.at<std::uint8_t>(strip + y, x) == cells.at<std::uint8_t>(y, x)) continue;
      ++num_drawn;
      const Point2 at_m = map.origin_m + map.resolution_m * Point2(x + 0.5, map.height_cells - y - 0.5);
      EXPECT_LT((at_m - world.placed[0].map_from_robot.translation()).norm(), 0.4) << x << ' ' << y;
    }
  }
  EXPECT_GT(num_drawn, 0);
}

TEST_F(MapFiles, AnotherEndingIsRefusedAndNothingIsLeft) {
  const OccupancyGrid map = World().map();
  for (const char* name : {"map.jpg", "map", "map.png.gz", ".png/map"}) {
    EXPECT_THROW(write_map_image(map, in_folder(name), nullptr), OutputError) << name;
  }
  EXPECT_THROW(write_map_image(map, in_folder("missing/map.png"), nullptr), OutputError);
  EXPECT_TRUE(folder_.names().empty());
}

TEST(TumTrajectory, HasOneLinePerScanWithAUnitQuaternion) {
  const std::vector<PlacedScan> placed{{0, 1234567890.123456, {1.5, -2.25, kPi / 2}, {}}, {3, 2.0, {}, {}}};
  std::istringstream lines(tum_trajectory(placed));
  double t, x, y, z, qx, qy, qz, qw;
  ASSERT_TRUE(lines >> t >> x >> y >> z >> qx >> qy >> qz >> qw);
  EXPECT_NEAR(t, 1234567890.123456, 1e-6);
  EXPECT_DOUBLE_EQ(x, 1.5);
  EXPECT_DOUBLE_EQ(y, -2.25);
  EXPECT_EQ(z, 0.0);
  EXPECT_EQ(qx * qx + qy * qy, 0.0);
  EXPECT_NEAR(2 * std::atan2(qz, qw), kPi / 2, 1e-11);
  ASSERT_TRUE(lines >> t >> x >> y >> z >> qx >> qy >> qz >> qw);
  EXPECT_EQ(qw, 1.0);
  EXPECT_FALSE(lines >> t);
}

TEST(TumTrajectory, RefusesNumbersThatFitNoLine) { EXPECT_THROW(tum_trajectory({{0, 1e300, {}, {}}}), OutputError); }

}  // namespace
}  // namespace shapemap

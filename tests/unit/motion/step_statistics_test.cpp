// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion/step_statistics.hpp"

#include <gmock/gmock.h>

#include "shapemap/graph/odometry_edge.hpp"

namespace shapemap {
namespace {

ChainLink link_of(double step_m, double turn_rad, double probability) {
  ChainLink link;
  link.alternatives.push_back({{step_m, 0.0, turn_rad}, Eigen::Matrix3d::Identity(), 0.0});
  link.probability = probability;
  return link;
}

TEST(UsualMotion, NineteenOfTwentySureStepsAreShorter) {
  std::vector<ChainLink> links;
  for (int k = 1; k <= 100; ++k) links.push_back(link_of(0.02 * k, (k % 2 == 0 ? 1 : -1) * k * kDegree, 0.99));
  links.insert(links.begin() + 40, link_of(50.0, 3.0, 0.5));
  links.insert(links.begin() + 20, ChainLink{});
  const UsualMotion usual = usual_motion(sure_steps(links));
  EXPECT_NEAR(usual.step_m, 1.92, 1e-9);
  EXPECT_NEAR(usual.turn_rad, 96 * kDegree, 1e-9);
}

TEST(UsualMotion, IsNotLessThanARobotThatStoodStillCouldDo) {
  for (const std::vector<ChainLink>& links :
       {std::vector<ChainLink>{}, std::vector<ChainLink>(30, link_of(0.01, 0.001, 0.99))}) {
    EXPECT_EQ(usual_motion(sure_steps(links)).step_m, 0.3);
    EXPECT_EQ(usual_motion(sure_steps(links)).turn_rad, 30 * kDegree);
  }
}

}  // namespace
}  // namespace shapemap

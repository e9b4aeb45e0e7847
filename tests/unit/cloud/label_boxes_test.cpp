// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/label_boxes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

namespace saccade {
namespace {

/// Points inside a box that is turned about `up`, its corners among them.
std::vector<Eigen::Vector3f> filled(const Eigen::Vector3d& size, double yaw_rad, const Eigen::Vector3d& center,
                                    const Eigen::Matrix3d& T_cloud_box) {
  std::mt19937 random{7};
  std::uniform_real_distribution<double> within{-0.5, 0.5};
  const Eigen::Matrix3d turn = T_cloud_box * Eigen::AngleAxisd{yaw_rad, Eigen::Vector3d::UnitZ()}.toRotationMatrix();
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 200; ++i) {
    Eigen::Array3d share{within(random), within(random), within(random)};
    if (i < 8) share = {(i & 1) - 0.5, (i >> 1 & 1) - 0.5, (i >> 2 & 1) - 0.5};
    points.emplace_back((center + turn * (share * size.array()).matrix()).cast<float>());
  }
  return points;
}

/// Angle between two lines.
double between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, std::abs(a.dot(b))));
}

TEST(LabelBoxes, AreTheRectanglesOfLeastArea) {
  const Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d camera = Eigen::AngleAxisd{M_PI / 2.0, Eigen::Vector3d::UnitX()}.toRotationMatrix();
  const Eigen::Matrix3d tilted = Eigen::AngleAxisd{0.6, Eigen::Vector3d{1, 2, 0}.normalized()}.toRotationMatrix();
  for (const Eigen::Matrix3d& frame : {upright, camera, tilted}) {
    for (const double yaw_rad : {0.0, 0.4, 1.5, 2.0, 3.0}) {
      const Eigen::Vector3d size{0.5, 0.2, 0.3};
      const Eigen::Vector3d center{1.0, -2.0, 0.5};
      std::vector<Eigen::Vector3f> points = filled(size, yaw_rad, center, frame);
      std::vector<std::uint32_t> labels(points.size(), 4);
      points.push_back({9, 9, 9});
      labels.push_back(0);
      points.push_back(Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
      labels.push_back(4);
      const auto boxes = label_boxes(points, labels, frame.col(2));
      ASSERT_EQ(boxes.size(), 1U);
      EXPECT_EQ(boxes[0].label, 4U);
      EXPECT_EQ(boxes[0].points, 200U);
      EXPECT_TRUE(boxes[0].size_m.isApprox(size, 1e-5)) << boxes[0].size_m.transpose();
      EXPECT_TRUE(boxes[0].center_m.isApprox(center, 1e-5)) << boxes[0].center_m.transpose();
      const Eigen::Vector3d along{std::cos(yaw_rad), std::sin(yaw_rad), 0.0};
      EXPECT_LT(between(boxes[0].axes.col(0), frame * along), 1e-3) << yaw_rad;
      EXPECT_NEAR(boxes[0].axes.determinant(), 1.0, 1e-9);
    }
  }
}

TEST(LabelBoxes, OfPointsAndLinesHaveNoWidth) {
  const std::vector<Eigen::Vector3f> points{{1, 2, 3}, {0, 0, 0}, {3, 4, 1}};
  const auto boxes = label_boxes(points, std::vector<std::uint32_t>{2, 7, 7}, Eigen::Vector3d::UnitZ());
  ASSERT_EQ(boxes.size(), 2U);
  EXPECT_TRUE(boxes[0].size_m.isZero());
  EXPECT_TRUE(boxes[0].center_m.isApprox(Eigen::Vector3d{1, 2, 3}));
  EXPECT_TRUE(boxes[1].size_m.isApprox(Eigen::Vector3d{5, 0, 1}, 1e-9)) << boxes[1].size_m.transpose();
  EXPECT_TRUE(label_boxes({}, {}, Eigen::Vector3d::UnitZ()).empty());
}

}  // namespace
}  // namespace saccade

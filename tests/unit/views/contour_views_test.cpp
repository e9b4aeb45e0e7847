// SPDX-License-Identifier: Apache-2.0
// Views of contour points: where they stand, where they look, in which order.
#include "saccade/views/contours.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace saccade {
namespace {

constexpr double kRadPerDegree{std::numbers::pi / 180.0};
const std::vector<ContourPoint> kPoints{{{0.1, 0.2, 0.3}, Eigen::Vector3d{1.0, -2.0, 0.5}.normalized(), 7},
                                        {{-0.1, 0.0, 0.0}, Eigen::Vector3d::UnitZ(), 1},
                                        {{0.0, 0.4, -0.2}, -Eigen::Vector3d::UnitX(), 2},
                                        {{0.0, 0.0, 0.9}, Eigen::Vector3d{1e-4, 0.0, -1.0}.normalized(), 3}};

double angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }
/// From the point to the camera.
Eigen::Vector3d direction_of(const Pose& T, const ContourPoint& point) {
  return (T.translation() - point.position_m).normalized();
}

TEST(ContourViews, LookAtThePointFromTheirDistanceInDocumentedOrder) {
  ContourViewConfig config;
  config.distances_m = {0.8, 0.5, 1.1};
  ASSERT_EQ(config.views_per_point(), 120U);
  const auto views = contour_views(kPoints, config);
  ASSERT_TRUE(views.ok());
  ASSERT_EQ(views->size(), kPoints.size() * 120);
  for (std::size_t i = 0; i < views->size(); ++i) {
    const Pose& T = (*views)[i];
    const ContourPoint& point = kPoints[i / 120];
    const double distance_m = config.distances_m[i / 40 % 3];
    EXPECT_LT((T * Eigen::Vector3d{0.0, 0.0, distance_m} - point.position_m).norm(), 1e-12);
    EXPECT_LT((T.linear() * T.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_GT(T.linear().determinant(), 0.0);
    const double tilt_rad = i / 8 % 5 == 0 ? 0.0 : 15.0 * kRadPerDegree;
    EXPECT_NEAR(angle_rad(direction_of(T, point), point.normal), tilt_rad, 1e-9);
    const Pose upright = look_at(T.translation(), point.position_m);
    const double roll_rad = static_cast<double>(i % 8) * 45.0 * kRadPerDegree;
    EXPECT_LT((T.linear() - upright.linear() * Eigen::AngleAxisd{roll_rad, Eigen::Vector3d::UnitZ()}).norm(), 1e-9);
  }
}

TEST(ContourViews, DefaultsGive40PerPoint) {
  EXPECT_EQ(ContourViewConfig{}.views_per_point(), 40U);
  EXPECT_EQ(contour_views(kPoints)->size(), 40 * kPoints.size());
  EXPECT_TRUE(contour_views({})->empty());
}

TEST(ContourViews, FourDirectionsAreTiltedTowardsTheSidesOfTheImage) {
  const std::vector<Pose> views = contour_views(kPoints).value();
  for (std::size_t p = 0; p < kPoints.size(); ++p) {
    const Eigen::Matrix3d to_image = views[40 * p].linear().transpose();
    const auto tilted_to = [&](std::size_t direction) {
      return Eigen::Vector3d{to_image * direction_of(views[40 * p + 8 * direction], kPoints[p])};
    };
    const double sine = std::sin(15.0 * kRadPerDegree);
    EXPECT_LT((tilted_to(1).head<2>() - Eigen::Vector2d{sine, 0.0}).norm(), 1e-9);
    EXPECT_LT((tilted_to(2).head<2>() - Eigen::Vector2d{0.0, -sine}).norm(), 1e-9);
    EXPECT_LT((tilted_to(3).head<2>() - Eigen::Vector2d{-sine, 0.0}).norm(), 1e-9);
    EXPECT_LT((tilted_to(4).head<2>() - Eigen::Vector2d{0.0, sine}).norm(), 1e-9);
  }
}

TEST(ContourViews, BadConfigurationsAreRefused) {
  constexpr double kNaN{std::numeric_limits<double>::quiet_NaN()};
  constexpr double kInfinity{std::numeric_limits<double>::infinity()};
  const auto refused = [](const auto& change) {
    ContourViewConfig config;
    change(config);
    const auto views = contour_views(kPoints, config);
    return !config.validate().ok() && !views.ok() && views.error().code == Errc::invalid_argument;
  };
  EXPECT_TRUE(refused([](ContourViewConfig& config) { config.distances_m.clear(); }));
  for (const double bad : {0.0, -1.0, kNaN, kInfinity}) {
    EXPECT_TRUE(refused([&](ContourViewConfig& config) { config.distances_m.push_back(bad); })) << bad;
    EXPECT_TRUE(refused([&](ContourViewConfig& config) { config.roll_step_rad = bad; })) << bad;
    EXPECT_TRUE(refused([&](ContourViewConfig& config) { config.cone_rad = bad; })) << bad;
  }
  EXPECT_TRUE(refused([](ContourViewConfig& config) { config.cone_rad = 1.6; }));
  EXPECT_TRUE(refused([](ContourViewConfig& config) { config.roll_step_rad = 1e-7; }));
}

TEST(ContourViews, BadPointsAreRefused) {
  constexpr double kNaN{std::numeric_limits<double>::quiet_NaN()};
  const auto refused = [](const ContourPoint& point) {
    const auto views = contour_views(std::vector<ContourPoint>{kPoints[0], point});
    return !views.ok() && views.error().code == Errc::invalid_argument;
  };
  EXPECT_TRUE(refused({{kNaN, 0.0, 0.0}, Eigen::Vector3d::UnitX(), 1}));
  EXPECT_TRUE(refused({{0.0, 0.0, 0.0}, {0.0, kNaN, 1.0}, 1}));
  EXPECT_TRUE(refused({{0.0, 0.0, 0.0}, Eigen::Vector3d::Zero(), 1}));
  ContourViewConfig many;
  many.roll_step_rad = 1e-5;
  EXPECT_TRUE(many.validate().ok());
  EXPECT_FALSE(contour_views(kPoints, many).ok());  // more than ten million
}

}  // namespace
}  // namespace saccade

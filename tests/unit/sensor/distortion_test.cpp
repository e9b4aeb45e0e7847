// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/distortion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <span>
#include <vector>

namespace saccade {
namespace {

using Eigen::Vector2d;

// A wide lens, and the depth camera of a Kinect.
constexpr Distortion kLens{-0.28, 0.09, 0.0006, -0.0004, -0.01};

TEST(Distortion, UndistortInvertsDistort) {
  constexpr std::uint64_t kSeed{42};
  std::mt19937_64 random{kSeed};
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
  std::size_t cases = 0;
  for (int lens = 0; lens < 200; ++lens) {
    const Distortion d{0.4 * uniform(random), 0.1 * uniform(random), 0.005 * uniform(random), 0.005 * uniform(random),
                       0.02 * uniform(random)};
    for (int i = 0; i < 20; ++i) {
      const Vector2d ideal{0.7 * uniform(random), 0.55 * uniform(random)};
      if (!d.regular_at(1.05 * ideal)) continue;
      const auto back = d.undistort(d.distort(ideal));
      ASSERT_TRUE(back) << ideal.transpose();
      EXPECT_LT((*back - ideal).norm(), 1e-9);
      ++cases;
    }
  }
  std::cout << "seed " << kSeed << ", cases " << cases << "\n";
  EXPECT_GT(cases, 3500U);
}

TEST(Distortion, MatchesTheFormulaByHand) {
  const Vector2d p = Distortion{0.1, 0.0, 0.01, 0.02, 0.0}.distort({0.5, -0.4});
  const double r2 = 0.41;
  EXPECT_NEAR(p.x(), 0.5 * (1 + 0.1 * r2) + 2 * 0.01 * 0.5 * -0.4 + 0.02 * (r2 + 2 * 0.25), 1e-15);
  EXPECT_NEAR(p.y(), -0.4 * (1 + 0.1 * r2) + 0.01 * (r2 + 2 * 0.16) + 2 * 0.02 * 0.5 * -0.4, 1e-15);
}

TEST(Distortion, RationalLensIsInvertedToo) {
  // The depth camera of an Azure Kinect, to three digits.
  const Distortion lens{3.13, 2.32, 8.13e-5, -5.12e-5, 0.130, 3.46, 3.35, 0.663};
  const double r2 = 0.41;
  const double radial = (1 + r2 * (3.13 + r2 * (2.32 + r2 * 0.130))) / (1 + r2 * (3.46 + r2 * (3.35 + r2 * 0.663)));
  const Vector2d p = lens.distort({0.5, -0.4});
  EXPECT_NEAR(p.x(), 0.5 * radial + 2 * 8.13e-5 * 0.5 * -0.4 - 5.12e-5 * (r2 + 2 * 0.25), 1e-15);
  EXPECT_GT(lens.regular_radius(), 1.2);
  for (double x = -1.2; x < 1.2; x += 0.05) {
    const Vector2d ideal{x, 0.3 * x - 0.1};
    const auto back = lens.undistort(lens.distort(ideal));
    ASSERT_TRUE(back) << ideal.transpose();
    EXPECT_LT((*back - ideal).norm(), 1e-9) << ideal.transpose();
  }
  const Distortion pole{.k4 = -1.0};  // grows without bound towards r = 1
  EXPECT_TRUE(pole.regular_at({0.9, 0.0}));
  EXPECT_FALSE(pole.regular_at({1.1, 0.0}));
  EXPECT_LT(pole.regular_radius(), 1.0);
}

TEST(Distortion, CoefficientsBeyondTheEighthAreNoLens) {
  const std::vector<double> twelve{1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0, 0};
  EXPECT_EQ(Distortion::from_coefficients(twelve), (Distortion{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(Distortion::from_coefficients(std::span{twelve}.first(4)), (Distortion{1, 2, 3, 4}));
  EXPECT_FALSE(Distortion::from_coefficients(std::vector<double>{0, 0, 0, 0, 0, 0, 0, 0, 1e-3}));
}

TEST(Distortion, FoldedPartOfTheModelIsNotUsed) {
  const Distortion barrel{.k1 = -0.5};
  EXPECT_TRUE(barrel.regular_at({0.5, 0.0}));
  EXPECT_FALSE(barrel.regular_at({1.2, 0.0}));  // r (1 − r²/2) falls beyond r = 0.82
  EXPECT_FALSE(barrel.undistort({0.9, 0.0}));   // farther out than any point goes
}

PinholeCamera wide_camera() { return {320, 240, 200.0, 210.0, 158.0, 121.0, 0.1, 10.0}; }

TEST(Undistorter, WithoutDistortionNothingChanges) {
  const auto undistorter = Undistorter::create(wide_camera(), {});
  ASSERT_TRUE(undistorter);
  DepthImage depth{320, 240};
  ColorImage color{320, 240};
  std::mt19937 random{1};
  for (std::size_t i = 0; i < depth.size(); ++i) {
    depth.data()[i] = static_cast<float>(random() % 5000) * 1e-3F;
    color.data()[i] = {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()), 7};
  }
  EXPECT_EQ(*undistorter->undistort(depth), depth);
  EXPECT_EQ(*undistorter->undistort(color), color);
}

TEST(Undistorter, RectifiesAPicture) {
  // The raw picture of a scene whose brightness is a smooth function of the viewing direction.
  const PinholeCamera camera = wide_camera();
  const auto brightness = [](const Vector2d& p) { return 128.0 + 60.0 * std::sin(6.0 * p.x()) + 60.0 * p.y(); };
  DepthImage raw_depth{camera.width, camera.height};
  ColorImage raw_color{camera.width, camera.height};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const auto ideal = kLens.undistort(camera.ray(u, v).head<2>());
      if (!ideal) continue;
      raw_color(u, v) = {static_cast<std::uint8_t>(std::lround(brightness(*ideal))), 0, 0};
      raw_depth(u, v) = ideal->x() < 0.0 ? 1.0F : 3.0F;  // an edge between two surfaces
    }
  }
  const auto undistorter = Undistorter::create(camera, kLens);
  ASSERT_TRUE(undistorter);
  const auto depth = undistorter->undistort(raw_depth);
  const auto color = undistorter->undistort(raw_color);
  ASSERT_TRUE(depth && color);
  std::size_t checked = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const float d = (*depth)(u, v);
      EXPECT_TRUE(d == 0.0F || d == 1.0F || d == 3.0F) << d;  // never blended
      const Vector2d ideal = camera.ray(u, v).head<2>();
      if (d == 0.0F) continue;
      EXPECT_NEAR((*color)(u, v)[0], brightness(ideal), 2.0) << u << " " << v;
      if (std::abs(ideal.x()) > 1.0 / camera.fx) {
        EXPECT_EQ(d, ideal.x() < 0.0 ? 1.0F : 3.0F) << u << " " << v;
      }
      ++checked;
    }
  }
  EXPECT_GT(checked, 70000U);
}

TEST(Undistorter, BadInputIsRefused) {
  EXPECT_FALSE(Undistorter::create(wide_camera(), Distortion{.k1 = std::numeric_limits<double>::quiet_NaN()}));
  PinholeCamera camera = wide_camera();
  camera.fx = -1.0;
  EXPECT_FALSE(Undistorter::create(camera, kLens));
  const auto undistorter = Undistorter::create(wide_camera(), kLens);
  ASSERT_TRUE(undistorter);
  EXPECT_EQ(undistorter->undistort(DepthImage{2, 2}).error().code, Errc::size_mismatch);
  EXPECT_EQ(undistorter->undistort(ColorImage{2, 2}).error().code, Errc::size_mismatch);
}

}  // namespace
}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/shortcut.hpp"

#include <gtest/gtest.h>

#include "support/effort.hpp"
#include "support/sliding_arms.hpp"
#include "support/trajectory_checks.hpp"

namespace saccade {
namespace {

using test::joints;

constexpr int kTries{60};

struct Asked {
  Configuration from;
  Configuration to;
  bool free;
};

/// Tells whether a disc is between two points of a plane.
bool passes(const Configuration& from, const Configuration& to, const Configuration& center, double radius) {
  return test::distance_from_line(center, from, to) > radius;
}

/// Two joints as a plane, and a disc in it.
struct Plane {
  ArmModel arm{test::plane_arm({JointKind::revolute, JointKind::revolute})};
  Configuration center{joints({0.0, 0.0})};
  double radius{1.0};
  std::vector<Asked> asked;

  [[nodiscard]] JointPath cut(const JointPath& path, int tries, std::uint64_t seed) {
    asked.clear();
    return shortcut(
        arm, path,
        [&](const Configuration& from, const Configuration& to) {
          asked.push_back({from, to, passes(from, to, center, radius)});
          return asked.back().free;
        },
        tries, seed);
  }
};

/// Around the disc, zigzag.
JointPath around(std::uint64_t seed) {
  std::mt19937_64 random{seed};
  JointPath path;
  for (int i = 0; i <= 24; ++i) {
    const double angle_rad = std::numbers::pi * i / 24;
    const double out = 1.5 + std::uniform_real_distribution<double>{-0.3, 0.9}(random);
    path.push_back(joints({-out * std::cos(angle_rad), out * std::sin(angle_rad)}));
  }
  return path;
}

bool is_part(const Configuration& a, const Configuration& b, const Configuration& from, const Configuration& to) {
  return test::distance_from_line(a, from, to) < 1e-9 && test::distance_from_line(b, from, to) < 1e-9;
}

TEST(Shortcut, NoPathOrOneLineIsLeftAlone) {
  Plane plane;
  EXPECT_TRUE(plane.cut({}, kTries, 1).empty());
  const Configuration a = joints({-2.0, 0.0});
  const Configuration b = joints({0.0, 2.0});
  EXPECT_EQ(plane.cut({a}, kTries, 1), JointPath{a});
  EXPECT_EQ(plane.cut({a, b}, kTries, 1), (JointPath{a, b}));
  EXPECT_TRUE(plane.asked.empty());
}

TEST(Shortcut, WhatIsFreeBecomesOneLine) {
  Plane plane;
  plane.radius = 0.0;
  plane.center = joints({9.0, 9.0});
  const JointPath path = around(1);
  EXPECT_EQ(plane.cut(path, kTries, 1), (JointPath{path.front(), path.back()}));
  EXPECT_EQ(plane.asked.size(), 1U);
}

TEST(Shortcut, WithoutChordsCornersAreStillLeftOut) {
  Plane plane;
  const JointPath path = around(2);
  const JointPath cut = plane.cut(path, 0, 1);
  EXPECT_LT(cut.size(), path.size());
  for (const Configuration& q : cut) EXPECT_NE(std::find(path.begin(), path.end(), q), path.end());
}

TEST(Shortcut, GainsTimeAlongFreeLinesAlone) {
  Plane plane;
  double before_s = 0.0;
  double after_s = 0.0;
  const int cases = test::scaled_cases(100);
  for (int i = 0; i < cases; ++i) {
    SCOPED_TRACE(i);
    const JointPath path = around(static_cast<std::uint64_t>(i));
    const JointPath cut = plane.cut(path, kTries, static_cast<std::uint64_t>(i));
    ASSERT_GE(cut.size(), 3U);
    EXPECT_EQ(cut.front(), path.front());
    EXPECT_EQ(cut.back(), path.back());
    EXPECT_LE(rest_to_rest_s(plane.arm, cut), rest_to_rest_s(plane.arm, path) + 1e-12);
    before_s += rest_to_rest_s(plane.arm, path);
    after_s += rest_to_rest_s(plane.arm, cut);
    for (std::size_t line = 0; line + 1 < cut.size(); ++line) {
      EXPECT_TRUE(passes(cut[line], cut[line + 1], plane.center, plane.radius - 1e-9));
      bool known{false};
      for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        known = known || is_part(cut[line], cut[line + 1], path[k], path[k + 1]);
      }
      for (const Asked& one : plane.asked) {
        known = known || (one.free && is_part(cut[line], cut[line + 1], one.from, one.to));
      }
      EXPECT_TRUE(known) << "line " << line << " was never asked about";
    }
    // Lines answered as free are used: the last one is in the path.
    const auto last = std::find_if(plane.asked.rbegin(), plane.asked.rend(), [](const Asked& one) { return one.free; });
    ASSERT_NE(last, plane.asked.rend());
    const auto from = std::find(cut.begin(), cut.end(), last->from);
    ASSERT_NE(from, cut.end());
    EXPECT_NE(std::find(from, cut.end(), last->to), cut.end());
  }
  EXPECT_LT(after_s, 0.7 * before_s);
}

TEST(Shortcut, OneSeedGivesOnePath) {
  Plane plane;
  const JointPath path = around(7);
  const JointPath cut = plane.cut(path, kTries, 3);
  EXPECT_EQ(plane.cut(path, kTries, 3), cut);
  bool others_differ{false};
  for (std::uint64_t seed = 4; seed < 10; ++seed) others_differ = others_differ || plane.cut(path, kTries, seed) != cut;
  EXPECT_TRUE(others_differ);
}

TEST(Shortcut, EndsWhereNothingIsFree) {
  Plane plane;
  const JointPath path = around(8);
  int asked = 0;
  const JointPath cut = shortcut(
      plane.arm, path, [&](const Configuration&, const Configuration&) { return ++asked < 0; }, kTries, 1);
  EXPECT_EQ(cut, path);
  EXPECT_LE(asked, 24 * 23 / 2 + kTries);
}

}  // namespace
}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
// Contour voxels and their normals on maps written by hand.
#include "saccade/views/contours.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "support/written_map.hpp"

namespace saccade {
namespace {

constexpr std::int16_t kNearSurface{1000};
const Index3 kMiddle{0, 7, -1};  // at the border of bricks and sectors along every axis
const Voxel kOften{kNearSurface, 100};
const Voxel kRarely{kNearSurface, 4};
const Voxel kSolid{-kNearSurface, 5};

struct ByPlace {
  bool operator()(const Index3& a, const Index3& b) const { return zyx_less(a, b); }
};
using Voxels = std::map<Index3, Voxel, ByPlace>;

/// Everything within 12 voxels of the middle is known and empty, but for these.
TsdfSnapshot map_with(const Voxels& voxels) {
  TsdfSnapshot map;
  map.config.voxel_size_m = 0.01;
  for (int z = -3; z < 3; ++z) {
    for (int y = -3; y < 3; ++y) {
      for (int x = -3; x < 3; ++x) {
        const Index3 brick{x, y, z};
        BrickRef ref = BrickRef::constant_free(map.config.free_weight);
        for (const auto& [voxel, content] : voxels) {
          if (!(parent(voxel) == brick)) continue;
          DenseBrick& dense = ref.densify();
          dense.v[static_cast<std::size_t>(child_index(voxel))] = content.v;
          dense.w[static_cast<std::size_t>(child_index(voxel))] = content.w;
          dense.update_masks();
        }
        test::set_brick(map, brick, std::move(ref));
      }
    }
  }
  return map;
}

std::vector<ContourVoxel> contours_of(const TsdfSnapshot& map, const ContourConfig& config = {}) {
  return contour_voxels(map, config, {}).value();
}

/// Tells whether the middle is a contour voxel.
bool middle_is_found(const TsdfSnapshot& map) {
  for (const ContourVoxel& found : contours_of(map)) {
    if (found.voxel == kMiddle) return true;
  }
  return false;
}

TEST(Contours, AreEmptyVoxelsWithAnUnknown6NeighbourAndAnOccupied18Neighbour) {
  int found{0};
  for (int u = 0; u < 27; ++u) {
    for (int o = 0; o < 27; ++o) {
      if (u == o || u == 13 || o == 13) continue;
      const Index3 to_unknown{u % 3 - 1, u / 3 % 3 - 1, u / 9 - 1};
      const Index3 to_occupied{o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1};
      const auto length = [](const Index3& step) { return step.x * step.x + step.y * step.y + step.z * step.z; };
      const TsdfSnapshot map = map_with({{kMiddle + to_unknown, kRarely}, {kMiddle + to_occupied, kSolid}});
      const bool expected = length(to_unknown) == 1 && length(to_occupied) <= 2;
      ASSERT_EQ(middle_is_found(map), expected) << u << ' ' << o;
      found += expected ? 1 : 0;
    }
  }
  EXPECT_EQ(found, 6 * 17);
}

TEST(Contours, TakeForKnownWhatWasObservedFiveTimes) {
  const Index3 x = kMiddle + Index3{1, 0, 0};
  const Index3 y = kMiddle + Index3{0, 1, 0};
  EXPECT_TRUE(middle_is_found(map_with({{x, {kNearSurface, 4}}, {y, kSolid}})));
  EXPECT_FALSE(middle_is_found(map_with({{x, {kNearSurface, 5}}, {y, kSolid}})));
  EXPECT_FALSE(middle_is_found(map_with({{x, {}}, {y, {-kNearSurface, 4}}})));
  EXPECT_FALSE(middle_is_found(map_with({{x, {}}, {y, kSolid}, {kMiddle, {kNearSurface, 4}}})));
  EXPECT_FALSE(middle_is_found(map_with({{x, {}}, {y, kSolid}, {kMiddle, kSolid}})));
  EXPECT_TRUE(middle_is_found(map_with({{x, {}}, {y, {0, 5}}})));  // v = 0 is occupied
  ContourConfig config;
  config.known_weight = 1;
  EXPECT_FALSE(contours_of(map_with({{x, {kNearSurface, 1}}, {y, {-kNearSurface, 1}}}), config).size() > 0);
  EXPECT_TRUE(contours_of(map_with({{x, {}}, {y, {-kNearSurface, 1}}}), config).size() > 0);
}

TEST(Contours, LieWithUnknownNeighboursInTheWorkspace) {
  TsdfSnapshot map = map_with({{kMiddle + Index3{1, 0, 0}, {}}, {kMiddle + Index3{0, 1, 0}, kSolid}});
  const auto set_workspace = [&](const Index3& lo, const Index3& hi) {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.005);
    map.config.workspace = Box{voxel_center(lo, 0.01) - half, voxel_center(hi, 0.01) - half};
  };
  const Index3 more{20, 20, 20};
  set_workspace(kMiddle - more, kMiddle + more);
  EXPECT_TRUE(middle_is_found(map));
  set_workspace(kMiddle - more, {kMiddle.x + 2, kMiddle.y + 1, kMiddle.z + 1});  // without the occupied voxel
  EXPECT_TRUE(middle_is_found(map));
  set_workspace(kMiddle - more, {kMiddle.x + 1, kMiddle.y + 20, kMiddle.z + 20});  // without the unknown voxel
  EXPECT_FALSE(middle_is_found(map));
  EXPECT_TRUE(contours_of(map).empty());
  set_workspace({kMiddle.x + 1, kMiddle.y - 20, kMiddle.z - 20}, kMiddle + more);  // without the middle
  EXPECT_FALSE(middle_is_found(map));
  EXPECT_FALSE(contours_of(map).empty());
}

/// The normal of the middle.
Eigen::Vector3d normal_of(const TsdfSnapshot& map) {
  for (const ContourVoxel& found : contours_of(map)) {
    if (found.voxel == kMiddle) return found.normal.cast<double>();
  }
  return Eigen::Vector3d::Zero();
}

/// Eq. 3.5 added up by hand; the 24 other neighbours count the same and cancel out, but for what they have no opposite.
TEST(Contours, NormalsPointAwayFromUnknownAndOccupiedVoxels) {
  const Index3 x = kMiddle + Index3{1, 0, 0};
  const Index3 xy = kMiddle + Index3{1, 1, 0};
  // -5 at +x and 5 at -x; the edge at -x-y counts 5 and has -5 opposite.
  const double diagonal = 10.0 / std::numbers::sqrt2;
  Eigen::Vector3d expected{-10.0 - diagonal, -diagonal, 0.0};
  EXPECT_LT((normal_of(map_with({{x, {}}, {xy, kSolid}})) - expected.normalized()).norm(), 1e-6);
  // Observed three times is two less than enough.
  expected = {-7.0 - diagonal, -diagonal, 0.0};
  EXPECT_LT((normal_of(map_with({{x, {kNearSurface, 3}}, {xy, kSolid}})) - expected.normalized()).norm(), 1e-6);
  // v = 0 is occupied.
  expected = {-10.0 - diagonal, -diagonal, 0.0};
  EXPECT_LT((normal_of(map_with({{x, {}}, {xy, {0, 9}}})) - expected.normalized()).norm(), 1e-6);
  // Near a surface seven observations are two more than enough, and a hundred count as ten do.
  expected = {-7.0 - diagonal, -diagonal, 0.0};
  const Index3 opposite = kMiddle - Index3{1, 0, 0};
  const Voxel seven{kNearSurface, 7};
  EXPECT_LT((normal_of(map_with({{x, {}}, {xy, kSolid}, {opposite, seven}})) - expected.normalized()).norm(), 1e-6);
  expected = {-10.0 - diagonal, -diagonal, 0.0};
  EXPECT_LT((normal_of(map_with({{x, {}}, {xy, kSolid}, {opposite, kOften}})) - expected.normalized()).norm(), 1e-6);
}

/// Where the map's weight ends at five, five may be any number; it does so only where v = 1.
TEST(Contours, SaturatedFreeSpaceCountsAsSeenOften) {
  const Index3 x = kMiddle + Index3{1, 0, 0};
  const Index3 y = kMiddle + Index3{0, 1, 0};
  const auto normal_with = [&](const Voxel& opposite) {
    return normal_of(map_with({{x, {}}, {y, kSolid}, {kMiddle - Index3{1, 0, 0}, opposite}}));
  };
  const auto expected = [](double opposite) { return Eigen::Vector3d{-5.0 - opposite, -10.0, 0.0}.normalized(); };
  EXPECT_LT((normal_with({kTsdfOne, 5}) - expected(5.0)).norm(), 1e-6);
  EXPECT_LT((normal_with({kTsdfOne, 7}) - expected(2.0)).norm(), 1e-6);
  EXPECT_LT((normal_with({kNearSurface, 5}) - expected(0.0)).norm(), 1e-6);
}

TEST(Contours, UnknownSpaceOutsideTheWorkspaceCountsNothingInNormals) {
  const Index3 x = kMiddle + Index3{1, 0, 0};
  const Index3 z = kMiddle + Index3{0, 0, 1};
  TsdfSnapshot map = map_with({{x, {}}, {kMiddle + Index3{0, 1, 0}, kSolid}, {z, {}}});
  const Eigen::Vector3d all{-10.0, -10.0, -10.0};
  EXPECT_LT((normal_of(map) - all.normalized()).norm(), 1e-6);
  const Eigen::Vector3d far = Eigen::Vector3d::Constant(1.0);
  map.config.workspace = Box{-far, {1.0, 1.0, voxel_center(z, 0.01).z() - 0.005}};
  const Eigen::Vector3d without_z{-10.0, -10.0, -5.0};
  EXPECT_LT((normal_of(map) - without_z.normalized()).norm(), 1e-6);
}

TEST(Contours, VoxelsWithoutADirectionAreLeftOut) {
  Voxels between{{kMiddle + Index3{1, 0, 0}, {}},
                 {kMiddle - Index3{1, 0, 0}, {}},
                 {kMiddle + Index3{0, 1, 0}, kSolid},
                 {kMiddle - Index3{0, 1, 0}, kSolid}};
  EXPECT_FALSE(middle_is_found(map_with(between)));
  between[kMiddle - Index3{0, 1, 0}] = kOften;
  EXPECT_TRUE(middle_is_found(map_with(between)));
}

TEST(Contours, ComeBySectorBrickAndVoxelAndHaveUnitNormals) {
  Voxels scattered;
  for (int i = -9; i < 9; i += 3) {
    for (int k = -9; k < 9; k += 3) {
      scattered[{i, k, i + k}] = {};
      scattered[{i + 1, k + 1, i + k}] = kSolid;
    }
  }
  const std::vector<ContourVoxel> found = contours_of(map_with(scattered));
  EXPECT_GT(found.size(), 40U);
  const auto rank = [](const Index3& voxel) {
    const Index3 sector = parent(parent(voxel));
    const int of_sector = ((sector.z + 8) * 16 + sector.y + 8) * 16 + sector.x + 8;
    return (of_sector * kSectorBricks + child_index(parent(voxel))) * kBrickVoxels + child_index(voxel);
  };
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].normal.norm(), 1.0, 1e-6);
    if (i > 0) {
      EXPECT_LT(rank(found[i - 1].voxel), rank(found[i].voxel));
    }
  }
}

TEST(Contours, OfNothingAreNone) {
  EXPECT_TRUE(contours_of({}).empty());
  EXPECT_TRUE(contours_of(map_with({})).empty());
  LiveContours live = LiveContours::create().value();
  EXPECT_EQ(live.update({}, {}).bricks_changed, 0U);
  EXPECT_TRUE(live.voxels().empty());
  EXPECT_TRUE(live.points().empty());
}

TEST(Contours, ThatFollowAMapDoNothingWhereNothingChanged) {
  const TsdfSnapshot map = map_with({{kMiddle + Index3{1, 0, 0}, {}}, {kMiddle + Index3{0, 1, 0}, kSolid}});
  LiveContours live = LiveContours::create().value();
  EXPECT_EQ(live.update(map, {}).bricks_changed, 216U);
  EXPECT_EQ(live.update(map, {}).bricks_changed, 0U);
  EXPECT_EQ(live.voxels(), contours_of(map));
  EXPECT_EQ(live.points().size(), contour_points(live.voxels(), 0.01, {}).size());
}

TEST(Contours, BadConfigurationsAreRefused) {
  const auto refused = [](const auto& change) {
    ContourConfig config;
    change(config);
    const bool same = contour_voxels({}, config, {}).ok() == config.validate().ok() &&
                      LiveContours::create(config).ok() == config.validate().ok();
    return same && !config.validate().ok() && config.validate().error().code == Errc::invalid_argument;
  };
  constexpr double kNaN{std::numeric_limits<double>::quiet_NaN()};
  EXPECT_TRUE(ContourConfig{}.validate().ok());
  EXPECT_TRUE(refused([](ContourConfig& config) { config.known_weight = 0; }));
  for (const double bad : {0.0, -0.03, kNaN, std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(refused([&](ContourConfig& config) { config.group_distance_m = bad; })) << bad;
  }
  for (const double bad : {0.0, -0.5, 1.6, kNaN}) {
    EXPECT_TRUE(refused([&](ContourConfig& config) { config.group_angle_rad = bad; })) << bad;
  }
}

}  // namespace
}  // namespace saccade

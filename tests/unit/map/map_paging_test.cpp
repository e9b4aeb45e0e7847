// SPDX-License-Identifier: Apache-2.0
// Maps whose sectors are partly away: never unknown or empty by mistake, errors of the store, snapshots, moving volume.
#include "saccade/map/map_paging.hpp"

#include <gtest/gtest.h>

#include "saccade/map/internal/sector_bytes.hpp"
#include "saccade/map/map_changes.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/map/ray_walk.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "support/memory_store.hpp"

namespace saccade {
namespace {

using test::MemoryStore;

constexpr double kVoxel_m{0.02};

PinholeCamera small_camera() {
  PinholeCamera camera;
  camera.width = 64;
  camera.height = 48;
  camera.fx = camera.fy = 50.0;
  camera.cx = 31.5;
  camera.cy = 23.5;
  camera.min_range_m = 0.1;
  camera.max_range_m = 3.0;
  return camera;
}

/// A wall with steps, 2 m ahead.
DepthImage wall() {
  DepthImage depth{64, 48};
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) depth(u, v) = (u / 8 + v / 8) % 2 == 0 ? 2.0F : 1.8F;
  }
  return depth;
}

ColorImage paint() {
  ColorImage color{64, 48};
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) {
      color(u, v) = {static_cast<std::uint8_t>(4 * u), static_cast<std::uint8_t>(5 * v), 99};
    }
  }
  return color;
}

Pose at(double x_m) {
  Pose T{Pose::Identity()};
  T.translation().x() = x_m;
  return T;
}

/// A map that is paged, and the same without.
struct Twins {
  TsdfMap paged;
  TsdfMap plain;
  std::shared_ptr<MemoryStore> store{std::make_shared<MemoryStore>()};

  explicit Twins(std::optional<std::size_t> memory_bytes, std::optional<double> volume_m = std::nullopt)
      : paged{TsdfMap::create(config()).value()}, plain{TsdfMap::create(config()).value()} {
    EXPECT_TRUE(paged.keep_within({memory_bytes, volume_m, store}).ok());
  }
  static TsdfConfig config() {
    TsdfConfig config;
    config.voxel_size_m = kVoxel_m;
    return config;
  }
  Status fuse(double x_m) {
    const ColorImage color = paint();
    const auto fused = paged.integrate(small_camera(), wall(), at(x_m), {}, &color);
    if (!fused) return fused.error();
    EXPECT_TRUE(plain.integrate(small_camera(), wall(), at(x_m), {}, &color).ok());
    return {};
  }
  void expect_equal() const {
    EXPECT_GT(plain.content().grid.sector_count(), 2U);
    EXPECT_EQ(paged.content().grid.sorted_sectors(), plain.content().grid.sorted_sectors());
    EXPECT_TRUE(paged.content().grid == plain.content().grid);
    EXPECT_TRUE(plain.content().grid == paged.content().grid);
  }
};

TEST(MapPaging, AnAwaySectorIsNeverReadAsUnknownOrEmpty) {
  Twins twins{1};
  ASSERT_TRUE(twins.fuse(0.0).ok());
  const TsdfSnapshot& map = twins.paged.content();
  ASSERT_EQ(map.grid.away_count(), map.grid.sector_count());
  ASSERT_GT(map.grid.away_count(), 0U);
  EXPECT_FALSE(map.grid.empty());
  for (const Index3& key : twins.plain.content().grid.sorted_sectors()) {
    const Index3 voxel = key * kSectorVoxelEdge + Index3{3, 4, 5};
    EXPECT_TRUE(map.grid.holds(key));
    EXPECT_TRUE(map.grid.is_away(key));
    EXPECT_THROW(static_cast<void>(map.grid.find(key)), ContractViolation);
    EXPECT_THROW(static_cast<void>(map.grid.state(voxel)), ContractViolation);
    EXPECT_THROW(static_cast<void>(map.grid.color(voxel)), ContractViolation);
    TsdfGrid copy = map.grid;
    EXPECT_THROW(static_cast<void>(copy.writable(key)), ContractViolation);
    const SectorTable table{map.grid};
    EXPECT_THROW(static_cast<void>(table.find(key)), ContractViolation);
  }
  const Sphere ahead{{0.0, 0.0, 1.0}, 0.1};
  EXPECT_THROW(static_cast<void>(count_unknown(map, ahead)), ContractViolation);
  EXPECT_EQ(count_unknown(twins.plain.content(), ahead), 0U);
  EXPECT_THROW(static_cast<void>(changed_sectors({}, map.grid, {})), ContractViolation);
  EXPECT_THROW(static_cast<void>(extract_mesh(map, {})), ContractViolation);
  const SectorTable table{map.grid};
  const LatticeRay ray = make_lattice_ray(lattice_point(0.0, 0.0, 0.0), 0.0F, 0.0F, static_cast<float>(1.0 / kVoxel_m));
  EXPECT_THROW(static_cast<void>(first_voxel(ray, clip(ray, {{-9, -9, -9}, {9, 9, 200}}), table)), ContractViolation);
  // A sector that no frame ever saw is unknown, here as there.
  EXPECT_EQ(map.grid.state({100000, 0, 0}), VoxelState::unknown);
}

TEST(MapPaging, TheContentIsEqualAndSoIsWhatIsSaidOfIt) {
  Twins twins{1};
  for (const double x_m : {0.0, 3.0, 0.1, 6.0, 0.0}) {
    ASSERT_TRUE(twins.fuse(x_m).ok());
    twins.expect_equal();
  }
  const TsdfGrid& paged = twins.paged.content().grid;
  const TsdfGrid& plain = twins.plain.content().grid;
  EXPECT_EQ(paged.known_bounds(), plain.known_bounds());
  EXPECT_EQ(paged.sector_bounds(), plain.sector_bounds());
  EXPECT_EQ(paged.usage().bricks(), plain.usage().bricks());
  EXPECT_EQ(paged.usage().bytes, 0U);
  EXPECT_EQ(paged.usage().away_bytes, plain.usage().bytes);
  const PagingStats stats = *twins.paged.paging();
  EXPECT_EQ(stats.map_bytes, 0U);
  EXPECT_GT(stats.peak_map_bytes, 0U);
  EXPECT_LT(stats.peak_map_bytes, plain.usage().bytes);
  EXPECT_GT(stats.bytes_read, 0U);
  EXPECT_FALSE(twins.plain.paging().has_value());
}

TEST(MapPaging, NothingGoesOutBelowTheLimit) {
  Twins twins{std::size_t{1} << 30U};
  ASSERT_TRUE(twins.fuse(0.0).ok());
  ASSERT_TRUE(twins.fuse(3.0).ok());
  EXPECT_TRUE(twins.paged.content().grid.all_in_memory());
  EXPECT_EQ(twins.paged.paging()->map_bytes, twins.plain.content().grid.usage().bytes);
  EXPECT_EQ(twins.store->writes, 0U);
}

TEST(MapPaging, TheLeastRecentlySeenGoesOutFirst) {
  Twins probe{std::size_t{1} << 30U};
  ASSERT_TRUE(probe.fuse(0.0).ok());
  const std::size_t one_view = probe.paged.paging()->map_bytes;
  Twins twins{2 * one_view + one_view / 2};
  for (const double x_m : {0.0, 6.0, 12.0}) ASSERT_TRUE(twins.fuse(x_m).ok());
  const TsdfGrid& grid = twins.paged.content().grid;
  const double sector_m = kVoxel_m * kSectorVoxelEdge;
  ASSERT_GT(grid.away_count(), 0U);
  for (const Index3& key : grid.sorted_sectors()) {
    if (grid.is_away(key)) {
      EXPECT_LT(voxel_center(key, sector_m).x(), 3.0) << "a later view went first";
    }
  }
  EXPECT_LE(twins.paged.paging()->map_bytes, 2 * one_view + one_view / 2);
}

TEST(MapPaging, RayCastsReadWhatIsAway) {
  Twins twins{1};
  for (const double x_m : {0.0, 1.0, 2.0}) ASSERT_TRUE(twins.fuse(x_m).ok());
  for (const double x_m : {0.0, 0.7, 2.2}) {
    const auto expected = raycast(twins.plain.content(), small_camera(), at(x_m), {}, {true});
    for (int round = 0; round < 2; ++round) {
      const auto view = raycast(twins.paged.content(), small_camera(), at(x_m), {}, {true});
      ASSERT_TRUE(view.ok());
      EXPECT_EQ(view->depth.pixels(), expected->depth.pixels());
      EXPECT_EQ(view->normals.pixels(), expected->normals.pixels());
      EXPECT_EQ(view->colors.pixels(), expected->colors.pixels());
      ASSERT_TRUE(twins.paged.look_from(small_camera(), at(x_m), {}).ok());
      EXPECT_LT(twins.paged.content().grid.away_count(), twins.paged.content().grid.sector_count());
      const std::size_t reads = twins.store->reads;
      ASSERT_TRUE(raycast(twins.paged.content(), small_camera(), at(x_m), {}).ok());
      EXPECT_EQ(twins.store->reads, reads) << "look_from brought it in";
    }
  }
  twins.expect_equal();
}

TEST(MapPaging, MeshesByPartsAreEqual) {
  Twins twins{1};
  for (const double x_m : {0.0, 1.0, 5.0, -4.0}) ASSERT_TRUE(twins.fuse(x_m).ok());
  const TriangleMesh expected = extract_mesh(twins.plain.content(), {});
  ASSERT_GT(expected.triangles.size(), 1000U);
  for (const TsdfMap* map : {&twins.paged, &twins.plain}) {
    const auto mesh = extract_mesh_by_parts(map->content(), {});
    ASSERT_TRUE(mesh.ok());
    EXPECT_EQ(mesh->vertices, expected.vertices);
    EXPECT_EQ(mesh->normals, expected.normals);
    EXPECT_EQ(mesh->colors, expected.colors);
    EXPECT_EQ(mesh->triangles, expected.triangles);
  }
}

TEST(MapPaging, SnapshotsKeepTheContentOfTheirTime) {
  Twins twins{1};
  ASSERT_TRUE(twins.fuse(0.0).ok());
  std::vector<std::pair<TsdfSnapshot, TsdfSnapshot>> snapshots;
  for (const double x_m : {0.2, 3.0, 0.0, 0.4}) {
    ASSERT_TRUE(twins.paged.look_from(small_camera(), at(x_m), {}).ok());  // some sectors are in memory, some away
    snapshots.emplace_back(twins.paged.snapshot(), twins.plain.snapshot());
    ASSERT_TRUE(twins.fuse(x_m).ok());
    ASSERT_TRUE(twins.paged.forget(Sphere{{x_m, 0.0, 1.9}, 0.3}).ok());
    ASSERT_TRUE(twins.plain.forget(Sphere{{x_m, 0.0, 1.9}, 0.3}).ok());
  }
  for (const auto& [paged, plain] : snapshots) {
    EXPECT_TRUE(paged.grid == plain.grid);
    EXPECT_FALSE(paged.grid == twins.paged.content().grid);
    // A map that goes on from it reads what it needs, also without limits.
    TsdfMap go_on{paged};
    TsdfMap plain_goes_on{plain};
    ASSERT_TRUE(go_on.integrate(small_camera(), wall(), at(0.1), {}).ok());
    ASSERT_TRUE(plain_goes_on.integrate(small_camera(), wall(), at(0.1), {}).ok());
    EXPECT_TRUE(go_on.content().grid == plain_goes_on.content().grid);
  }
  snapshots.clear();
  EXPECT_EQ(twins.store->kept(), twins.paged.content().grid.away_count()) << "nothing else is kept";
}

TEST(MapPaging, WhatDidNotChangeIsNotWrittenAgain) {
  Twins twins{1};
  ASSERT_TRUE(twins.fuse(0.0).ok());
  const std::size_t written = twins.store->writes;
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(twins.paged.look_from(small_camera(), at(0.0), {}).ok());
    EXPECT_TRUE(twins.paged.content().grid.all_in_memory());
    ASSERT_TRUE(twins.paged.page_out_all({}).ok());
    EXPECT_FALSE(twins.paged.content().grid.all_in_memory());
  }
  EXPECT_EQ(twins.store->writes, written);
  ASSERT_TRUE(twins.fuse(0.0).ok());
  EXPECT_GT(twins.store->writes, written);
  twins.expect_equal();
}

TEST(MapPaging, AFullStoreLeavesTheMapAsItWas) {
  Twins twins{1};
  ASSERT_TRUE(twins.fuse(0.0).ok());
  twins.store->writes_left = 3;
  ASSERT_TRUE(twins.fuse(3.0).ok()) << "the frame itself needs no room in the store";
  twins.expect_equal();
  const Status refused = twins.fuse(6.0);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, Errc::io_failure);
  twins.expect_equal();
  EXPECT_FALSE(twins.paged.forget(Sphere{{0.0, 0.0, 2.0}, 0.5}).ok());
  EXPECT_FALSE(twins.paged.free(Sphere{{0.0, 0.0, 2.0}, 0.5}).ok());
  EXPECT_FALSE(twins.paged.look_from(small_camera(), at(0.0), {}).ok());
  twins.expect_equal();
  twins.store->writes_left = -1;
  ASSERT_TRUE(twins.fuse(6.0).ok());
  twins.expect_equal();
}

TEST(MapPaging, ADamagedStoreLeavesTheMapAsItWas) {
  Twins twins{1};
  ASSERT_TRUE(twins.fuse(0.0).ok());
  for (bool MemoryStore::*fault : {&MemoryStore::fails_reads, &MemoryStore::cuts_reads}) {
    (*twins.store).*fault = true;
    const Status refused = twins.fuse(0.1);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, Errc::corrupt_data);
    EXPECT_FALSE(raycast(twins.paged.content(), small_camera(), at(0.0), {}).ok());
    EXPECT_FALSE(extract_mesh_by_parts(twins.paged.content(), {}).ok());
    EXPECT_FALSE(twins.paged.forget(Sphere{{0.0, 0.0, 2.0}, 0.5}).ok());
    (*twins.store).*fault = false;
    twins.expect_equal();
  }
  ASSERT_TRUE(twins.fuse(0.1).ok());
  twins.expect_equal();
}

TEST(MapPaging, TheMovingVolumeFollowsTheCamera) {
  constexpr double kEdge_m{4.0};
  Twins twins{std::nullopt, kEdge_m};
  const double sector_m = kVoxel_m * kSectorVoxelEdge;
  const auto stay_near = [&](double x_m) {
    for (const Index3& key : twins.paged.content().grid.sorted_sectors()) {
      const double farthest_m = (voxel_center(key, sector_m) - at(x_m).translation()).cwiseAbs().maxCoeff();
      if (!twins.paged.content().grid.is_away(key)) {
        EXPECT_LE(farthest_m, kEdge_m / 2.0 + sector_m) << x_m;
      }
      if (farthest_m > kEdge_m / 2.0 + sector_m) {
        EXPECT_TRUE(twins.paged.content().grid.is_away(key)) << x_m;
      }
    }
  };
  ASSERT_TRUE(twins.fuse(0.0).ok());
  const std::size_t here = twins.paged.content().grid.sector_count() - twins.paged.content().grid.away_count();
  EXPECT_GT(here, 0U);
  ASSERT_TRUE(twins.fuse(0.9).ok());  // within the middle
  EXPECT_EQ(twins.paged.paging()->shifts, 0U);
  ASSERT_TRUE(twins.fuse(8.0).ok());
  EXPECT_EQ(twins.paged.paging()->shifts, 1U);
  stay_near(8.0);
  ASSERT_TRUE(twins.fuse(0.0).ok());
  EXPECT_EQ(twins.paged.paging()->shifts, 2U);
  stay_near(0.0);
  EXPECT_GE(twins.paged.content().grid.sector_count() - twins.paged.content().grid.away_count(), here);
  twins.expect_equal();
}

TEST(MapPaging, SectorsAreBytesAndBackToTheBit) {
  Twins twins{std::size_t{1} << 30U};
  ASSERT_TRUE(twins.fuse(0.0).ok());
  ASSERT_TRUE(twins.fuse(0.3).ok());
  std::size_t dense{0};
  for (const Index3& key : twins.plain.content().grid.sorted_sectors()) {
    const Sector& sector = *twins.plain.content().grid.find(key);
    const std::vector<std::byte> bytes = encode_sector(sector);
    Sector back;
    ASSERT_TRUE(decode_sector(bytes, back).ok());
    EXPECT_EQ(back.bricks, sector.bricks);
    EXPECT_EQ(back.has_unknown, sector.has_unknown);
    EXPECT_EQ(back.has_occupied, sector.has_occupied);
    EXPECT_EQ(back.saturated, sector.saturated);
    for (std::size_t i = 0; i < kSectorBricks; ++i) {
      if (const DenseBrick* brick = sector.bricks[i].dense()) {
        EXPECT_EQ(back.bricks[i].dense()->occupied, brick->occupied);
        EXPECT_EQ(back.bricks[i].dense()->unknown, brick->unknown);
        ++dense;
      }
    }
    for (const std::size_t size : {std::size_t{0}, std::size_t{100}, bytes.size() - 1}) {
      Sector cut;
      EXPECT_FALSE(decode_sector(std::span{bytes}.first(size), cut).ok());
    }
    std::vector<std::byte> other = bytes;
    other[3 * sizeof(Mask512)] = std::byte{200};
    Sector damaged;
    EXPECT_FALSE(decode_sector(other, damaged).ok());
  }
  EXPECT_GT(dense, 10U);
}

TEST(MapPaging, BadConfigurationsAreRefused) {
  TsdfMap map = TsdfMap::create(Twins::config()).value();
  const auto store = std::make_shared<MemoryStore>();
  EXPECT_FALSE(map.keep_within({std::size_t{1}, std::nullopt, nullptr}).ok());
  EXPECT_FALSE(map.keep_within({std::nullopt, std::nullopt, store}).ok());
  EXPECT_FALSE(map.keep_within({std::nullopt, 0.0, store}).ok());
  EXPECT_TRUE(map.keep_within({std::size_t{1}, std::nullopt, store}).ok());
  EXPECT_FALSE(map.keep_within({std::size_t{1}, std::nullopt, store}).ok());
}

}  // namespace
}  // namespace saccade

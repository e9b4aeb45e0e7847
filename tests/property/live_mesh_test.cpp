// SPDX-License-Identifier: Apache-2.0
// Changed bricks against a comparison of all voxels, and the mesh that follows the map against extraction anew, over
// random frames, forgotten and freed regions, and threads.

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

#include "analytic_map.hpp"
#include "saccade/map/map_changes.hpp"
#include "saccade/map/mesh.hpp"
#include "support/effort.hpp"
#include "support/parallel_backend.hpp"
#include "support/random_map.hpp"

namespace saccade {
namespace {

using test::RandomMap;
using test::RandomRun;

constexpr int kMeshRuns{test::scaled_cases(24)};
constexpr int kMeshSteps{7};
constexpr int kPatternRuns{test::scaled_cases(6)};

const BrickRef& brick_at(const TsdfGrid& grid, const Index3& key, int child) {
  static const BrickRef unknown;
  const Sector* sector = grid.find(key);
  return sector == nullptr ? unknown : sector->bricks[static_cast<std::size_t>(child)];
}

Rgb8 color_of(const BrickRef& brick, int i) {
  const DenseBrick* dense = brick.dense();
  return dense == nullptr || dense->colors == nullptr ? Rgb8{} : (*dense->colors)[static_cast<std::size_t>(i)];
}

/// Room for colours is content, as in BrickRef::operator==, even while all are black.
bool differs(const BrickRef& a, const BrickRef& b) {
  if (a.is_unknown() && b.is_unknown()) return false;
  const auto has_colors = [](const BrickRef& brick) { return brick.dense() != nullptr && brick.dense()->colors; };
  if (a.dense() != nullptr && b.dense() != nullptr && has_colors(a) != has_colors(b)) return true;
  for (int i = 0; i < kBrickVoxels; ++i) {
    if (!(a.voxel(i) == b.voxel(i)) || color_of(a, i) != color_of(b, i)) return true;
  }
  return false;
}

/// Every voxel of every brick.
std::vector<Index3> changed_by_comparison(const TsdfGrid& before, const TsdfGrid& after) {
  TsdfGrid both = before;
  for (const Index3& key : after.sorted_sectors()) static_cast<void>(both.writable(key));
  std::vector<Index3> changed;
  for (const Index3& key : both.sorted_sectors()) {
    for (int child = 0; child < kSectorBricks; ++child) {
      if (differs(brick_at(before, key, child), brick_at(after, key, child))) {
        changed.push_back(key * kSectorEdge + child_offset(child));
      }
    }
  }
  return changed;
}

void expect_same(const TriangleMesh& actual, const TriangleMesh& expected) {
  EXPECT_EQ(actual.vertices, expected.vertices);
  EXPECT_EQ(actual.normals, expected.normals);
  EXPECT_EQ(actual.colors, expected.colors);
  EXPECT_EQ(actual.triangles, expected.triangles);
}

/// Corners of triangles with all they carry.
struct Corners {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Rgb8> colors;

  void add(const TriangleMesh& mesh) {
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t i : triangle) {
        vertices.push_back(mesh.vertices[i]);
        normals.push_back(mesh.normals[i]);
        if (!mesh.colors.empty()) colors.push_back(mesh.colors[i]);
      }
    }
  }
};

/// Keeps a mesh per brick, and replaces what an update names.
class Viewer {
 public:
  void follow(const LiveMesh& live, const MeshUpdate& update) {
    for (const Index3& brick : update.bricks) {
      pieces_[{parent(brick), child_index(brick)}] = live.mesh_of(brick);
    }
  }
  void expect_shows(const TriangleMesh& mesh) const {
    Corners shown;
    for (const auto& piece : pieces_) shown.add(piece.second);
    Corners expected;
    expected.add(mesh);
    EXPECT_EQ(shown.vertices, expected.vertices);
    EXPECT_EQ(shown.normals, expected.normals);
    if (!mesh.colors.empty()) {
      EXPECT_EQ(shown.colors, expected.colors);
    }
  }

 private:
  using Place = std::pair<Index3, int>;
  struct Less {
    bool operator()(const Place& a, const Place& b) const {
      return a.first == b.first ? a.second < b.second : zyx_less(a.first, b.first);
    }
  };
  std::map<Place, TriangleMesh, Less> pieces_;
};

TEST(MapChangesProperty, AreTheBricksWithOtherVoxels) {
  std::size_t listed{0};
  std::size_t kept{0};
  int compared{0};
  for (std::uint32_t seed = 1; seed <= kMeshRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomMap random{seed};
    TsdfSnapshot before = random.snapshot();
    for (int step = 0; step < kMeshSteps; ++step, ++compared) {
      random.step();
      const TsdfSnapshot after = random.snapshot();
      const std::vector<Index3> changed = changed_bricks(before.grid, after.grid, {});
      ASSERT_EQ(changed, changed_by_comparison(before.grid, after.grid));
      for (const std::size_t threads : {2U, 7U}) {
        const Executor executor = Executor::with_threads(threads, test::kParallelBackend);
        ASSERT_EQ(changed_bricks(before.grid, after.grid, executor), changed);
      }
      EXPECT_EQ(changed_bricks(after.grid, before.grid, {}), changed);
      EXPECT_TRUE(changed_bricks(after.grid, after.grid, {}).empty());
      listed += changed.size();
      kept += after.grid.usage().bricks();
      before = after;
    }
  }
  EXPECT_EQ(compared, kMeshRuns * kMeshSteps);
  EXPECT_GT(listed, static_cast<std::size_t>(compared) * 50);
  EXPECT_LT(listed, kept);
  std::printf("%zu bricks changed in %d steps, the maps had %zu\n", listed, compared, kept);
}

void expect_extraction_anew_after_every_change(int runs) {
  std::size_t triangles{0};
  std::size_t updates{0};
  std::size_t replaced{0};
  for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(runs); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomMap random{seed};
    const MeshConfig config{static_cast<std::uint16_t>(seed % 3 == 0 ? 3 : 1)};
    LiveMesh alone{config};
    LiveMesh two{config};
    LiveMesh seven{config};
    Viewer viewer;
    for (int step = 0; step < kMeshSteps; ++step, ++updates) {
      SCOPED_TRACE("step " + std::to_string(step));
      random.step();
      const TsdfSnapshot map = random.snapshot();
      const MeshUpdate update = alone.update(map, {});
      const TriangleMesh mesh = alone.mesh({});
      ASSERT_NO_FATAL_FAILURE(expect_same(mesh, extract_mesh(map, {}, config)));
      viewer.follow(alone, update);
      viewer.expect_shows(mesh);
      for (const auto& [live, threads] : {std::pair{&two, 2U}, std::pair{&seven, 7U}}) {
        const Executor executor = Executor::with_threads(threads, test::kParallelBackend);
        const MeshUpdate same = live->update(map, executor);
        EXPECT_EQ(same.bricks, update.bricks);
        EXPECT_EQ(same.bricks_extracted, update.bricks_extracted);
        expect_same(live->mesh(executor), mesh);
      }
      if (testing::Test::HasFailure()) return;
      triangles += mesh.triangles.size();
      replaced += update.bricks.size();
    }
  }
  EXPECT_EQ(updates, static_cast<std::size_t>(runs) * kMeshSteps);
  EXPECT_GT(triangles, updates * 300);
  std::printf("%zu updates, %zu bricks replaced, %zu triangles compared\n", updates, replaced, triangles);
}

TEST(LiveMeshProperty, EqualsExtractionAnewAfterEveryChange) {
  expect_extraction_anew_after_every_change((kMeshRuns + 5) / 6);
}
TEST(LiveMeshPropertyEvidence, EqualsExtractionAnewAfterEveryChange) {
  expect_extraction_anew_after_every_change(kMeshRuns);
}

TEST(LiveMeshProperty, PiecesHaveTheNormalsOfTheWholeWhereTheGradientVanishes) {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  std::size_t compared{0};
  for (std::uint32_t seed = 1; seed <= kPatternRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    // Values that repeat every second voxel have no central differences; a few others are strewn in.
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> value{-0.04, 0.04};
    std::array<double, 8> pattern{};
    for (double& v : pattern) v = value(random);
    const auto sdf = [&](const Eigen::Vector3d& p) {
      const Index3 i = voxel_at(p, config.voxel_size_m);
      const bool strewn = std::uniform_int_distribution{0, 199}(random) == 0;
      return strewn ? value(random) : pattern[static_cast<std::size_t>((i.x & 1) | (i.y & 1) << 1 | (i.z & 1) << 2)];
    };
    LiveMesh live;
    Viewer viewer;
    for (int i = 0; i < 3; ++i) {
      TsdfSnapshot map = test::map_of(config, {{-16, -16, -16}, {16 - 8 * i, 16, 16}}, sdf);
      viewer.follow(live, live.update(map, {}));
      const TriangleMesh mesh = live.mesh({});
      ASSERT_NO_FATAL_FAILURE(expect_same(mesh, extract_mesh(map, {})));
      viewer.expect_shows(mesh);
      compared += mesh.triangles.size();
    }
  }
  EXPECT_GT(compared, static_cast<std::size_t>(kPatternRuns) * 10000);
}

TEST(LiveMeshProperty, ExtractsOnlyAroundWhatChanged) {
  std::size_t all{0};
  std::size_t again{0};
  for (std::uint32_t seed = 1; seed <= kMeshRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomMap random{seed};
    for (int step = 0; step < kMeshSteps; ++step) random.step();
    const TsdfSnapshot before = random.snapshot();
    LiveMesh live;
    all += live.update(before, {}).bricks_extracted;

    const MeshUpdate nothing = live.update(random.snapshot(), {});
    EXPECT_EQ(nothing.bricks_changed, 0U);
    EXPECT_EQ(nothing.bricks_extracted, 0U);
    EXPECT_TRUE(nothing.bricks.empty());

    const Eigen::Vector3d center =
        Eigen::Vector3d::NullaryExpr([&] { return random.run().uniform(-0.5, 0.5) * random.run().extent(); });
    random.forget(Sphere{center, 3.0 * random.run().config().voxel_size_m});
    const TsdfSnapshot after = random.snapshot();
    const std::vector<SectorBricks> changed = changed_sectors(before.grid, after.grid, {});
    std::size_t may_differ{0};
    for (const SectorBricks& sector : with_neighbors(changed)) {
      may_differ += static_cast<std::size_t>(sector.bricks.count());
    }
    const MeshUpdate update = live.update(after, {});
    EXPECT_LE(update.bricks_changed, 8U);
    EXPECT_LE(may_differ, 64U);
    EXPECT_LE(update.bricks_extracted, may_differ);
    EXPECT_LE(update.bricks.size(), may_differ);
    again += update.bricks_extracted;
  }
  EXPECT_GT(again, 0U) << "no surface was met";
  EXPECT_GT(all, 10 * again);
  std::printf("%zu bricks extracted at first, %zu again\n", all, again);
}

}  // namespace
}  // namespace saccade

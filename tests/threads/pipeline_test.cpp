// SPDX-License-Identifier: Apache-2.0
// The whole way from frames to a map, a mesh, views, segments, surfels and labels, on four threads and on one.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "saccade/annotate/shortest_path_forest.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/segment/flood_fill.hpp"
#include "saccade/segment/live_segments.hpp"
#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "saccade/views/view_gain.hpp"
#include "saccade/views/view_sphere.hpp"
#include "support/parallel_backend.hpp"

namespace saccade {
namespace {

const PinholeCamera kCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.2, 3.0};

struct Outcome {
  std::size_t triangles{0};
  std::size_t seen{0};  ///< pixels of the ray cast that show a surface
  std::vector<std::uint64_t> gains;
  std::vector<std::uint32_t> segments;  ///< label of each surface point
  std::size_t components{0};            ///< connected parts of the surface, by flood fill
  std::size_t surfels{0};
  std::size_t modes{0};
  std::vector<std::uint32_t> roots;  ///< control point that each surface point belongs to

  bool operator==(const Outcome&) const = default;
};

std::vector<Frame> frames() {
  std::vector<Frame> all;
  for (const Pose& T_world_camera : sample_trajectory(3)) {
    RenderedFrame rendered = render(sample_tabletop(), kCamera, T_world_camera).value();
    Frame frame;
    frame.depth = std::move(rendered.depth);
    frame.color = std::move(rendered.color);
    frame.T_world_camera = T_world_camera;
    all.push_back(std::move(frame));
  }
  return all;
}

/// Fuses the frames as surfels and finds their modes.
void add_surfels(const std::vector<Frame>& seen, const Executor& executor, Outcome& outcome) {
  SurfelFusion fusion = SurfelFusion::create().value();
  ModeFilter filter = ModeFilter::create().value();
  for (const Frame& frame : seen) {
    ASSERT_TRUE(fusion.add_frame(frame, kCamera, executor).ok());
    ASSERT_TRUE(filter.add_frame(frame, fusion.association(), executor).ok());
  }
  outcome.surfels = fusion.map().size();
  for (const SurfelMode& mode : filter.winners(executor)) outcome.modes += mode.weight > 0.0F ? 1 : 0;
}

/// Segments the surface and grows paths from two of its points.
void add_labels(const TsdfSnapshot& map, const Executor& executor, Outcome& outcome) {
  const MapSegments segments = segment_map(map, executor).value();
  outcome.segments = segments.segments.labels;
  PointCloud cloud = segments.points;
  cloud.radii_m.assign(cloud.positions_m.size(), 0.02F);
  outcome.components = flood_fill(cloud, {}, executor)->count;
  const auto points = static_cast<std::uint32_t>(cloud.positions_m.size());
  auto graph = std::make_shared<const Neighbourhood>(Neighbourhood::build(cloud, {}, executor).value());
  ShortestPathForest forest{graph, executor};
  forest.rebuild(std::vector<Root>{{0, 0}, {points / 2, 0}});
  for (std::uint32_t point = 0; point < points; ++point)
    outcome.roots.push_back(forest.root_of(point).value_or(points));
}

Outcome run(const std::vector<Frame>& seen, const Executor& executor) {
  Outcome outcome;
  TsdfConfig config;
  config.voxel_size_m = 0.015;
  TsdfMap map = TsdfMap::create(config).value();
  const Sphere region{{0.0, 0.0, 0.05}, 0.2};
  EXPECT_TRUE(map.free(Box{{-0.9, -0.9, -0.3}, {0.9, 0.9, 0.9}}).ok());  // cameras stand in free space
  EXPECT_TRUE(map.forget(region).ok());
  for (const Frame& frame : seen)
    EXPECT_TRUE(map.integrate(kCamera, frame.depth, *frame.T_world_camera, executor).ok());
  const TsdfSnapshot snapshot = map.snapshot();
  outcome.triangles = extract_mesh(snapshot, executor).triangles.size();
  const SurfaceView view = raycast(snapshot, kCamera, *seen[1].T_world_camera, executor).value();
  for (const float depth_m : view.depth.pixels()) outcome.seen += depth_m > 0.0F ? 1 : 0;
  ViewSphereConfig sphere;
  sphere.radii_m = {0.6};
  const std::vector<Pose> poses = poses_of(view_sphere({0.0, 0.0, 0.05}, sphere).value());
  GainConfig gain;
  gain.sensor = {96, 72, 78.75, 78.75, 47.5, 35.5, 0.2, 3.0};
  outcome.gains = evaluate_views(snapshot, region, poses, gain, executor)->gains;
  add_labels(snapshot, executor, outcome);
  add_surfels(seen, executor, outcome);
  return outcome;
}

TEST(Pipeline, FourThreadsGiveWhatOneGives) {
  const std::vector<Frame> seen = frames();
  const Outcome outcome = run(seen, Executor::with_threads(4, test::kParallelBackend));
  EXPECT_TRUE(outcome == run(seen, Executor{}));
  EXPECT_GT(outcome.triangles, 1000U);
  EXPECT_GT(outcome.seen, 5000U);
  EXPECT_GT(*std::max_element(outcome.gains.begin(), outcome.gains.end()), 0U);
  EXPECT_GT(outcome.components, 1U);
  EXPECT_GT(outcome.surfels, 5000U);
  EXPECT_GT(outcome.modes, 5000U);
  ASSERT_EQ(outcome.roots.size(), outcome.segments.size());
  EXPECT_GT(std::count(outcome.roots.begin(), outcome.roots.end(), 0U), 1000);
}

}  // namespace
}  // namespace saccade

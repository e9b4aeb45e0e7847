// SPDX-License-Identifier: Apache-2.0
// Supervoxels and LCCP on clouds whose segments are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "saccade/segment/lccp.hpp"
#include "saccade/segment/overlap.hpp"

namespace saccade {
namespace {

constexpr float kStep_m{0.003F};
constexpr float kNan{std::numeric_limits<float>::quiet_NaN()};

const Eigen::Vector3f kCamera_m{-0.4F, -0.5F, 0.8F};

/// Points and what they belong to: 0 table, 1 and more things on it.
struct Scene {
  PointCloud cloud;
  std::vector<std::uint32_t> objects;

  /// Nothing, unless the camera sees a surface with this normal.
  void add(const Eigen::Vector3f& p, const Eigen::Vector3f& normal, std::uint32_t object) {
    if (normal.dot(kCamera_m - p) <= 0.0F) return;
    cloud.positions_m.push_back(p);
    objects.push_back(object);
  }
};

/// Returns the camera's view of a box that stands on z = 0.
void add_box(Scene& scene, const Eigen::Vector3f& corner_m, const Eigen::Vector3f& size_m, std::uint32_t object) {
  for (float x = 0.0F; x <= size_m.x(); x += kStep_m) {
    for (float y = 0.0F; y <= size_m.y(); y += kStep_m) {
      scene.add(corner_m + Eigen::Vector3f{x, y, size_m.z()}, Eigen::Vector3f::UnitZ(), object);
    }
    for (float z = kStep_m; z < size_m.z(); z += kStep_m) {
      scene.add(corner_m + Eigen::Vector3f{x, 0.0F, z}, -Eigen::Vector3f::UnitY(), object);
      scene.add(corner_m + Eigen::Vector3f{x, size_m.y(), z}, Eigen::Vector3f::UnitY(), object);
    }
  }
  for (float y = 0.0F; y <= size_m.y(); y += kStep_m) {
    for (float z = kStep_m; z < size_m.z(); z += kStep_m) {
      scene.add(corner_m + Eigen::Vector3f{0.0F, y, z}, -Eigen::Vector3f::UnitX(), object);
      scene.add(corner_m + Eigen::Vector3f{size_m.x(), y, z}, Eigen::Vector3f::UnitX(), object);
    }
  }
}

/// A table at z = 0 and two boxes on it, 7 cm apart.
Scene two_boxes() {
  Scene scene;
  const auto under = [](float x, float y, float x0, float x1) { return x > x0 && x < x1 && y > 0.1F && y < 0.22F; };
  for (float x = -0.1F; x <= 0.5F; x += kStep_m) {
    for (float y = -0.1F; y <= 0.4F; y += kStep_m) {
      if (!under(x, y, 0.05F, 0.15F) && !under(x, y, 0.22F, 0.34F))
        scene.add({x, y, 0.0F}, Eigen::Vector3f::UnitZ(), 0);
    }
  }
  add_box(scene, {0.05F, 0.1F, 0.0F}, {0.1F, 0.12F, 0.1F}, 1);
  add_box(scene, {0.22F, 0.1F, 0.0F}, {0.12F, 0.12F, 0.15F}, 2);
  return scene;
}

PointCloud sphere(float radius_m) {
  PointCloud cloud;
  const int points = 12000;
  for (int i = 0; i < points; ++i) {  // on a spiral from pole to pole
    const double z = 1.0 - 2.0 * (i + 0.5) / points;
    const double turn = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double across = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d p{across * std::cos(turn), across * std::sin(turn), z};
    cloud.positions_m.push_back((radius_m * p.cast<float>()).eval());
    cloud.normals.push_back(p.cast<float>());
  }
  return cloud;
}

PointCloud plane() {
  PointCloud cloud;
  for (float x = 0.0F; x <= 0.3F; x += kStep_m) {
    for (float y = 0.0F; y <= 0.3F; y += kStep_m) cloud.positions_m.emplace_back(x, y, 1.0F);
  }
  return cloud;
}

SupervoxelConfig from_camera() {
  SupervoxelConfig config;
  config.voxels.viewpoint_m = kCamera_m.cast<double>();
  return config;
}

struct Segments {
  SupervoxelResult supervoxels;
  LccpResult lccp;
};

Segments segment(const PointCloud& cloud, const SupervoxelConfig& config = {}, const LccpConfig& lccp = {},
                 std::size_t threads = 1) {
  Segments found;
  found.supervoxels = find_supervoxels(cloud, config, Executor::with_threads(threads)).value();
  found.lccp = segment_by_convexity(found.supervoxels, lccp).value();
  return found;
}

/// Every finite point has a label of a supervoxel and of a segment, and each of these has points.
void expect_sound(const PointCloud& cloud, const Segments& found) {
  ASSERT_EQ(found.supervoxels.labels.size(), cloud.positions_m.size());
  ASSERT_EQ(found.lccp.labels.size(), cloud.positions_m.size());
  std::vector<std::uint32_t> points(found.supervoxels.supervoxels.size(), 0);
  std::set<std::uint32_t> segments;
  for (std::size_t i = 0; i < cloud.positions_m.size(); ++i) {
    if (!cloud.positions_m[i].allFinite()) {
      EXPECT_EQ(found.supervoxels.labels[i], kUnlabelled);
      EXPECT_EQ(found.lccp.labels[i], kUnlabelled);
      continue;
    }
    const std::uint32_t supervoxel = found.supervoxels.labels[i];
    ASSERT_LT(supervoxel, points.size());
    points[supervoxel] += 1;
    EXPECT_EQ(found.lccp.labels[i], found.lccp.segment_of[supervoxel]);
    segments.insert(found.lccp.labels[i]);
  }
  for (std::size_t s = 0; s < points.size(); ++s) {
    EXPECT_EQ(found.supervoxels.supervoxels[s].points, points[s]);
    EXPECT_GT(points[s], 0U);
    EXPECT_NEAR(found.supervoxels.supervoxels[s].normal.norm(), 1.0F, 1e-5F);
  }
  EXPECT_EQ(segments.size(), found.lccp.segments);
  for (const auto& [a, b] : found.supervoxels.edges) {
    EXPECT_LT(a, b);
    EXPECT_LT(b, points.size());
  }
  EXPECT_TRUE(std::is_sorted(found.supervoxels.edges.begin(), found.supervoxels.edges.end()));
}

TEST(Segmentation, TwoBoxesAndTheirTableAreKeptApart) {
  const Scene scene = two_boxes();
  const Segments found = segment(scene.cloud, from_camera());
  expect_sound(scene.cloud, found);
  const SegmentOverlap overlap = score_segments(found.lccp.labels, scene.objects).value();
  EXPECT_EQ(overlap.objects, 3U);
  EXPECT_LT(overlap.under_segmentation, 0.01);  // nothing of two things in one
  EXPECT_GT(overlap.weighted_overlap, 0.9);     // supervoxels across the crease are segments of their own
  EXPECT_GT(score_segments(found.lccp.labels, scene.objects, 1).value().weighted_overlap, 0.8);
}

TEST(Segmentation, GivenNormalsAreTaken) {
  Scene scene = two_boxes();
  scene.cloud.normals.assign(scene.cloud.positions_m.size(), Eigen::Vector3f{0.0F, 0.0F, 3.0F});
  const Segments found = segment(scene.cloud, from_camera());
  for (const Supervoxel& supervoxel : found.supervoxels.supervoxels) {
    EXPECT_EQ(supervoxel.normal, Eigen::Vector3f::UnitZ().eval());
  }
}

TEST(Segmentation, ASphereIsOne) {
  const PointCloud cloud = sphere(0.08F);
  const Segments found = segment(cloud);
  expect_sound(cloud, found);
  EXPECT_GT(found.supervoxels.supervoxels.size(), 30U);
  EXPECT_EQ(found.lccp.segments, 1U);
}

TEST(Segmentation, TheInsideOfASphereIsOneNeverWithoutTolerance) {
  PointCloud cloud = sphere(0.05F);
  for (Eigen::Vector3f& normal : cloud.normals) normal = -normal;
  LccpConfig strict;
  strict.concavity_tolerance_rad = 0.0;
  EXPECT_GT(segment(cloud, {}, strict).lccp.segments, 10U);
}

TEST(Segmentation, APlaneIsOneOfManySupervoxels) {
  const PointCloud cloud = plane();
  for (const bool single_camera : {false, true}) {
    SupervoxelConfig config;
    config.voxels.single_camera = single_camera;
    const Segments found = segment(cloud, config);
    expect_sound(cloud, found);
    EXPECT_GT(found.supervoxels.supervoxels.size(), 60U);
    EXPECT_LT(found.supervoxels.supervoxels.size(), 200U);
    EXPECT_EQ(found.lccp.segments, 1U);
    for (const Supervoxel& supervoxel : found.supervoxels.supervoxels) {
      EXPECT_LT((supervoxel.normal + Eigen::Vector3f::UnitZ()).norm(), 1e-4F);  // towards the camera
      EXPECT_NEAR(supervoxel.centroid_m.z(), 1.0F, 1e-4F);
    }
  }
}

TEST(Segmentation, AStepDividesParallelPlanesUnlessSmoothnessIsOff) {
  PointCloud cloud = plane();
  for (Eigen::Vector3f& p : cloud.positions_m) {
    if (p.x() > 0.15F) p.z() += 0.012F;
  }
  cloud.normals.assign(cloud.positions_m.size(), -Eigen::Vector3f::UnitZ());
  SupervoxelConfig config;
  config.voxels.voxel_size_m = 0.012;
  EXPECT_EQ(segment(cloud, config).lccp.segments, 2U);
  LccpConfig rough;
  rough.smooth = false;
  EXPECT_EQ(segment(cloud, config, rough).lccp.segments, 1U);
}

TEST(Segmentation, ColourDividesSupervoxels) {
  PointCloud cloud = plane();
  for (const Eigen::Vector3f& p : cloud.positions_m) {
    cloud.colors.push_back(p.x() < 0.1F ? Eigen::Vector3f{1.0F, 0.0F, 0.0F} : Eigen::Vector3f{0.0F, 0.0F, 1.0F});
  }
  SupervoxelConfig config;
  config.color_weight = 4.0;
  const auto mixed = [&](const SupervoxelConfig& used) {
    const Segments found = segment(cloud, used);
    return std::count_if(found.supervoxels.supervoxels.begin(), found.supervoxels.supervoxels.end(),
                         [](const Supervoxel& s) { return s.color.x() > 0.3F && s.color.z() > 0.3F; });
  };
  EXPECT_LE(mixed(config), 1);
  config.color_weight = 0.0;
  EXPECT_GT(mixed(config), 3);
}

/// As k-means does.
TEST(Segmentation, MoreRoundsBringSupervoxelsCloserTogether) {
  PointCloud cloud = plane();
  const Eigen::AngleAxisf turned{0.5F, Eigen::Vector3f{0.3F, 0.5F, 1.0F}.normalized()};
  for (Eigen::Vector3f& p : cloud.positions_m) {
    p = turned * p;
    cloud.colors.push_back(Eigen::Vector3f::Constant(0.5F + 0.5F * std::sin(40.0F * p.x()) * std::cos(30.0F * p.y())));
  }
  SupervoxelConfig config;
  config.seed_spacing_m = 0.05;
  config.normal_weight = 0.0;
  const auto spread = [&](int rounds, double color_weight) {
    config.rounds = rounds;
    config.color_weight = color_weight;
    const SupervoxelResult found = find_supervoxels(cloud, config, Executor{}).value();
    double sum{0.0};
    for (std::size_t i = 0; i < cloud.positions_m.size(); ++i) {
      const Supervoxel& supervoxel = found.supervoxels[found.labels[i]];
      sum += color_weight > 0.0 ? (cloud.colors[i] - supervoxel.color).squaredNorm()
                                : (cloud.positions_m[i] - supervoxel.centroid_m).squaredNorm();
    }
    return sum;
  };
  for (const double color_weight : {0.0, 10.0}) {
    EXPECT_LT(spread(5, color_weight), 0.9 * spread(1, color_weight)) << color_weight;
  }
}

TEST(Segmentation, NothingIsNothing) {
  for (const std::size_t points : {0, 50}) {
    PointCloud cloud;
    cloud.positions_m.assign(points, Eigen::Vector3f::Constant(kNan));
    const Segments found = segment(cloud);
    expect_sound(cloud, found);
    EXPECT_EQ(found.lccp.segments, 0U);
    EXPECT_TRUE(found.supervoxels.edges.empty());
  }
}

TEST(Segmentation, OnePointOrManyAtOnePlaceAreOneSegment) {
  for (const std::size_t points : {1, 1000}) {
    PointCloud cloud;
    cloud.positions_m.assign(points, Eigen::Vector3f{0.1F, 0.2F, 0.9F});
    const Segments found = segment(cloud);
    expect_sound(cloud, found);
    EXPECT_EQ(found.supervoxels.supervoxels.size(), 1U);
    EXPECT_EQ(found.lccp.segments, 1U);
    EXPECT_LT((found.supervoxels.supervoxels[0].normal + cloud.positions_m[0].normalized()).norm(), 1e-4F);
  }
}

TEST(Segmentation, PointsThatComeTwiceChangeNoSegment) {
  Scene scene = two_boxes();
  const Segments once = segment(scene.cloud, from_camera());
  PointCloud twice = scene.cloud;
  twice.positions_m.insert(twice.positions_m.end(), scene.cloud.positions_m.begin(), scene.cloud.positions_m.end());
  const Segments found = segment(twice, from_camera());
  expect_sound(twice, found);
  EXPECT_EQ(found.lccp.segments, once.lccp.segments);
  for (std::size_t i = 0; i < once.lccp.labels.size(); ++i) {
    ASSERT_EQ(found.lccp.labels[i], found.lccp.labels[i + once.lccp.labels.size()]);
  }
}

TEST(Segmentation, NoSupervoxelIsEmptyWhateverTheWeights) {
  const Scene scene = two_boxes();
  for (const std::array<double, 3>& weights : {std::array{0.0, 4.0, 0.0}, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}}) {
    SupervoxelConfig config;
    config.spatial_weight = weights[0];
    config.normal_weight = weights[1];
    config.color_weight = weights[2];
    config.rounds = weights[0] > 0.0 ? 1 : 3;
    const SupervoxelResult found = find_supervoxels(scene.cloud, config, Executor{}).value();
    EXPECT_GT(found.supervoxels.size(), 50U);
    std::size_t voxels{0};
    for (const Supervoxel& supervoxel : found.supervoxels) {
      EXPECT_GT(supervoxel.voxels, 0U);
      EXPECT_TRUE(supervoxel.centroid_m.allFinite());
      voxels += supervoxel.voxels;
    }
    EXPECT_EQ(voxels, found.voxels);
  }
}

TEST(Segmentation, ThreadsChangeNothing) {
  const Scene scene = two_boxes();
  const Segments one = segment(scene.cloud, from_camera(), {}, 1);
  for (const std::size_t threads : {2, 3, 7}) {
    const Segments found = segment(scene.cloud, from_camera(), {}, threads);
    EXPECT_EQ(found.supervoxels.labels, one.supervoxels.labels);
    EXPECT_EQ(found.supervoxels.edges, one.supervoxels.edges);
    EXPECT_EQ(found.lccp.labels, one.lccp.labels);
    for (std::size_t s = 0; s < one.supervoxels.supervoxels.size(); ++s) {
      ASSERT_EQ(found.supervoxels.supervoxels[s].centroid_m, one.supervoxels.supervoxels[s].centroid_m);
      ASSERT_EQ(found.supervoxels.supervoxels[s].normal, one.supervoxels.supervoxels[s].normal);
    }
  }
}

TEST(Segmentation, AMillionPointsAreOneForAnyThreads) {
  PointCloud cloud;
  for (int i = 0; i < 1000; ++i) {
    for (int k = 0; k < 1000; ++k) {
      const float x = 0.001F * static_cast<float>(i);
      const float y = 0.001F * static_cast<float>(k);
      cloud.positions_m.emplace_back(x, y, 1.0F + 0.05F * std::sin(4.0F * x) * std::sin(3.0F * y));
    }
  }
  const Segments one = segment(cloud);
  ASSERT_NO_FATAL_FAILURE(expect_sound(cloud, one));
  EXPECT_EQ(one.lccp.segments, 1U);
  EXPECT_GT(one.supervoxels.supervoxels.size(), 800U);
  for (const std::size_t threads : {2, 4}) {
    const Segments found = segment(cloud, {}, {}, threads);
    EXPECT_EQ(found.supervoxels.labels, one.supervoxels.labels);
    EXPECT_EQ(found.lccp.labels, one.lccp.labels);
  }
}

TEST(Segmentation, BadInputIsRefused) {
  const Executor executor;
  PointCloud cloud = plane();
  cloud.normals.resize(3);
  EXPECT_EQ(find_supervoxels(cloud, {}, executor).error().code, Errc::size_mismatch);
  cloud.normals.clear();
  cloud.positions_m.emplace_back(1e9F, 0.0F, 1.0F);
  EXPECT_EQ(find_supervoxels(cloud, {}, executor).error().code, Errc::invalid_argument);
  SupervoxelConfig config;
  config.seed_spacing_m = 0.001;
  EXPECT_EQ(find_supervoxels(plane(), config, executor).error().code, Errc::invalid_argument);
  config = {};
  for (const int rounds : {-1, 0, 101}) {
    config.rounds = rounds;
    EXPECT_EQ(find_supervoxels(plane(), config, executor).error().code, Errc::invalid_argument);
  }
  config = {};
  config.voxels.voxel_size_m = -1.0;
  EXPECT_EQ(find_supervoxels(plane(), config, executor).error().code, Errc::invalid_argument);
  LccpConfig lccp;
  lccp.smoothness = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(segment_by_convexity({}, lccp).error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace saccade

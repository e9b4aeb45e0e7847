// SPDX-License-Identifier: Apache-2.0
// Supervoxels by PCL's rules against plain loops over voxels, and what each departure from them changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "saccade/segment/lccp.hpp"

namespace saccade {
namespace {

constexpr std::uint64_t kCornerSeed{17};

/// Two walls in a corner, a step on one of them and a bar from its edge, with three colours and noise; normals turn to
/// either side.
PointCloud made_corner(std::mt19937_64& random) {
  PointCloud cloud;
  const auto noise = [&](double sigma) { return static_cast<float>(std::normal_distribution{0.0, sigma}(random)); };
  for (int i = 0; i < 64; ++i) {
    for (int k = 0; k < 64; ++k) {
      const float a = 0.005F * static_cast<float>(i) + noise(0.0008);
      const float b = 0.005F * static_cast<float>(k) + noise(0.0008);
      const bool on_step = i > 20 && i < 44 && k > 20 && k < 44;
      const float side = random() % 5 == 0 ? -1.0F : 1.0F;
      const float tone = i < 30 ? 0.2F : 0.6F;
      cloud.positions_m.emplace_back(a, b, (on_step ? 0.012F : 0.0F) + noise(0.0008));
      cloud.normals.emplace_back(Eigen::Vector3f{noise(0.2), noise(0.2), side}.normalized());
      cloud.colors.emplace_back(tone + noise(0.03), tone + noise(0.03), on_step ? 0.9F : 0.1F);
      cloud.positions_m.emplace_back(noise(0.0008), a, b);
      cloud.normals.emplace_back(Eigen::Vector3f{1.0F, noise(0.2), noise(0.2)}.normalized());
      cloud.colors.emplace_back(0.5F + noise(0.05), 0.5F, 0.2F);
    }
  }
  for (int i = 0; i < 120; ++i) {  // a bar, one voxel wide
    cloud.positions_m.emplace_back(0.155F + noise(0.0008), 0.32F + 0.002F * static_cast<float>(i), 0.004F);
    cloud.normals.emplace_back(Eigen::Vector3f::UnitZ());
    cloud.colors.emplace_back(0.4F, 0.4F, 0.4F);
  }
  return cloud;
}

/// Supervoxels of the seeds, one label per voxel: their means move after every step.
std::vector<std::uint32_t> naive_growth(const VoxelCloud& cloud, const SupervoxelConfig& config) {
  const auto far = [](const CloudVoxel& a, const CloudVoxel& b) { return (a.place - b.place).norm(); };
  const auto spacing = static_cast<float>(config.seed_spacing_m);
  // Seeds: of each cell, in the order of their first voxels, the voxel nearest to the mean.
  std::vector<std::vector<std::uint32_t>> cells;
  std::map<std::array<int, 3>, std::size_t> cell_of;
  for (std::uint32_t v = 0; v < cloud.voxels.size(); ++v) {
    std::array<int, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
      at[static_cast<std::size_t>(axis)] =
          static_cast<int>(std::floor(double{cloud.voxels[v].place[axis]} / config.seed_spacing_m));
    }
    const auto [found, is_new] = cell_of.try_emplace(at, cells.size());
    if (is_new) cells.emplace_back();
    cells[found->second].push_back(v);
  }
  std::vector<std::uint32_t> seeds;
  for (const std::vector<std::uint32_t>& cell : cells) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : cell) mean += cloud.voxels[v].place.cast<double>();
    mean /= static_cast<double>(cell.size());
    const std::uint32_t nearest = *std::min_element(cell.begin(), cell.end(), [&](std::uint32_t a, std::uint32_t b) {
      return (cloud.voxels[a].place.cast<double>() - mean).squaredNorm() <
             (cloud.voxels[b].place.cast<double>() - mean).squaredNorm();
    });
    std::vector<std::uint32_t> around{nearest};
    for (std::size_t next = 0; next < around.size(); ++next) {
      for (const std::uint32_t other : cloud.neighbours(around[next])) {
        if (std::count(around.begin(), around.end(), other) > 0) continue;
        if (far(cloud.voxels[other], cloud.voxels[nearest]) <= 0.5F * spacing) around.push_back(other);
      }
    }
    if (double(around.size()) >= config.fewest_around_seed(config.seed_spacing_m / config.voxels.voxel_size_m)) {
      seeds.push_back(nearest);
    }
  }
  std::vector<CloudVoxel> centres;
  std::vector<std::uint32_t> labels(cloud.voxels.size(), kUnlabelled);
  std::vector<float> distances(cloud.voxels.size(), std::numeric_limits<float>::infinity());
  for (std::uint32_t s = 0; s < seeds.size(); ++s) {
    centres.push_back(cloud.voxels[seeds[s]]);
    labels[seeds[s]] = s;
    distances[seeds[s]] = 0.0F;
  }
  const auto difference = [&](const CloudVoxel& a, const CloudVoxel& b) {
    return static_cast<float>(config.spatial_weight / config.seed_spacing_m) * far(a, b) +
           (static_cast<float>(config.normal_weight) * (1.0F - std::abs(a.normal.dot(b.normal))) +
            static_cast<float>(config.color_weight) * (a.color - b.color).norm());
  };
  const int steps = static_cast<int>(std::ceil(config.reach * (config.seed_spacing_m / config.voxels.voxel_size_m)));
  std::vector<std::uint32_t> order = seeds;
  for (int step = 0; step < steps; ++step) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> offers;
    for (const std::uint32_t v : order) offers.emplace_back(v, labels[v]);
    for (const auto& [v, label] : offers) {
      for (const std::uint32_t other : cloud.neighbours(v)) {
        if (labels[other] == label || std::count(seeds.begin(), seeds.end(), other) > 0) continue;
        const float distance = difference(cloud.voxels[other], centres[label]);
        if (std::pair{distance, label} >= std::pair{distances[other], labels[other]}) continue;
        labels[other] = label;
        distances[other] = distance;
      }
    }
    order.clear();
    for (std::uint32_t s = 0; s < seeds.size(); ++s) {
      Eigen::Matrix<double, 9, 1> sum = Eigen::Matrix<double, 9, 1>::Zero();
      double count{0.0};
      for (std::uint32_t v = 0; v < labels.size(); ++v) {
        if (labels[v] != s) continue;
        sum.head<3>() += cloud.voxels[v].place.cast<double>();
        sum.segment<3>(3) += cloud.voxels[v].normal.cast<double>();
        sum.tail<3>() += cloud.voxels[v].color.cast<double>();
        count += 1.0;
      }
      centres[s].place = (sum.head<3>() / count).cast<float>();
      centres[s].normal = sum.segment<3>(3).normalized().cast<float>();
      centres[s].color = (sum.tail<3>() / count).cast<float>();
    }
    for (std::uint32_t v = 0; v < labels.size(); ++v) {
      if (labels[v] != kUnlabelled) order.push_back(v);
    }
  }
  return labels;
}

TEST(SvLccpAsPrinted, SupervoxelsAreThoseOfPlainLoops) {
  std::mt19937_64 random{kCornerSeed};
  std::printf("seed %llu, 4 cases\n", static_cast<unsigned long long>(kCornerSeed));
  std::size_t compared{0};
  for (int i = 0; i < 4; ++i) {
    const PointCloud cloud = made_corner(random);
    const SupervoxelConfig config = SvLccpConfig::as_printed().supervoxels;
    const Executor executor = Executor::with_threads(1 + random() % 3);
    const VoxelCloud voxels = voxelise(cloud, config.voxels, executor).value();
    const std::vector<std::uint32_t> naive = naive_growth(voxels, config);
    const SupervoxelResult found = find_supervoxels(cloud, config, executor).value();
    for (std::size_t p = 0; p < cloud.positions_m.size(); ++p) {
      const std::uint32_t expected = naive[voxels.voxel_of[p]];
      if (expected == kUnlabelled) continue;  // no seed reached it
      ASSERT_EQ(found.labels[p], expected) << "case " << i << ", point " << p;
      ++compared;
    }
  }
  EXPECT_GT(compared, 30000U);
  std::printf("compared %zu points\n", compared);
}

TEST(SvLccpAsPrinted, EachDepartureChangesLabels) {
  std::mt19937_64 random{kCornerSeed};
  const PointCloud cloud = made_corner(random);
  const auto labels_of = [&](const SvLccpConfig& config) {
    return segment_by_sv_lccp(cloud, config, Executor{}).value();
  };
  const SvLccpConfig printed = SvLccpConfig::as_printed();
  const SvLccpConfig ours;
  const SvLccpResult as_printed = labels_of(printed);
  EXPECT_NE(as_printed.segments.labels, labels_of(ours).segments.labels);
  const auto supervoxels_change = [&](const char* name, auto&& depart) {
    SvLccpConfig config = printed;
    depart(config.supervoxels);
    EXPECT_NE(labels_of(config).supervoxels.labels, as_printed.supervoxels.labels) << name;
  };
  const SupervoxelConfig& default_ = ours.supervoxels;
  supervoxels_change("rounds", [&](SupervoxelConfig& c) { c.rounds = default_.rounds; });
  supervoxels_change("seeds settle", [&](SupervoxelConfig& c) { c.seeds_settle = default_.seeds_settle; });
  supervoxels_change("seed share", [&](SupervoxelConfig& c) { c.min_seed_share = default_.min_seed_share; });
  supervoxels_change("reach", [&](SupervoxelConfig& c) { c.reach = default_.reach; });
  supervoxels_change("moves", [&](SupervoxelConfig& c) { c.moves_in_growth = default_.moves_in_growth; });
  supervoxels_change("sides", [&](SupervoxelConfig& c) { c.opposite_is_alike = default_.opposite_is_alike; });
  const auto edges_change = [&](const char* name, auto&& depart) {
    SvLccpConfig config = printed;
    depart(config.lccp);
    EXPECT_NE(labels_of(config).segments.convex, as_printed.segments.convex) << name;
  };
  edges_change("sanity", [&](LccpConfig& c) { c.sanity = ours.lccp.sanity; });
  edges_change("smoothness", [&](LccpConfig& c) { c.smooth = ours.lccp.smooth; });
  SvLccpConfig bad = printed;
  bad.supervoxels.reach = 101.0;
  EXPECT_EQ(bad.validate().error().code, Errc::invalid_argument);
}

/// Eq. 4.15: edges whose colours are farther apart than T_lccp go, and only these.
TEST(SvLccpAsPrinted, PruningIsEq415) {
  std::mt19937_64 random{kCornerSeed};
  const PointCloud cloud = made_corner(random);
  SupervoxelResult found = find_supervoxels(cloud, SvLccpConfig::as_printed().supervoxels, Executor{}).value();
  constexpr double kThreshold{0.12};
  std::vector<std::pair<std::uint32_t, std::uint32_t>> expected;
  for (const auto& [a, b] : found.edges) {
    double squared{0.0};
    for (int c = 0; c < 3; ++c) {
      squared += std::pow(double{found.supervoxels[a].color[c]} - double{found.supervoxels[b].color[c]}, 2.0);
    }
    if (std::sqrt(squared) <= kThreshold) expected.emplace_back(a, b);
  }
  EXPECT_GT(expected.size(), 10U);
  EXPECT_LT(expected.size(), found.edges.size());
  prune_by_color(found, kThreshold);
  EXPECT_EQ(found.edges, expected);
}

}  // namespace
}  // namespace saccade

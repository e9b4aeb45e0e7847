// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/supervoxels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "saccade/segment/cell_index.hpp"
#include "saccade/segment/voxel_difference.hpp"

namespace saccade {

namespace {

constexpr std::size_t kSeedGrain{512};

class Clustering {
 public:
  Clustering(const VoxelCloud& cloud, const SupervoxelConfig& config, const Executor& executor)
      : cloud_{cloud},
        config_{config},
        executor_{executor},
        difference_{config},
        labels_(cloud.voxels.size(), kUnlabelled),
        distances_(cloud.voxels.size(), std::numeric_limits<float>::infinity()),
        is_changed_(cloud.voxels.size()) {}

  /// A label for every voxel.
  std::vector<std::uint32_t> run() {
    for (const std::uint32_t seed : seeds()) {
      add(seed);
      distances_[seed] = 0.0F;
    }
    changed_ = seeds_;
    const double reach =
        2.0 * config_.seed_spacing_m / config_.voxels.voxel_size_m;  // of a seed among others, in voxels
    for (double step = 0.0; step < reach && !changed_.empty(); step += 1.0) grow();
    fill_rest();
    return compact();
  }

 private:
  void add(std::uint32_t voxel) {
    labels_[voxel] = static_cast<std::uint32_t>(seeds_.size());
    seeds_.push_back(voxel);
  }

  /// How much normals and colours differ from the neighbours'.
  [[nodiscard]] float gradient(std::uint32_t voxel) const {
    const CloudVoxel& here = cloud_.voxels[voxel];
    float sum{0.0F};
    for (const std::uint32_t other : cloud_.neighbours(voxel))
      sum += difference_.of_surfaces(here, cloud_.voxels[other]);
    return sum / static_cast<float>(std::max<std::size_t>(1, cloud_.neighbours(voxel).size()));
  }

  /// In each cell of the grid the voxel nearest to the mean of those in it.
  [[nodiscard]] std::vector<std::uint32_t> cell_voxels() const {
    CellIndex index;
    std::vector<std::uint32_t> cell_of(cloud_.voxels.size());
    std::vector<Eigen::Vector3d> sums;
    std::vector<double> counts;
    for (std::size_t v = 0; v < cloud_.voxels.size(); ++v) {
      const std::uint32_t cell = cell_of[v] = index.insert(cell_at(cloud_.voxels[v].place, config_.seed_spacing_m));
      if (cell == sums.size()) {
        sums.emplace_back(Eigen::Vector3d::Zero());
        counts.push_back(0.0);
      }
      sums[cell] += cloud_.voxels[v].place.cast<double>();
      counts[cell] += 1.0;
    }
    std::vector<std::uint32_t> nearest(sums.size(), kUnlabelled);
    std::vector<double> nearest_squared(sums.size());
    for (std::size_t c = 0; c < sums.size(); ++c) sums[c] /= counts[c];
    for (std::size_t v = 0; v < cloud_.voxels.size(); ++v) {
      const std::uint32_t cell = cell_of[v];
      const double squared = (cloud_.voxels[v].place.cast<double>() - sums[cell]).squaredNorm();
      if (nearest[cell] != kUnlabelled && squared >= nearest_squared[cell]) continue;
      nearest[cell] = static_cast<std::uint32_t>(v);
      nearest_squared[cell] = squared;
    }
    return nearest;
  }

  /// Seeds that have enough voxels around them, each moved to the least gradient there.
  [[nodiscard]] std::vector<std::uint32_t> seeds() const {
    const double radius_m = 0.5 * config_.seed_spacing_m;
    const double fewest = config_.fewest_around_seed(config_.seed_spacing_m / config_.voxels.voxel_size_m);
    const std::vector<std::uint32_t> candidates = cell_voxels();
    std::vector<std::uint32_t> chosen(candidates.size(), kUnlabelled);
    executor_.parallel_for(candidates.size(), kSeedGrain, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> around;
      std::vector<bool> met(cloud_.voxels.size());
      for (std::size_t i = begin; i < end; ++i) {
        voxels_around(candidates[i], radius_m, around, met);
        if (static_cast<double>(around.size()) < fewest) continue;
        float least{0.0F};
        for (const std::uint32_t voxel : around) {
          const float here = gradient(voxel);
          if (chosen[i] != kUnlabelled && here >= least) continue;
          chosen[i] = voxel;
          least = here;
        }
      }
    });
    std::vector<std::uint32_t> kept;
    std::vector<bool> taken(cloud_.voxels.size());
    for (const std::uint32_t voxel : chosen) {
      if (voxel == kUnlabelled || taken[voxel]) continue;
      taken[voxel] = true;
      kept.push_back(voxel);
    }
    return kept;
  }

  /// Those within the radius to which voxels within it lead; the nearest first, roughly.
  /// None is `met` before or after.
  void voxels_around(std::uint32_t centre, double radius_m, std::vector<std::uint32_t>& around,
                     std::vector<bool>& met) const {
    const auto limit = static_cast<float>(radius_m * radius_m);
    around.assign(1, centre);
    met[centre] = true;
    for (std::size_t next = 0; next < around.size(); ++next) {
      for (const std::uint32_t other : cloud_.neighbours(around[next])) {
        if (met[other]) continue;
        if ((cloud_.voxels[other].place - cloud_.voxels[centre].place).squaredNorm() > limit) continue;
        met[other] = true;
        around.push_back(other);
      }
    }
    for (const std::uint32_t voxel : around) met[voxel] = false;
  }

  /// What voxels got in the last step they offer to their neighbours, which take it if it is nearer; all at once.
  void grow() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> offers;
    for (const std::uint32_t voxel : changed_) {
      offers.emplace_back(voxel, labels_[voxel]);
      is_changed_[voxel] = false;
    }
    changed_.clear();
    for (const auto& [voxel, label] : offers) {
      const CloudVoxel& seed = cloud_.voxels[seeds_[label]];
      for (const std::uint32_t other : cloud_.neighbours(voxel)) {
        if (labels_[other] == label) continue;
        const float distance = difference_.of(cloud_.voxels[other], seed);
        if (std::pair{distance, label} >= std::pair{distances_[other], labels_[other]}) continue;
        labels_[other] = label;
        distances_[other] = distance;
        if (!is_changed_[other]) changed_.push_back(other);
        is_changed_[other] = true;
      }
    }
  }

  /// Voxels that no seed reached in time go on growing; connected parts without a seed become supervoxels.
  void fill_rest() {
    std::vector<std::uint32_t> front;
    const auto spread = [&] {
      for (std::size_t next = 0; next < front.size(); ++next) {
        for (const std::uint32_t other : cloud_.neighbours(front[next])) {
          if (labels_[other] != kUnlabelled) continue;
          labels_[other] = labels_[front[next]];
          front.push_back(other);
        }
      }
      front.clear();
    };
    std::vector<std::uint32_t> rest;
    for (std::uint32_t v = 0; v < labels_.size(); ++v) {
      if (labels_[v] == kUnlabelled) rest.push_back(v);
    }
    // Labelled voxels next to these, in the order of voxels.
    for (const std::uint32_t v : rest) {
      for (const std::uint32_t other : cloud_.neighbours(v)) {
        if (labels_[other] != kUnlabelled) front.push_back(other);
      }
    }
    std::sort(front.begin(), front.end());
    front.erase(std::unique(front.begin(), front.end()), front.end());
    spread();
    for (const std::uint32_t v : rest) {
      if (labels_[v] != kUnlabelled) continue;
      add(v);
      front.push_back(v);
      spread();
    }
  }

  /// Labels without those that no voxel has.
  std::vector<std::uint32_t> compact() {
    std::vector<std::uint32_t> renamed(seeds_.size(), kUnlabelled);
    std::uint32_t used{0};
    for (const std::uint32_t label : labels_) renamed[label] = 0;
    for (std::uint32_t& name : renamed) {
      if (name == 0) name = used++;
    }
    for (std::uint32_t& label : labels_) label = renamed[label];
    return std::move(labels_);
  }

  const VoxelCloud& cloud_;
  const SupervoxelConfig& config_;
  const Executor& executor_;
  const VoxelDifference difference_;
  std::vector<std::uint32_t> labels_;
  std::vector<float> distances_;      ///< from the seed of the label
  std::vector<std::uint32_t> seeds_;  ///< a voxel per label
  std::vector<std::uint32_t> changed_;
  std::vector<bool> is_changed_;
};

std::vector<Supervoxel> summarise(const VoxelCloud& cloud, const std::vector<std::uint32_t>& labels) {
  const std::size_t count = labels.empty() ? 0 : std::size_t{1} + *std::max_element(labels.begin(), labels.end());
  std::vector<Supervoxel> supervoxels(count);
  std::vector<Eigen::Matrix<double, 9, 1>> sums(count, Eigen::Matrix<double, 9, 1>::Zero());
  for (std::size_t v = 0; v < labels.size(); ++v) {
    const CloudVoxel& voxel = cloud.voxels[v];
    sums[labels[v]].head<3>() += voxel.position_m.cast<double>();
    sums[labels[v]].segment<3>(3) += voxel.normal.cast<double>();
    sums[labels[v]].tail<3>() += voxel.color.cast<double>();
    supervoxels[labels[v]].voxels += 1;
    supervoxels[labels[v]].points += voxel.points;
  }
  for (std::size_t s = 0; s < count; ++s) {
    const Eigen::Matrix<double, 9, 1> mean = sums[s] / static_cast<double>(supervoxels[s].voxels);
    supervoxels[s].centroid_m = mean.head<3>().cast<float>();
    supervoxels[s].normal = mean.segment<3>(3).normalized().cast<float>();
    supervoxels[s].color = mean.tail<3>().cast<float>();
  }
  return supervoxels;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> touching(const VoxelCloud& cloud,
                                                              const std::vector<std::uint32_t>& labels) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::uint32_t v = 0; v < labels.size(); ++v) {
    for (const std::uint32_t other : cloud.neighbours(v)) {
      const std::pair edge{labels[v], labels[other]};
      if (edge.first < edge.second && (edges.empty() || edges.back() != edge)) edges.push_back(edge);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

Status SupervoxelConfig::validate() const {
  SACCADE_CHECK(voxels.validate());
  const auto error = [](const char* message) { return Error{Errc::invalid_argument, message, "supervoxels"}; };
  for (const double number : {seed_spacing_m, spatial_weight, normal_weight, color_weight, min_seed_share}) {
    if (!(std::isfinite(number) && number >= 0.0)) return error("a number that is not finite, or negative");
  }
  if (spatial_weight + normal_weight + color_weight == 0.0) return error("all weights are zero");
  if (seed_spacing_m < voxels.voxel_size_m) return error("seed_spacing_m must be at least voxel_size_m");
  return {};
}

double SupervoxelConfig::fewest_around_seed(double spacing_vox) const {
  return min_seed_share * std::numbers::pi * 0.25 * spacing_vox * spacing_vox;
}

Result<SupervoxelResult> find_supervoxels(const PointCloud& cloud, const SupervoxelConfig& config,
                                          const Executor& executor) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(const VoxelCloud voxels, voxelise(cloud, config.voxels, executor));
  const std::vector<std::uint32_t> labels = Clustering{voxels, config, executor}.run();
  SupervoxelResult result;
  result.supervoxels = summarise(voxels, labels);
  result.edges = touching(voxels, labels);
  result.voxels = voxels.voxels.size();
  result.voxel_size_m = config.voxels.voxel_size_m;
  result.labels = voxels.voxel_of;
  for (std::uint32_t& label : result.labels) {
    if (label != kUnlabelled) label = labels[label];
  }
  return result;
}

}  // namespace saccade

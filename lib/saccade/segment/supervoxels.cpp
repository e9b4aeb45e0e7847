// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/supervoxels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "saccade/segment/cell_index.hpp"

namespace saccade {

namespace {

constexpr std::size_t kGrain{1024};

/// What a voxel is compared with.
struct Centre {
  Eigen::Vector3f place;
  Eigen::Vector3f normal;
  Eigen::Vector3f color;
};

class Clustering {
 public:
  Clustering(const VoxelCloud& cloud, const SupervoxelConfig& config, const Executor& executor)
      : cloud_{cloud},
        config_{config},
        executor_{executor},
        spatial_{static_cast<float>(config.spatial_weight / config.seed_spacing_m)},
        normal_{static_cast<float>(config.normal_weight)},
        color_{static_cast<float>(config.color_weight)},
        labels_(cloud.voxels.size(), kUnlabelled),
        open_(cloud.voxels.size(), 0) {}

  /// A label for every voxel.
  std::vector<std::uint32_t> run() {
    for (const std::uint32_t seed : seeds()) add(seed);
    const double reach =
        2.0 * config_.seed_spacing_m / config_.voxels.voxel_size_m;  // of a seed among others, in voxels
    for (double step = 0.0; step < reach && grow(); step += 1.0) {
    }
    for (std::size_t round = 0; round < config_.max_rounds; ++round) {
      move_centres();
      std::fill(open_.begin(), open_.end(), 1);
      if (!grow()) break;
    }
    fill_rest();
    return compact();
  }

 private:
  [[nodiscard]] float distance(const CloudVoxel& voxel, const Centre& centre) const {
    float sum = spatial_ * (voxel.place - centre.place).norm() + normal_ * (1.0F - voxel.normal.dot(centre.normal));
    if (color_ > 0.0F) sum += color_ * (voxel.color - centre.color).norm();
    return sum;
  }

  void add(std::uint32_t voxel) {
    labels_[voxel] = static_cast<std::uint32_t>(centres_.size());
    centres_.push_back({cloud_.voxels[voxel].place, cloud_.voxels[voxel].normal, cloud_.voxels[voxel].color});
    for (const std::uint32_t other : cloud_.neighbours(voxel)) open_[other] = 1;
  }

  /// How much normals and colours differ from the neighbours'.
  [[nodiscard]] float gradient(std::uint32_t voxel) const {
    const CloudVoxel& here = cloud_.voxels[voxel];
    float sum{0.0F};
    for (const std::uint32_t other : cloud_.neighbours(voxel)) {
      const CloudVoxel& there = cloud_.voxels[other];
      sum += normal_ * (1.0F - here.normal.dot(there.normal)) + color_ * (here.color - there.color).norm();
    }
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
    for (std::size_t v = 0; v < cloud_.voxels.size(); ++v) {
      const std::uint32_t cell = cell_of[v];
      const double squared = (cloud_.voxels[v].place.cast<double>() - sums[cell] / counts[cell]).squaredNorm();
      if (nearest[cell] != kUnlabelled && squared >= nearest_squared[cell]) continue;
      nearest[cell] = static_cast<std::uint32_t>(v);
      nearest_squared[cell] = squared;
    }
    return nearest;
  }

  /// Seeds that have enough voxels around them, each moved to the least gradient there.
  [[nodiscard]] std::vector<std::uint32_t> seeds() const {
    const double radius_m = 0.5 * config_.seed_spacing_m;
    const double across = radius_m / config_.voxels.voxel_size_m;
    const double fewest = config_.min_seed_share * std::numbers::pi * across * across;
    const std::vector<std::uint32_t> candidates = cell_voxels();
    std::vector<std::uint32_t> chosen(candidates.size(), kUnlabelled);
    executor_.parallel_for(candidates.size(), 64, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> around;
      for (std::size_t i = begin; i < end; ++i) {
        voxels_around(candidates[i], radius_m, around);
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
  void voxels_around(std::uint32_t centre, double radius_m, std::vector<std::uint32_t>& around) const {
    const auto limit = static_cast<float>(radius_m * radius_m);
    around.assign(1, centre);
    for (std::size_t next = 0; next < around.size(); ++next) {
      for (const std::uint32_t other : cloud_.neighbours(around[next])) {
        if ((cloud_.voxels[other].place - cloud_.voxels[centre].place).squaredNorm() > limit) continue;
        if (std::find(around.begin(), around.end(), other) == around.end()) around.push_back(other);
      }
    }
  }

  /// Every open voxel goes to the nearest centre among its own and its neighbours'; then those next to one that changed
  /// are open. @return whether there are any.
  bool grow() {
    std::vector<std::uint32_t> next = labels_;
    std::vector<std::vector<std::uint32_t>> changed((labels_.size() + kGrain - 1) / kGrain);
    executor_.parallel_for(labels_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (open_[v] == 0) continue;
        open_[v] = 0;
        next[v] = nearest_label(static_cast<std::uint32_t>(v));
        if (next[v] != labels_[v]) changed[begin / kGrain].push_back(static_cast<std::uint32_t>(v));
      }
    });
    labels_.swap(next);
    bool any{false};
    for (const std::vector<std::uint32_t>& chunk : changed) {
      for (const std::uint32_t voxel : chunk) {
        any = true;
        for (const std::uint32_t other : cloud_.neighbours(voxel)) open_[other] = 1;
      }
    }
    return any;
  }

  [[nodiscard]] std::uint32_t nearest_label(std::uint32_t v) const {
    const CloudVoxel& voxel = cloud_.voxels[v];
    std::uint32_t best = labels_[v];
    float least{-1.0F};  // not computed yet
    std::uint32_t last = best;
    for (const std::uint32_t other : cloud_.neighbours(v)) {
      const std::uint32_t label = labels_[other];
      if (label == last || label == best || label == kUnlabelled) continue;
      last = label;
      if (best != kUnlabelled && least < 0.0F) least = distance(voxel, centres_[best]);
      const float there = distance(voxel, centres_[label]);
      if (best == kUnlabelled || there < least || (there == least && label < best)) {
        best = label;
        least = there;
      }
    }
    return best;
  }

  /// To the means of their voxels; a centre that lost all of them stays.
  void move_centres() {
    std::vector<Eigen::Matrix<double, 9, 1>> sums(centres_.size(), Eigen::Matrix<double, 9, 1>::Zero());
    std::vector<double> counts(centres_.size(), 0.0);
    for (std::size_t v = 0; v < labels_.size(); ++v) {
      if (labels_[v] == kUnlabelled) continue;
      const CloudVoxel& voxel = cloud_.voxels[v];
      Eigen::Matrix<double, 9, 1>& sum = sums[labels_[v]];
      sum.head<3>() += voxel.place.cast<double>();
      sum.segment<3>(3) += voxel.normal.cast<double>();
      sum.tail<3>() += voxel.color.cast<double>();
      counts[labels_[v]] += 1.0;
    }
    for (std::size_t c = 0; c < centres_.size(); ++c) {
      if (counts[c] == 0.0) continue;
      const Eigen::Matrix<double, 9, 1> mean = sums[c] / counts[c];
      centres_[c].place = mean.head<3>().cast<float>();
      if (mean.segment<3>(3).squaredNorm() > 0.0) centres_[c].normal = mean.segment<3>(3).normalized().cast<float>();
      centres_[c].color = mean.tail<3>().cast<float>();
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
    for (std::uint32_t v = 0; v < labels_.size(); ++v) {
      if (labels_[v] != kUnlabelled) front.push_back(v);
    }
    spread();
    for (std::uint32_t v = 0; v < labels_.size(); ++v) {
      if (labels_[v] != kUnlabelled) continue;
      add(v);
      front.push_back(v);
      spread();
    }
  }

  /// Labels without those that no voxel has.
  std::vector<std::uint32_t> compact() {
    std::vector<std::uint32_t> renamed(centres_.size(), kUnlabelled);
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
  float spatial_, normal_, color_;
  std::vector<std::uint32_t> labels_;
  std::vector<std::uint8_t> open_;  ///< voxels for which another centre may be nearer
  std::vector<Centre> centres_;
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

// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/internal/supervoxel_growth.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace saccade {

namespace {

constexpr std::size_t kSeedGrain{512};

/// Sum of positions, normals and colours.
class VoxelSum {
 public:
  void add(const CloudVoxel& voxel) {
    place_ += voxel.place.cast<double>();
    normal_ += voxel.normal.cast<double>();
    color_ += voxel.color.cast<double>();
    count_ += 1.0;
  }
  [[nodiscard]] bool empty() const { return count_ == 0.0; }
  /// Returns the mean. `position_m` stays zero; the normal has unit length, or is zero where the sum is.
  [[nodiscard]] CloudVoxel mean() const {
    return {(place_ / count_).cast<float>(), Eigen::Vector3f::Zero(), normal_.normalized().cast<float>(),
            (color_ / count_).cast<float>(), 0};
  }

 private:
  Eigen::Vector3d place_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d normal_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d color_{Eigen::Vector3d::Zero()};
  double count_{0.0};
};

}  // namespace

void SupervoxelGrowth::seed(std::span<const std::uint32_t> cell_of, std::size_t cells, double radius, double fewest,
                            const Executor& executor) {
  const std::vector<std::uint32_t> candidates = voxels_nearest_to_means(cell_of, cells);
  std::vector<std::uint32_t> chosen(candidates.size(), kUnlabelled);
  executor.parallel_for(candidates.size(), kSeedGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> around;
    std::vector<bool> met(cloud_.voxels.size());
    for (std::size_t i = begin; i < end; ++i) {
      voxels_around(candidates[i], radius, around, met);
      if (static_cast<double>(around.size()) < fewest) continue;
      if (!seeds_settle_) {
        chosen[i] = candidates[i];
        continue;
      }
      float least{0.0F};
      for (const std::uint32_t voxel : around) {
        const float here = gradient(voxel);
        if (chosen[i] != kUnlabelled && here >= least) continue;
        chosen[i] = voxel;
        least = here;
      }
    }
  });
  grown_ = {std::vector<std::uint32_t>(cloud_.voxels.size(), kUnlabelled), {}};
  for (const std::uint32_t voxel : chosen) {
    if (voxel == kUnlabelled || grown_.labels[voxel] != kUnlabelled) continue;
    grown_.labels[voxel] = static_cast<std::uint32_t>(grown_.seeds.size());
    grown_.seeds.push_back(voxel);
  }
  centres_.clear();
  for (const std::uint32_t seed : grown_.seeds) centres_.push_back(cloud_.voxels[seed]);
}

void SupervoxelGrowth::move_to_means(const Grown& grown) {
  const std::size_t count = grown.seeds.size();
  std::vector<VoxelSum> sums(count);
  for (std::size_t v = 0; v < grown.labels.size(); ++v) {
    if (grown.labels[v] != kUnlabelled) sums[grown.labels[v]].add(cloud_.voxels[v]);
  }
  for (std::size_t s = 0; s < count; ++s) centres_[s] = sums[s].mean();
  std::vector<float> nearest_squared(count, std::numeric_limits<float>::infinity());
  grown_.seeds = grown.seeds;
  for (std::uint32_t v = 0; v < grown.labels.size(); ++v) {
    const std::uint32_t s = grown.labels[v];
    if (s == kUnlabelled) continue;
    const float squared = (cloud_.voxels[v].place - centres_[s].place).squaredNorm();
    if (squared >= nearest_squared[s]) continue;
    nearest_squared[s] = squared;
    grown_.seeds[s] = v;
  }
  grown_.labels.assign(cloud_.voxels.size(), kUnlabelled);
  for (std::uint32_t s = 0; s < count; ++s) grown_.labels[grown_.seeds[s]] = s;
}

SupervoxelGrowth::Grown SupervoxelGrowth::grow(double steps, std::span<const std::uint8_t> outside) {
  distances_.assign(cloud_.voxels.size(), std::numeric_limits<float>::infinity());
  for (std::size_t v = 0; v < outside.size(); ++v) {
    if (outside[v] != 0) distances_[v] = kOutside;
  }
  is_changed_.assign(cloud_.voxels.size(), 0);
  changed_.clear();
  for (const std::uint32_t seed : grown_.seeds) {
    if (distances_[seed] == kOutside) continue;
    distances_[seed] = 0.0F;
    changed_.push_back(seed);
  }
  for (double done = 0.0; done < steps && !changed_.empty(); done += 1.0) {
    step();
    if (moves_in_growth_) recenter();
  }
  return std::move(grown_);
}

/// Moves the centres to the means of their voxels; all voxels but those that nothing reached offer their labels anew.
void SupervoxelGrowth::recenter() {
  std::vector<VoxelSum> sums(centres_.size());
  changed_.clear();
  for (std::uint32_t v = 0; v < grown_.labels.size(); ++v) {
    if (grown_.labels[v] == kUnlabelled || distances_[v] == kOutside) continue;
    sums[grown_.labels[v]].add(cloud_.voxels[v]);
    changed_.push_back(v);
    is_changed_[v] = 1;
  }
  for (std::size_t s = 0; s < centres_.size(); ++s) {
    if (!sums[s].empty()) centres_[s] = sums[s].mean();
  }
}

/// Returns the difference of normals and colours from the neighbours'.
float SupervoxelGrowth::gradient(std::uint32_t voxel) const {
  const CloudVoxel& here = cloud_.voxels[voxel];
  float sum{0.0F};
  for (const std::uint32_t other : cloud_.neighbours(voxel)) sum += difference_.of_surfaces(here, cloud_.voxels[other]);
  return sum / static_cast<float>(std::max<std::size_t>(1, cloud_.neighbours(voxel).size()));
}

std::vector<std::uint32_t> SupervoxelGrowth::voxels_nearest_to_means(std::span<const std::uint32_t> cell_of,
                                                                     std::size_t cells) const {
  std::vector<Eigen::Vector3d> means(cells, Eigen::Vector3d::Zero());
  std::vector<double> counts(cells, 0.0);
  for (std::size_t v = 0; v < cell_of.size(); ++v) {
    means[cell_of[v]] += cloud_.voxels[v].place.cast<double>();
    counts[cell_of[v]] += 1.0;
  }
  for (std::size_t c = 0; c < cells; ++c) means[c] /= counts[c];
  std::vector<std::uint32_t> nearest(cells, kUnlabelled);
  std::vector<double> nearest_squared(cells);
  for (std::size_t v = 0; v < cell_of.size(); ++v) {
    const std::uint32_t cell = cell_of[v];
    const double squared = (cloud_.voxels[v].place.cast<double>() - means[cell]).squaredNorm();
    if (nearest[cell] != kUnlabelled && squared >= nearest_squared[cell]) continue;
    nearest[cell] = static_cast<std::uint32_t>(v);
    nearest_squared[cell] = squared;
  }
  return nearest;
}

/// Those within the radius to which voxels within it lead; the nearest first, roughly. None is `met` before or after.
void SupervoxelGrowth::voxels_around(std::uint32_t centre, double radius, std::vector<std::uint32_t>& around,
                                     std::vector<bool>& met) const {
  const auto limit = static_cast<float>(radius * radius);
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

/// Offers the labels of the last step to the neighbours, which take them if nearer; all at once.
void SupervoxelGrowth::step() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> offers;
  offers.reserve(changed_.size());
  for (const std::uint32_t voxel : changed_) {
    offers.emplace_back(voxel, grown_.labels[voxel]);
    is_changed_[voxel] = 0;
  }
  changed_.clear();
  for (const auto& [voxel, label] : offers) {
    const CloudVoxel& centre = centres_[label];
    for (const std::uint32_t other : cloud_.neighbours(voxel)) {
      if (grown_.labels[other] == label || distances_[other] == kOutside) continue;
      if (distances_[other] == 0.0F && grown_.seeds[grown_.labels[other]] == other) continue;  // a seed keeps its label
      const float distance = difference_.of(cloud_.voxels[other], centre);
      if (std::pair{distance, label} >= std::pair{distances_[other], grown_.labels[other]}) continue;
      grown_.labels[other] = label;
      distances_[other] = distance;
      if (is_changed_[other] == 0) changed_.push_back(other);
      is_changed_[other] = 1;
    }
  }
}

}  // namespace saccade

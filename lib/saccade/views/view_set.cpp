// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/view_set.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace saccade {
namespace {

using Key = std::array<int, 3>;

/// A voxel by its number, and what a view promises of it.
struct Part {
  std::uint32_t voxel{0};
  double worth{0.0};
};
using Parts = std::vector<Part>;

/// Numbers the voxels of all promises, and adds up what one says of a voxel more than once.
struct Numbered {
  std::vector<Parts> promises;
  std::size_t voxels{0};

  explicit Numbered(std::span<const Promise> given) {
    std::vector<Key> keys;
    for (const Promise& promise : given) {
      for (const PromisedVoxel& part : promise.voxels) keys.push_back(key(part));
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    voxels = keys.size();
    for (const Promise& promise : given) {
      Parts parts;
      for (const PromisedVoxel& part : promise.voxels) {
        const auto at = std::lower_bound(keys.begin(), keys.end(), key(part));
        parts.push_back({static_cast<std::uint32_t>(at - keys.begin()), part.worth});
      }
      promises.push_back(summed(std::move(parts)));
    }
  }

 private:
  static Key key(const PromisedVoxel& part) { return {part.voxel.x, part.voxel.y, part.voxel.z}; }
  static Parts summed(Parts parts) {
    std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.voxel < b.voxel; });
    Parts sums;
    for (const Part& part : parts) {
      if (sums.empty() || sums.back().voxel != part.voxel) {
        sums.push_back(part);
      } else {
        sums.back().worth += part.worth;
      }
    }
    return sums;
  }
};

/// The most that any view of a set promises of each voxel.
class Union {
 public:
  explicit Union(std::size_t voxels) : most_(voxels, 0.0) {}
  void add(const Parts& parts) {
    for (const Part& part : parts) most_[part.voxel] = std::max(most_[part.voxel], part.worth);
  }
  [[nodiscard]] double added_by(const Parts& parts) const {
    double sum = 0.0;
    for (const Part& part : parts) sum += std::max(0.0, part.worth - most_[part.voxel]);
    return sum;
  }
  [[nodiscard]] double worth() const { return std::accumulate(most_.begin(), most_.end(), 0.0); }

 private:
  std::vector<double> most_;
};

struct Best {
  std::size_t view{0};
  double adds{0.0};
};

/// Returns the view that adds most, the first of those that add as much.
Best best_addition(const Union& to, std::span<const Parts> views, const Executor& executor) {
  std::vector<double> adds(views.size());
  executor.parallel_for(views.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) adds[i] = to.added_by(views[i]);
  });
  const auto most = std::max_element(adds.begin(), adds.end());
  return {static_cast<std::size_t>(most - adds.begin()), *most};
}

/// Replaces members by views that add more in their place. Returns whether one was replaced.
bool exchange(std::vector<std::size_t>& set, const Numbered& all, const Executor& executor) {
  constexpr double kRounding{1e-9};
  bool exchanged = false;
  for (std::size_t& member : set) {
    Union others{all.voxels};
    for (const std::size_t other : set) {
      if (other != member) others.add(all.promises[other]);
    }
    const Best best = best_addition(others, all.promises, executor);
    if (!(best.adds > (1.0 + kRounding) * others.added_by(all.promises[member]))) continue;
    member = best.view;
    exchanged = true;
  }
  return exchanged;
}

}  // namespace

std::vector<std::size_t> best_together(std::span<const Promise> promises, std::size_t count, const Executor& executor) {
  constexpr int kRounds{4};
  const Numbered all{promises};
  std::vector<std::size_t> set;
  Union together{all.voxels};
  while (set.size() < std::min(count, promises.size())) {
    const Best best = best_addition(together, all.promises, executor);
    if (!(best.adds > 0.0)) break;
    together.add(all.promises[best.view]);
    set.push_back(best.view);
  }
  for (int round = 0; round < kRounds && set.size() > 1 && exchange(set, all, executor);) ++round;
  return set;
}

double worth_together(std::span<const Promise> promises) {
  const Numbered all{promises};
  Union together{all.voxels};
  for (const Parts& parts : all.promises) together.add(parts);
  return together.worth();
}

}  // namespace saccade

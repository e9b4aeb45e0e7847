// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/view_set.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace saccade {
namespace {

using Key = std::array<int, 3>;

/// Voxel by its number, and a view's promise of it.
struct Part {
  std::uint32_t voxel{0};
  double worth{0.0};
};
using Parts = std::vector<Part>;

/// Voxels of all promises, numbered, with repeated parts of one promise added up.
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

/// Largest promise of any view of a set, per voxel.
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

/// Returns the view that adds most, the first at a tie.
Best best_addition(const Union& to, std::span<const Parts> views, const Executor& executor) {
  std::vector<double> adds(views.size());
  executor.parallel_for(views.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) adds[i] = to.added_by(views[i]);
  });
  const auto most = std::max_element(adds.begin(), adds.end());
  return {static_cast<std::size_t>(most - adds.begin()), *most};
}

/// Returns the worth of a sequence: each view's addition, counted once for each view from there on.
double worth_in_order(const Numbered& all, std::span<const std::size_t> sequence) {
  Union before{all.voxels};
  double sum = 0.0;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const Parts& parts = all.promises[sequence[i]];
    sum += static_cast<double>(sequence.size() - i) * before.added_by(parts);
    before.add(parts);
  }
  return sum;
}

/// Replaces members by views that are worth more in their place. Returns whether one was replaced.
bool exchange(std::vector<std::size_t>& sequence, const Numbered& all, const Executor& executor) {
  constexpr double kRounding{1e-9};
  bool exchanged = false;
  for (std::size_t& member : sequence) {
    std::vector<double> worth(all.promises.size());
    const auto place = static_cast<std::size_t>(&member - sequence.data());
    executor.parallel_for(worth.size(), 8, [&](std::size_t begin, std::size_t end) {
      std::vector<std::size_t> changed = sequence;
      for (std::size_t i = begin; i < end; ++i) {
        changed[place] = i;
        worth[i] = worth_in_order(all, changed);
      }
    });
    const auto most = std::max_element(worth.begin(), worth.end());
    if (!(*most > (1.0 + kRounding) * worth[member])) continue;
    member = static_cast<std::size_t>(most - worth.begin());
    exchanged = true;
  }
  return exchanged;
}

/// Sorts greedily: first the view that shows most, then each time the view that adds most.
std::vector<std::size_t> in_greedy_order(const Numbered& all, std::vector<std::size_t> views) {
  Union before{all.voxels};
  for (auto next = views.begin(); next != views.end(); ++next) {
    const auto adds_less = [&](std::size_t a, std::size_t b) {
      return before.added_by(all.promises[a]) < before.added_by(all.promises[b]);
    };
    std::iter_swap(next, std::max_element(next, views.end(), adds_less));
    before.add(all.promises[*next]);
  }
  return views;
}

}  // namespace

std::vector<std::size_t> best_sequence(std::span<const Promise> promises, std::size_t count, const Executor& executor) {
  constexpr int kRounds{4};
  const Numbered all{promises};
  std::vector<std::size_t> sequence;
  Union together{all.voxels};
  while (sequence.size() < std::min(count, promises.size())) {
    const Best best = best_addition(together, all.promises, executor);
    if (!(best.adds > 0.0)) break;
    together.add(all.promises[best.view]);
    sequence.push_back(best.view);
  }
  for (int round = 0; round < kRounds && sequence.size() > 1; ++round) {
    if (!exchange(sequence, all, executor)) break;
    std::vector<std::size_t> ordered = in_greedy_order(all, sequence);
    if (worth_in_order(all, ordered) > worth_in_order(all, sequence)) sequence = std::move(ordered);
  }
  return sequence;
}

double worth_together(std::span<const Promise> promises) {
  const Numbered all{promises};
  Union together{all.voxels};
  for (const Parts& parts : all.promises) together.add(parts);
  return together.worth();
}

}  // namespace saccade

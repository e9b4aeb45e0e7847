// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/internal/mode_sharpening.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "saccade/surfel/internal/mode_choice.hpp"

namespace saccade {
namespace {

constexpr std::size_t kSampled{48};      ///< neighbours to sample, approximately
constexpr float kMostOneSided{0.25F};    ///< share of the reach: where the neighbours' mean is farther off, λ is 0
constexpr std::size_t kCellsPerTask{8};  ///< cells of the grid

/// Returns 1 at 0, approximately a Gaussian, and 0 beyond 2.8 σ. `half_inverse`: 1 / 2σ².
float likeness(float squared, float half_inverse) {
  const float left = std::max(0.0F, 1.0F - 0.25F * squared * half_inverse);
  return left * left * left * left;
}

float half_inverse(double sigma) { return static_cast<float>(1.0 / (2.0 * sigma * sigma)); }

/// Colour and its share of a surfel's weight.
struct ColorShare {
  Eigen::Vector3f color;
  float share;
};

float share_like(std::span<const ColorShare> shares, const Eigen::Vector3f& color, float half_inverse_color) {
  float sum{0.0F};
  for (const ColorShare& mode : shares) {
    sum += mode.share * likeness((mode.color - color).squaredNorm(), half_inverse_color);
  }
  return sum;
}

/// Surfels with modes, in cubes whose sides are the reach.
class SurfelGrid {
 public:
  SurfelGrid(const ModeStore& store, double side_m, const Executor& executor) : positions_m_(store.size()) {
    constexpr std::size_t kSurfelsAtOnce{8192};
    std::vector<std::pair<std::uint64_t, SurfelId>> all(store.size());
    executor.parallel_for(store.size(), kSurfelsAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const auto id = static_cast<SurfelId>(k);
        float weight{0.0F};
        Eigen::Vector3f sum{Eigen::Vector3f::Zero()};
        for (std::size_t i = 0; i < store.count(id); ++i) {
          const SurfelMode mode = store.mode(id, i);
          sum += mode.weight * mode.position_m;
          weight += mode.weight;
        }
        if (weight > 0.0F) positions_m_[k] = sum / weight;
        all[k] = {weight > 0.0F ? key((positions_m_[k] / static_cast<float>(side_m)).array().floor()) : kNowhere, id};
      }
    });
    std::sort(all.begin(), all.end());
    for (const auto& [cell, id] : all) {
      if (cell == kNowhere) break;
      if (keys_.empty() || keys_.back() != cell) {
        keys_.push_back(cell);
        begins_.push_back(ids_.size());
      }
      ids_.push_back(id);
    }
    begins_.push_back(ids_.size());
  }

  [[nodiscard]] std::size_t cells() const { return keys_.size(); }
  [[nodiscard]] const Eigen::Vector3f& position_m(SurfelId id) const { return positions_m_[id]; }
  /// Returns the surfels of a cell in ascending order.
  [[nodiscard]] std::span<const SurfelId> surfels(std::size_t cell) const {
    return {ids_.data() + begins_[cell], begins_[cell + 1] - begins_[cell]};
  }
  /// Calls visit with the surfels of a cell and of the cells around it.
  template <class Visit>
  void visit_around(std::size_t cell, const Visit& visit) const {
    for (std::uint64_t dx = 0; dx < 3; ++dx) {
      for (std::uint64_t dy = 0; dy < 3; ++dy) {
        for (std::uint64_t dz = 0; dz < 3; ++dz) {
          const std::uint64_t wanted = keys_[cell] - kAround + (dx << 2 * kBits) + (dy << kBits) + dz;
          const auto found = std::lower_bound(keys_.begin(), keys_.end(), wanted);
          if (found != keys_.end() && *found == wanted) visit(surfels(static_cast<std::size_t>(found - keys_.begin())));
        }
      }
    }
  }

 private:
  static constexpr int kBits{21};
  static constexpr std::uint64_t kAround{(std::uint64_t{1} << 2 * kBits) + (std::uint64_t{1} << kBits) + 1};
  static constexpr std::uint64_t kNowhere{~std::uint64_t{0}};

  static std::uint64_t key(const Eigen::Array3f& cell) {
    const auto part = [](float x) {
      constexpr float kMost{(1 << (kBits - 1)) - 2};  // cells; 20 km of 2 cm
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::clamp(x, -kMost, kMost)) + (1 << (kBits - 1)));
    };
    return part(cell.x()) << 2 * kBits | part(cell.y()) << kBits | part(cell.z());
  }

  std::vector<Eigen::Vector3f> positions_m_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::size_t> begins_;
  std::vector<SurfelId> ids_;
};

/// Surfels in a cell and around it, contiguous in memory.
class Neighbours {
 public:
  void gather(const ModeStore& store, const SurfelGrid& grid, std::size_t cell) {
    positions_m_.clear();
    begins_.assign(1, 0);
    shares_.clear();
    grid.visit_around(cell, [&](std::span<const SurfelId> ids) {
      for (const SurfelId id : ids) {
        positions_m_.push_back(grid.position_m(id));
        float weight{0.0F};
        for (std::size_t i = 0; i < store.count(id); ++i) {
          const SurfelMode mode = store.mode(id, i);
          shares_.push_back({mode.color, mode.weight});
          weight += mode.weight;
        }
        for (std::size_t i = begins_.back(); i < shares_.size(); ++i) shares_[i].share /= weight;
        begins_.push_back(shares_.size());
      }
    });
  }

  [[nodiscard]] std::size_t size() const { return positions_m_.size(); }
  [[nodiscard]] const Eigen::Vector3f& position_m(std::size_t n) const { return positions_m_[n]; }
  [[nodiscard]] std::span<const ColorShare> shares(std::size_t n) const {
    return {shares_.data() + begins_[n], begins_[n + 1] - begins_[n]};
  }

 private:
  std::vector<Eigen::Vector3f> positions_m_;
  std::vector<std::size_t> begins_;
  std::vector<ColorShare> shares_;
};

/// Choice among the modes of one surfel after the other.
class Sharpening {
 public:
  Sharpening(const ModeSharpeningConfig& config, double bandwidth, const Neighbours& neighbours)
      : config_{config},
        bandwidth_{bandwidth},
        neighbours_{neighbours},
        half_inverse_color_{half_inverse(config.color_sigma)},
        half_inverse_near_{half_inverse(config.reach_m / 12.0)},
        half_inverse_around_{half_inverse(config.reach_m / 2.0)} {}

  [[nodiscard]] SurfelMode choose(SurfelId id, const Eigen::Vector3f& position_m, std::span<const SurfelMode> modes) {
    find_groups(modes);
    if (groups_.size() < 2) return densest_mode(modes, bandwidth_);
    weigh_groups(id, position_m);
    const auto best = std::max_element(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) {
      return a.score < b.score;  // at a tie the first, which is denser
    });
    return densest_mode_like(modes, bandwidth_, best->color, config_.color_sigma);
  }

 private:
  /// Modes that look like the densest among them.
  struct Group {
    Eigen::Vector3f color;
    float density{0.0F};
    float near{0.0F};
    float around{0.0F};
    float score{0.0F};
  };

  /// Finds the densest mode, then the densest of those that do not look like it, and so on.
  void find_groups(std::span<const SurfelMode> modes) {
    all_.clear();
    for (const SurfelMode& mode : modes) {
      Group& group = all_.emplace_back();
      group.color = mode.color;
      for (const SurfelMode& other : modes) {
        group.density += other.weight * likeness((other.color - mode.color).squaredNorm(), half_inverse_color_);
      }
    }
    std::stable_sort(all_.begin(), all_.end(), [](const Group& a, const Group& b) { return a.density > b.density; });
    groups_.clear();
    const auto squared = static_cast<float>(config_.color_sigma * config_.color_sigma);
    for (const Group& group : all_) {
      const bool is_new = std::all_of(groups_.begin(), groups_.end(), [&](const Group& denser) {
        return (denser.color - group.color).squaredNorm() > squared;
      });
      if (is_new) groups_.push_back(group);
    }
  }

  void weigh_groups(SurfelId id, const Eigen::Vector3f& position_m) {
    const auto squared_reach = static_cast<float>(config_.reach_m * config_.reach_m);
    within_.clear();
    for (std::size_t n = 0; n < neighbours_.size(); ++n) {
      const float squared = (neighbours_.position_m(n) - position_m).squaredNorm();
      if (squared <= squared_reach) within_.push_back({n, squared});
    }
    const std::size_t stride = std::max<std::size_t>(1, within_.size() / kSampled);
    float sum_near{0.0F};
    float sum_around{0.0F};
    Eigen::Vector3f offset_m{Eigen::Vector3f::Zero()};
    for (std::size_t k = 0; k < within_.size(); ++k) {
      const auto& [n, squared] = within_[k];
      const float near = likeness(squared, half_inverse_near_);
      const float around = k % stride == id % stride ? likeness(squared, half_inverse_around_) : 0.0F;
      if (near == 0.0F && around == 0.0F) continue;
      sum_near += near;
      sum_around += around;
      offset_m += around * (neighbours_.position_m(n) - position_m);
      for (Group& group : groups_) {
        const float share = share_like(neighbours_.shares(n), group.color, half_inverse_color_);
        group.near += near * share;
        group.around += around * share;
      }
    }
    const float one_sided =
        sum_around > 0.0F ? offset_m.norm() / (sum_around * kMostOneSided * static_cast<float>(config_.reach_m)) : 1.0F;
    const float strength = static_cast<float>(config_.strength) * std::max(0.0F, 1.0F - one_sided * one_sided);
    for (Group& group : groups_) {
      const float near = group.near / sum_near;  // the surfel itself is one of them
      const float around = sum_around > 0.0F ? group.around / sum_around : near;
      group.score = near + strength * (near - around);
    }
  }

  const ModeSharpeningConfig& config_;
  double bandwidth_;
  const Neighbours& neighbours_;
  float half_inverse_color_, half_inverse_near_, half_inverse_around_;
  std::vector<Group> all_, groups_;
  std::vector<std::pair<std::size_t, float>> within_;
};

}  // namespace

Status ModeSharpeningConfig::validate() const {
  if (!(strength >= 0.0 && std::isfinite(strength))) {
    return Error{Errc::invalid_argument, "sharpening: the strength must be 0 or more", {}};
  }
  if (!(reach_m > 0.0 && std::isfinite(reach_m))) {
    return Error{Errc::invalid_argument, "sharpening: the reach must be positive", {}};
  }
  if (!(color_sigma > 0.0 && std::isfinite(color_sigma))) {
    return Error{Errc::invalid_argument, "sharpening: colours that count as one need a positive σ", {}};
  }
  return {};
}

std::vector<SurfelMode> sharpened_modes(const ModeStore& store, const ModeSharpeningConfig& config, double bandwidth,
                                        const Executor& executor) {
  SACCADE_EXPECTS(config.validate().ok());
  const SurfelGrid grid{store, config.reach_m, executor};
  std::vector<SurfelMode> chosen(store.size());
  executor.parallel_for(grid.cells(), kCellsPerTask, [&](std::size_t begin, std::size_t end) {
    Neighbours neighbours;
    Sharpening sharpening{config, bandwidth, neighbours};
    std::vector<SurfelMode> modes;
    for (std::size_t cell = begin; cell < end; ++cell) {
      neighbours.gather(store, grid, cell);
      for (const SurfelId id : grid.surfels(cell)) {
        modes.clear();
        for (std::size_t i = 0; i < store.count(id); ++i) modes.push_back(store.mode(id, i));
        chosen[id] = sharpening.choose(id, grid.position_m(id), modes);
      }
    }
  });
  return chosen;
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelMode: what a surfel may look like, and where; ModeStore: the modes of all surfels in little memory.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "saccade/sensor/image.hpp"
#include "saccade/surfel/mode_search.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// A tuple m_i of eq. 4.3.
struct SurfelMode {
  Eigen::Vector3f color{Eigen::Vector3f::Zero()};  ///< red, green, blue in [0, 1]
  Eigen::Vector3f position_m{Eigen::Vector3f::Zero()};
  float weight{0.0F};
};

inline ColorUnits color_units(const Rgb8& color) {
  return {color[0] * ColorUnits::kPerLevel, color[1] * ColorUnits::kPerLevel, color[2] * ColorUnits::kPerLevel};
}

/// In [0, 1].
inline Eigen::Vector3f unit_color(const ColorUnits& units) {
  constexpr float kUnit{1.0F / (255.0F * ColorUnits::kPerLevel)};
  return {static_cast<float>(units.r) * kUnit, static_cast<float>(units.g) * kUnit,
          static_cast<float>(units.b) * kUnit};
}

/// One surfel's modes in the memory of a ModeStore, in the order in which they came.
struct StoredModes {
  std::uint64_t* colors;  ///< ColorUnits::packed()
  float* weights;
  float* positions_m;  ///< x, y, z
  std::uint8_t* count_here;

  [[nodiscard]] std::size_t count() const { return *count_here; }
  [[nodiscard]] Eigen::Vector3f position_m(std::size_t i) const {
    return {positions_m[3 * i], positions_m[3 * i + 1], positions_m[3 * i + 2]};
  }
  void set_position(std::size_t i, const Eigen::Vector3f& p_m) const {
    for (std::size_t k = 0; k < 3; ++k) positions_m[3 * i + k] = p_m[static_cast<Eigen::Index>(k)];
  }
  [[nodiscard]] SurfelMode mode(std::size_t i) const {
    return {unit_color(ColorUnits::unpacked(colors[i])), position_m(i), weights[i]};
  }
  /// Needs room.
  void add(const ColorUnits& color, const Eigen::Vector3f& p_m, float weight) const {
    const std::size_t i = (*count_here)++;
    colors[i] = color.packed();
    weights[i] = weight;
    set_position(i, p_m);
  }
  void remove(std::size_t i) const {
    const std::size_t end = count();
    std::copy(colors + i + 1, colors + end, colors + i);
    std::copy(weights + i + 1, weights + end, weights + i);
    std::copy(positions_m + 3 * i + 3, positions_m + 3 * end, positions_m + 3 * i);
    --*count_here;
  }
};

/// Modes by surfel. Room for all of a surfel's modes, 24 bytes each, is there from the beginning: with real colours
/// most surfels soon have many. Different surfels may be changed by different threads.
class ModeStore {
 public:
  explicit ModeStore(std::size_t max_modes)
      : max_modes_{max_modes}, stride_{std::max<std::size_t>(max_modes, 4) * kBytesPerMode} {}

  [[nodiscard]] std::size_t size() const { return counts_.size(); }
  [[nodiscard]] std::size_t memory_bytes() const;
  /// New surfels have no modes.
  void resize(std::size_t surfels);
  [[nodiscard]] std::size_t count(SurfelId id) const { return counts_[id]; }
  [[nodiscard]] StoredModes modes(SurfelId id) {
    std::byte* const colors = room(id);  // plain memory, of which each part is always of one type
    std::byte* const weights = colors + max_modes_ * sizeof(std::uint64_t);
    std::byte* const positions = weights + max_modes_ * sizeof(float);
    return {reinterpret_cast<std::uint64_t*>(colors), reinterpret_cast<float*>(weights),
            reinterpret_cast<float*>(positions), &counts_[id]};
  }
  [[nodiscard]] SurfelMode mode(SurfelId id, std::size_t i) const;
  // Inlined at once: g++ takes a function that only prefetches for one without effect, and leaves its calls out.
  /// Asks memory for how many modes there are, and their colours.
  [[gnu::always_inline]] void fetch_colors(SurfelId id) const {
    const std::byte* const first = room(id);
    __builtin_prefetch(&counts_[id], 1);
    for (std::size_t i = 0; i < max_modes_ * sizeof(std::uint64_t); i += kLine) __builtin_prefetch(first + i, 1);
  }
  /// Asks memory for the weight and position of one.
  [[gnu::always_inline]] void fetch_place(SurfelId id, std::size_t i) const {
    const std::byte* const weights = room(id) + max_modes_ * sizeof(std::uint64_t);
    const std::byte* const position = weights + (max_modes_ + 3 * i) * sizeof(float);
    __builtin_prefetch(weights + i * sizeof(float), 1);
    __builtin_prefetch(position, 1);
    __builtin_prefetch(position + 2 * sizeof(float), 1);
  }

 private:
  static constexpr std::size_t kPerChunk{512};  ///< more would be much for a map of few surfels
  static constexpr std::size_t kBytesPerMode{sizeof(std::uint64_t) + 4 * sizeof(float)};
  static constexpr std::size_t kLine{64};
  [[nodiscard]] std::byte* room(SurfelId id) const { return chunks_[id / kPerChunk].get() + id % kPerChunk * stride_; }

  std::size_t max_modes_;
  std::size_t stride_;  ///< bytes; searches look at up to seven modes more than there are: so far they stay among them
  std::vector<std::uint8_t> counts_;
  std::vector<std::unique_ptr<std::byte[]>> chunks_;
};

}  // namespace saccade

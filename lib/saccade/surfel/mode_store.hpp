// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelMode: a possible colour and position of a surfel. ModeStore: compact storage of the modes of all surfels.

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

/// Tuple m_i of eq. 4.3.
struct SurfelMode {
  Eigen::Vector3f color{Eigen::Vector3f::Zero()};  ///< red, green, blue in [0, 1]
  Eigen::Vector3f position_m{Eigen::Vector3f::Zero()};
  float weight{0.0F};
};

inline ColorUnits color_units(const Rgb8& color) {
  return {color[0] * ColorUnits::kPerLevel, color[1] * ColorUnits::kPerLevel, color[2] * ColorUnits::kPerLevel};
}

/// Returns the colour in [0, 1].
inline Eigen::Vector3f unit_color(const ColorUnits& units) {
  constexpr float kUnit{1.0F / (255.0F * ColorUnits::kPerLevel)};
  return {static_cast<float>(units.r) * kUnit, static_cast<float>(units.g) * kUnit,
          static_cast<float>(units.b) * kUnit};
}

/// Mode without its colour, so that a merge touches a single cache line.
struct ModePlace {
  float x_m, y_m, z_m;
  float weight;
};

/// Modes of one surfel in the memory of a ModeStore, in the order of their creation.
struct StoredModes {
  std::uint64_t* colors;  ///< ColorUnits::packed()
  ModePlace* places;
  std::uint8_t* count_here;

  [[nodiscard]] std::size_t count() const { return *count_here; }
  [[nodiscard]] float& weight(std::size_t i) const { return places[i].weight; }
  [[nodiscard]] Eigen::Vector3f position_m(std::size_t i) const {
    return {places[i].x_m, places[i].y_m, places[i].z_m};
  }
  void set_position(std::size_t i, const Eigen::Vector3f& p_m) const {
    places[i] = {p_m.x(), p_m.y(), p_m.z(), places[i].weight};
  }
  [[nodiscard]] SurfelMode mode(std::size_t i) const {
    return {unit_color(ColorUnits::unpacked(colors[i])), position_m(i), weight(i)};
  }
  /// Adds a mode. Requires free space.
  void add(const ColorUnits& color, const Eigen::Vector3f& p_m, float weight) const {
    const std::size_t i = (*count_here)++;
    colors[i] = color.packed();
    places[i] = {p_m.x(), p_m.y(), p_m.z(), weight};
  }
  void remove(std::size_t i) const {
    const std::size_t end = count();
    std::copy(colors + i + 1, colors + end, colors + i);
    std::copy(places + i + 1, places + end, places + i);
    --*count_here;
  }
};

/// Modes by surfel. Space for all modes of a surfel, 24 bytes each, is reserved from the beginning: with real colours
/// most surfels soon have many. Different threads may change different surfels.
class ModeStore {
 public:
  explicit ModeStore(std::size_t max_modes)
      : max_modes_{max_modes}, stride_{std::max<std::size_t>(max_modes, 4) * kBytesPerMode} {}

  [[nodiscard]] std::size_t size() const { return counts_.size(); }
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Changes the number of surfels; new ones have no modes.
  void resize(std::size_t surfels);
  [[nodiscard]] std::size_t count(SurfelId id) const { return counts_[id]; }
  [[nodiscard]] StoredModes modes(SurfelId id) {
    std::byte* const colors = room(id);  // raw memory, each part of which always has one type
    std::byte* const places = colors + max_modes_ * sizeof(std::uint64_t);
    return {reinterpret_cast<std::uint64_t*>(colors), reinterpret_cast<ModePlace*>(places), &counts_[id]};
  }
  [[nodiscard]] SurfelMode mode(SurfelId id, std::size_t i) const;
  // Inlined immediately: g++ treats a function that only prefetches as free of effects, and drops calls to it.
  /// Prefetches the number of modes.
  [[gnu::always_inline]] void fetch_count(SurfelId id) const { __builtin_prefetch(&counts_[id], 1); }
  /// Prefetches their colours.
  [[gnu::always_inline]] void fetch_colors(SurfelId id) const {
    const std::byte* const first = room(id);
    for (std::size_t i = 0; i < max_modes_ * sizeof(std::uint64_t); i += kLine) __builtin_prefetch(first + i, 1);
  }
  /// Prefetches the weight and position of one mode.
  [[gnu::always_inline]] void fetch_place(SurfelId id, std::size_t i) const {
    __builtin_prefetch(room(id) + max_modes_ * sizeof(std::uint64_t) + i * sizeof(ModePlace), 1);
  }
  /// Prefetches the weights and positions of all modes.
  [[gnu::always_inline]] void fetch_places(SurfelId id) const {
    const std::byte* const first = room(id) + max_modes_ * sizeof(std::uint64_t);
    for (std::size_t i = 0; i < max_modes_ * sizeof(ModePlace); i += kLine) __builtin_prefetch(first + i, 1);
  }

 private:
  static constexpr std::size_t kPerChunk{512};  ///< larger chunks would waste memory on small maps
  static constexpr std::size_t kBytesPerMode{sizeof(std::uint64_t) + sizeof(ModePlace)};
  static constexpr std::size_t kLine{64};
  [[nodiscard]] std::byte* room(SurfelId id) const { return chunks_[id / kPerChunk].get() + id % kPerChunk * stride_; }

  std::size_t max_modes_;
  std::size_t stride_;  ///< bytes; space for at least eight colours, as searches require
  std::vector<std::uint8_t> counts_;
  std::vector<std::unique_ptr<std::byte[]>> chunks_;
};

}  // namespace saccade

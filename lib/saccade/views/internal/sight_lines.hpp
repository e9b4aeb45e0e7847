// SPDX-License-Identifier: Apache-2.0
#pragma once
// SightLines: several SightLines at a time.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "saccade/views/internal/sight_line.hpp"

namespace saccade {

/// SightLines, one per lane, that end as SightLine::walk does, to the bit.
struct SightLines {
  static constexpr std::size_t kMost{8};
  template <class T>
  using Lanes = std::array<T, kMost>;

  // As in SightLine.
  alignas(64) Lanes<std::int64_t> place{};
  alignas(64) Lanes<double> share{};
  alignas(64) Lanes<double> end{};
  alignas(64) Lanes<double> past_region{};
  alignas(64) std::array<Lanes<double>, 3> next{};
  alignas(64) std::array<Lanes<double>, 3> between{};
  alignas(64) std::array<Lanes<std::int64_t>, 3> move{};
  alignas(64) std::array<Lanes<std::int64_t>, 3> left{};
  alignas(64) Lanes<std::int64_t> met_place{};
  alignas(64) Lanes<double> met_share{};
  // One bit per lane.
  std::uint32_t walking{0};
  std::uint32_t met{0};      ///< lines that have met a voxel
  std::uint32_t returns{0};  ///< lines that met a surface behind it

  /// Puts a line into a lane where none walks.
  void put(std::size_t lane, const SightLine& line);
  /// Returns what a line has met that has ended.
  [[nodiscard]] std::optional<MetVoxel> result(std::size_t lane) const;
  /// Walks until at most `at_most` lines walk; the others have ended. Expects lines in lanes below lanes(). O(voxels
  /// along the lines).
  void walk(const SightClasses& classes, std::size_t at_most);
  /// Returns how many lines this machine walks at a time, kMost or fewer.
  [[nodiscard]] static std::size_t lanes();
};

}  // namespace saccade

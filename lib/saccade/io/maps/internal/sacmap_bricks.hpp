// SPDX-License-Identifier: Apache-2.0
#pragma once
// The bricks of one sector of a .sacmap file, before compression: append_bricks, read_bricks, fault_of.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/map/tsdf_grid.hpp"

namespace saccade::sacmap {

/// Per brick: child index u16, kind u8, info u8, CRC-32 u32 of those four bytes and the payload, payload.
constexpr std::size_t kBrickHeaderBytes{8};
constexpr std::size_t kFreeBytes{3 * kBrickVoxels / 8};
constexpr std::size_t kDenseBytes{4 * kBrickVoxels};
constexpr std::size_t kColorBytes{3 * kBrickVoxels};
constexpr std::size_t kMaxSectorBytes{kSectorBricks * (kBrickHeaderBytes + kDenseBytes + kColorBytes)};

/// Returns why no map of this configuration can hold the brick, or nullptr.
[[nodiscard]] const char* fault_of(const BrickRef& brick, const TsdfConfig& config);

/// Appends all known bricks of the sector, in order of their index.
void append_bricks(const Sector& sector, std::vector<std::byte>& out);

/// Fills an all-unknown sector and its summaries; returns the number of bricks. Answers corrupt_data naming the brick.
[[nodiscard]] Result<std::size_t> read_bricks(std::span<const std::byte> bytes, const TsdfConfig& config,
                                              Sector& sector);

}  // namespace saccade::sacmap

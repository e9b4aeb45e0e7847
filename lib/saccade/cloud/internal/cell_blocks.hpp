// SPDX-License-Identifier: Apache-2.0
#pragma once
// CellBlocks: cells of a regular grid, numbered in the order of insertion, with fast access to neighbours.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/cloud/cell_index.hpp"

namespace saccade {

/// Hash table of blocks of 8³ cells, which finds neighbouring cells without hashing. One thread inserts; all other
/// methods are const.
class CellBlocks {
 public:
  static constexpr std::size_t kAround{26};  ///< neighbours of a cell

  CellBlocks() : slots_(std::size_t{1} << kFirstBits, kUnlabelled) {}

  [[nodiscard]] std::size_t size() const { return places_.size(); }

  /// Returns the number of the cell, inserting it with the next number if it is new.
  std::uint32_t insert(std::uint64_t cell) {
    const std::uint64_t key = cell & ~kWithin;
    if (last_ == kUnlabelled || keys_[last_] != key) last_ = insert_block(key);
    std::uint32_t& number = blocks_[last_][within(cell)];
    if (number == kUnlabelled) {
      number = static_cast<std::uint32_t>(places_.size());
      places_.push_back({last_, static_cast<std::uint32_t>(within(cell))});
    }
    return number;
  }

  /// Writes the numbers of a cell's neighbours (up to kAround), z slowest. @return one past the last number written.
  std::uint32_t* around(std::uint32_t number, std::uint32_t* to) const {
    const Place& place = places_[number];
    const int x = static_cast<int>(place.within & 7U);
    const int y = static_cast<int>((place.within >> 3) & 7U);
    const int z = static_cast<int>(place.within >> 6);
    const auto inside = [](int i) { return i > 0 && i < 7; };
    if (inside(x) && inside(y) && inside(z)) {
      const std::uint32_t* at = &blocks_[place.block][place.within];
      for (const int dz : {-64, 0, 64}) {
        for (const int dy : {-8, 0, 8}) {
          for (const int dx : {-1, 0, 1}) {
            *to = at[dz + dy + dx];
            to += *to != kUnlabelled && *to != number ? 1 : 0;
          }
        }
      }
      return to;
    }
    Nearby nearby{*this, keys_[place.block]};
    for (int k = z - 1; k <= z + 1; ++k) {
      for (int j = y - 1; j <= y + 1; ++j) {
        for (int i = x - 1; i <= x + 1; ++i) {
          const Block* block = nearby.block(i >> 3, j >> 3, k >> 3);
          if (block == nullptr) continue;
          *to = (*block)[static_cast<std::size_t>(((k & 7) << 6) | ((j & 7) << 3) | (i & 7))];
          to += *to != kUnlabelled && *to != number ? 1 : 0;
        }
      }
    }
    return to;
  }

 private:
  static constexpr int kFirstBits{10};
  static constexpr std::uint64_t kX{std::uint64_t{1} << (2 * kCellBits)};
  static constexpr std::uint64_t kY{std::uint64_t{1} << kCellBits};
  static constexpr std::uint64_t kWithin{7 * (kX + kY + 1)};
  using Block = std::array<std::uint32_t, 512>;  ///< numbers of cells
  struct Place {
    std::uint32_t block;
    std::uint32_t within;
  };

  /// Neighbouring blocks, looked up on first use.
  class Nearby {
   public:
    Nearby(const CellBlocks& index, std::uint64_t key) : index_{index}, key_{key} {}
    const Block* block(int dx, int dy, int dz) {
      const auto at = static_cast<std::size_t>((dz + 1) * 9 + (dy + 1) * 3 + dx + 1);
      if (!asked_[at]) {
        asked_[at] = true;
        const auto step = [](int d) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(8 * d)); };
        const std::uint32_t slot = index_.slots_[index_.slot_of(key_ + step(dx) * kX + step(dy) * kY + step(dz))];
        found_[at] = slot == kUnlabelled ? nullptr : &index_.blocks_[slot];
      }
      return found_[at];
    }

   private:
    const CellBlocks& index_;
    std::uint64_t key_;
    std::array<bool, 27> asked_{};
    std::array<const Block*, 27> found_{};
  };

  [[nodiscard]] static std::size_t within(std::uint64_t cell) {
    return static_cast<std::size_t>(((cell & 7) << 6) | (((cell >> kCellBits) & 7) << 3) |
                                    ((cell >> (2 * kCellBits)) & 7));
  }
  /// Returns the slot of the block, or the free slot where it would be inserted.
  [[nodiscard]] std::size_t slot_of(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ULL) >> (64 - bits_));
    while (slots_[slot] != kUnlabelled && keys_[slots_[slot]] != key) slot = (slot + 1) & mask;
    return slot;
  }
  std::uint32_t insert_block(std::uint64_t key) {
    std::uint32_t& slot = slots_[slot_of(key)];
    if (slot != kUnlabelled) return slot;
    const auto number = static_cast<std::uint32_t>(keys_.size());
    slot = number;
    keys_.push_back(key);
    blocks_.emplace_back().fill(kUnlabelled);
    if (2 * keys_.size() > slots_.size()) {
      ++bits_;
      slots_.assign(std::size_t{1} << bits_, kUnlabelled);
      for (std::size_t i = 0; i < keys_.size(); ++i) slots_[slot_of(keys_[i])] = static_cast<std::uint32_t>(i);
    }
    return number;
  }

  int bits_{kFirstBits};
  std::vector<std::uint32_t> slots_;  ///< block numbers
  std::vector<std::uint64_t> keys_;   ///< block keys
  std::vector<Block> blocks_;
  std::vector<Place> places_;  ///< where each cell lies
  std::uint32_t last_{kUnlabelled};
};

}  // namespace saccade

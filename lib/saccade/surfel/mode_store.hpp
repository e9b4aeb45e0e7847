// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelMode: what a surfel may look like, and where; ModeStore: the modes of all surfels in little memory.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// A tuple m_i of eq. 4.3.
struct SurfelMode {
  Eigen::Vector3f color;
  Eigen::Vector3f position_m;
  float weight{0.0F};
};

inline constexpr std::size_t kMostModes{32};

/// Modes of one surfel, in the order in which they came.
struct SurfelModes {
  std::array<SurfelMode, kMostModes> modes;
  std::size_t count{0};

  [[nodiscard]] std::span<const SurfelMode> span() const { return {modes.data(), count}; }
  void add(const SurfelMode& mode) { modes[count++] = mode; }
  void remove(std::size_t i);
  /// argmin_i ‖c_i − c‖, the first of those that are equal; needs one mode.
  [[nodiscard]] std::size_t nearest(const Eigen::Vector3f& color) const;
};

/// Modes by surfel: the first in an array, the others in chains of blocks of three. A surfel has 36 bytes, a block 88.
class ModeStore {
 public:
  [[nodiscard]] std::size_t size() const { return firsts_.size(); }
  [[nodiscard]] std::size_t blocks_in_use() const { return blocks_.size() - free_blocks_; }
  [[nodiscard]] std::size_t memory_bytes() const;
  [[nodiscard]] std::size_t count(SurfelId id) const { return heads_[id].count; }
  /// New surfels have no modes.
  void resize(std::size_t surfels);
  void load(SurfelId id, SurfelModes& modes) const;
  /// False, with nothing changed, unless the modes need as many blocks as the surfel has: then store_and_fit takes
  /// them. Different surfels may be stored by different threads.
  [[nodiscard]] bool store(SurfelId id, const SurfelModes& modes);
  /// As store, and fits. One thread.
  void store_and_fit(SurfelId id, const SurfelModes& modes);

 private:
  static constexpr std::size_t kPerBlock{3};
  static constexpr std::uint32_t kNoBlock{std::numeric_limits<std::uint32_t>::max()};
  struct Head {
    std::uint32_t block{kNoBlock};
    std::uint16_t count{0};
    std::uint16_t blocks{0};
  };
  struct Block {
    std::array<SurfelMode, kPerBlock> modes;
    std::uint32_t next{kNoBlock};
  };
  static std::size_t blocks_for(std::size_t count) { return count <= 1 ? 0 : (count - 1 + kPerBlock - 1) / kPerBlock; }

  std::vector<SurfelMode> firsts_;
  std::vector<Head> heads_;
  std::vector<Block> blocks_;
  std::uint32_t free_{kNoBlock};
  std::size_t free_blocks_{0};
};

}  // namespace saccade

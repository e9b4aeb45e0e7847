// SPDX-License-Identifier: Apache-2.0
#pragma once
// PagedBricks: a map of which the device holds all bricks, or those of a box where its memory does not suffice.

#include <functional>
#include <limits>
#include <optional>

#include "saccade/cuda/internal/brick_store.hpp"

namespace saccade::internal::cuda {

/// The bricks on the device, and the host's copy of the map, which lacks what kernels changed since the last pull.
/// After an error of pull() other than is_no_room the device is lost, with what it had changed.
class PagedBricks {
 public:
  /// @param free_scratch  gives back all other memory of the device that is not in use.
  PagedBricks(Compute& compute, const TsdfConfig& config, std::function<void()> free_scratch = {})
      : compute_{compute}, free_scratch_{std::move(free_scratch)}, host_{config, {}} {
    store_.emplace(compute);
  }

  [[nodiscard]] BrickStore& store() { return *store_; }
  [[nodiscard]] const TsdfConfig& config() const { return host_.config; }
  [[nodiscard]] bool is_paged() const { return paged_; }
  /// Tells whether the bricks of this box, and no others, are all that the device holds.
  [[nodiscard]] bool is_paged_to(const IndexBox& bricks) const { return paged_ && page_ == bricks; }

  /// Replaces the content, and sends the bricks that differ; none where the device is short of memory. A paged map that
  /// is smaller than what did not fit is sent whole again.
  [[nodiscard]] Status assign(const TsdfSnapshot& map, const Executor& executor);
  /// Brings the host's copy up to date and returns it.
  [[nodiscard]] Result<TsdfSnapshot> pull();
  /// Makes the bricks of a box be on the device, where it does not hold all. Two boxes that take turns are brought
  /// there together, if there is room for both.
  [[nodiscard]] Status bring_in(const IndexBox& bricks);
  /// Takes note that what is on the device leaves too little room for work: that much is not tried again.
  [[nodiscard]] Status note_too_much();
  /// Leaves nothing but the bricks of a box on the device from now on. Frees its memory first.
  [[nodiscard]] Status page_to(const IndexBox& bricks);
  /// Takes the device for lost: every call answers unavailable.
  void lose() { lost_ = true; }
  [[nodiscard]] bool is_lost() const { return lost_ || compute_.is_lost(); }
  [[nodiscard]] Status check() const;

 private:
  /// Size of a part of a map: what its bricks take of the device.
  struct Load {
    std::size_t bricks{std::numeric_limits<std::size_t>::max()};
    double table{std::numeric_limits<double>::infinity()};  ///< bricks of the box around it
    [[nodiscard]] bool is_below(const Load& other) const {
      return bricks <= other.bricks && table <= other.table && (bricks < other.bricks || table < other.table);
    }
  };
  [[nodiscard]] static Load load_of(std::span<const SectorBricks> known);

  /// Forgets all that is on the device.
  void clear();
  /// Puts these bricks onto an empty device; once more without other work's buffers, where memory is short. On an error
  /// the device is empty.
  [[nodiscard]] Status send(const TsdfGrid& map, std::span<const SectorBricks> known);

  Compute& compute_;
  std::function<void()> free_scratch_;
  TsdfSnapshot host_;
  std::optional<BrickStore> store_;
  bool paged_{false};
  bool lost_{false};
  IndexBox page_{};     ///< bricks on the device, where it is paged
  IndexBox evicted_{};  ///< those that were there before
  Load too_much_{};     ///< smallest part of the map that did not fit, or left no room for work
};

}  // namespace saccade::internal::cuda

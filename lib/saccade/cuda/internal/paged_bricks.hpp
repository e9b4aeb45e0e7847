// SPDX-License-Identifier: Apache-2.0
#pragma once
// PagedBricks: a map of which the device holds all bricks, or those of a box where its memory does not suffice.

#include <optional>

#include "saccade/cuda/internal/brick_store.hpp"

namespace saccade::internal::cuda {

/// The bricks on the device, and the host's copy of the map, which lacks what kernels changed since the last pull.
/// After an error of pull() other than is_no_room the device is lost, with what it had changed.
class PagedBricks {
 public:
  PagedBricks(Compute& compute, const TsdfConfig& config) : compute_{compute}, host_{config, {}} {
    store_.emplace(compute);
  }

  [[nodiscard]] BrickStore& store() { return *store_; }
  [[nodiscard]] const TsdfConfig& config() const { return host_.config; }
  [[nodiscard]] bool is_paged() const { return paged_; }

  /// Replaces the content, and sends the bricks that differ; none where the device is short of memory.
  [[nodiscard]] Status assign(const TsdfSnapshot& map, const Executor& executor);
  /// Brings the host's copy up to date and returns it.
  [[nodiscard]] Result<TsdfSnapshot> pull();
  /// Makes the bricks of a box be on the device, where it does not hold all.
  [[nodiscard]] Status bring_in(const IndexBox& bricks);
  /// Leaves nothing but the bricks of a box on the device from now on. Frees its memory first.
  [[nodiscard]] Status page_to(const IndexBox& bricks);
  /// Takes the device for lost: every call answers unavailable.
  void lose() { lost_ = true; }
  [[nodiscard]] bool is_lost() const { return lost_ || compute_.is_lost(); }
  [[nodiscard]] Status check() const;

 private:
  /// Forgets all that is on the device.
  void clear();

  Compute& compute_;
  TsdfSnapshot host_;
  std::optional<BrickStore> store_;
  bool paged_{false};
  bool lost_{false};
  IndexBox page_{};  ///< bricks on the device, where it is paged
};

}  // namespace saccade::internal::cuda

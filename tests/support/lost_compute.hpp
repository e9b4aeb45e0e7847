// SPDX-License-Identifier: Apache-2.0
#pragma once
// LostCompute: a device that fails in the middle of its work.

#include "support/checked_compute.hpp"

namespace saccade::test {

/// Emulated device that is lost after some operations.
class LostCompute final : public CheckedCompute {
 public:
  explicit LostCompute(int operations, std::size_t memory_bytes = ~std::size_t{0})
      : CheckedCompute{memory_bytes}, left_{operations} {}

 private:
  [[nodiscard]] Status check() override {
    if (left_ == 0) return Error{Errc::unavailable, "the device is lost", "cuda"};
    --left_;
    return {};
  }
  int left_;
};

}  // namespace saccade::test

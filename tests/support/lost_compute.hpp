// SPDX-License-Identifier: Apache-2.0
#pragma once
// LostCompute: a device that fails in the middle of its work.

#include "saccade/cuda/internal/compute.hpp"

namespace saccade::test {

/// Emulated device that is lost after some operations.
class LostCompute final : public internal::cuda::Compute {
 public:
  explicit LostCompute(int operations, std::size_t memory_bytes = ~std::size_t{0})
      : device_{Executor{}, memory_bytes}, left_{operations} {}

  [[nodiscard]] Result<void*> allocate(std::size_t bytes) override {
    SACCADE_CHECK(spend());
    return device_.allocate(bytes);
  }
  void release(void* memory) noexcept override { device_.release(memory); }
  [[nodiscard]] Status copy_in(void* to, const void* from, std::size_t bytes) override {
    SACCADE_CHECK(spend());
    return device_.copy_in(to, from, bytes);
  }
  [[nodiscard]] Status copy_out(void* to, const void* from, std::size_t bytes) override {
    SACCADE_CHECK(spend());
    return device_.copy_out(to, from, bytes);
  }
  [[nodiscard]] Status copy_within(void* to, const void* from, std::size_t bytes) override {
    SACCADE_CHECK(spend());
    return device_.copy_within(to, from, bytes);
  }
  [[nodiscard]] Status fill(void* memory, std::uint8_t value, std::size_t bytes) override {
    SACCADE_CHECK(spend());
    return device_.fill(memory, value, bytes);
  }
  [[nodiscard]] Status launch(const internal::cuda::KernelEntry& kernel, std::size_t blocks,
                              const void* arguments) override {
    SACCADE_CHECK(spend());
    return device_.launch(kernel, blocks, arguments);
  }
  [[nodiscard]] Status finish() override { return spend(); }

 private:
  [[nodiscard]] Status spend() {
    if (left_ == 0) return Error{Errc::unavailable, "the device is lost", "cuda"};
    --left_;
    return {};
  }
  internal::cuda::HostCompute device_;
  int left_;
};

}  // namespace saccade::test

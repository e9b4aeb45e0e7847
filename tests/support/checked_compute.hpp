// SPDX-License-Identifier: Apache-2.0
#pragma once
// CheckedCompute: an emulated device whose operations a test lets fail.

#include "saccade/cuda/internal/compute.hpp"

namespace saccade::test {

/// Asks check() before each operation, and returns its error instead of doing it.
class CheckedCompute : public internal::cuda::Compute {
 public:
  /// @param order as of HostCompute.
  explicit CheckedCompute(std::size_t memory_bytes = ~std::size_t{0}, const Executor& executor = {},
                          std::uint32_t order = 0)
      : device_{executor, memory_bytes, order} {}

  [[nodiscard]] Result<void*> allocate(std::size_t bytes) final {
    SACCADE_CHECK(check());
    return device_.allocate(bytes);
  }
  void release(void* memory) noexcept final { device_.release(memory); }
  [[nodiscard]] Status copy_in(void* to, const void* from, std::size_t bytes) final {
    SACCADE_CHECK(check());
    return device_.copy_in(to, from, bytes);
  }
  [[nodiscard]] Status copy_out(void* to, const void* from, std::size_t bytes) final {
    SACCADE_CHECK(check());
    return device_.copy_out(to, from, bytes);
  }
  [[nodiscard]] Status copy_within(void* to, const void* from, std::size_t bytes) final {
    SACCADE_CHECK(check());
    return device_.copy_within(to, from, bytes);
  }
  [[nodiscard]] Status fill(void* memory, std::uint8_t value, std::size_t bytes) final {
    SACCADE_CHECK(check());
    return device_.fill(memory, value, bytes);
  }
  [[nodiscard]] Status launch(const internal::cuda::KernelEntry& kernel, std::size_t blocks,
                              const void* arguments) final {
    SACCADE_CHECK(check());
    SACCADE_CHECK(check_kernel(kernel));
    watch(kernel, blocks);
    return device_.launch(kernel, blocks, arguments);
  }
  [[nodiscard]] Status finish() final { return check(); }

 protected:
  [[nodiscard]] virtual Status check() = 0;
  [[nodiscard]] virtual Status check_kernel(const internal::cuda::KernelEntry& /*kernel*/) { return {}; }
  virtual void watch(const internal::cuda::KernelEntry& /*kernel*/, std::size_t /*blocks*/) {}

 private:
  internal::cuda::HostCompute device_;
};

}  // namespace saccade::test

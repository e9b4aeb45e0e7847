// SPDX-License-Identifier: Apache-2.0
#pragma once
// BorrowedCompute: a device that many maps use one after the other. Opening a GPU takes 0.2 to 0.4 s, and loading the
// kernels some more: a check of hundreds of maps opens one.

#include <memory>

#include "saccade/cuda/internal/compute.hpp"

namespace saccade::bench {

/// Passes everything on.
class BorrowedCompute final : public internal::cuda::Compute {
 public:
  explicit BorrowedCompute(std::shared_ptr<Compute> device) : device_{std::move(device)} {}
  [[nodiscard]] bool is_lost() const override { return device_->is_lost(); }
  [[nodiscard]] Result<void*> allocate(std::size_t bytes) override { return device_->allocate(bytes); }
  void release(void* memory) noexcept override { device_->release(memory); }
  [[nodiscard]] Status copy_in(void* to, const void* from, std::size_t bytes) override {
    return device_->copy_in(to, from, bytes);
  }
  [[nodiscard]] Status copy_out(void* to, const void* from, std::size_t bytes) override {
    return device_->copy_out(to, from, bytes);
  }
  [[nodiscard]] Status copy_within(void* to, const void* from, std::size_t bytes) override {
    return device_->copy_within(to, from, bytes);
  }
  [[nodiscard]] Status fill(void* memory, std::uint8_t value, std::size_t bytes) override {
    return device_->fill(memory, value, bytes);
  }
  [[nodiscard]] Status launch(const internal::cuda::KernelEntry& kernel, std::size_t blocks,
                              const void* arguments) override {
    return device_->launch(kernel, blocks, arguments);
  }
  [[nodiscard]] Status finish() override { return device_->finish(); }

 private:
  std::shared_ptr<Compute> device_;
};

}  // namespace saccade::bench

// SPDX-License-Identifier: Apache-2.0
#pragma once
// BorrowedCompute: a device that many maps use one after the other, or a part of its memory. Opening a GPU and loading
// the kernels ("opening_ms" of the figures) takes long: a check of hundreds of maps opens one.

#include <memory>
#include <unordered_map>
#include <utility>

#include "saccade/cuda/internal/compute.hpp"

namespace saccade::bench {

constexpr std::size_t kAllMemory{~std::size_t{0}};

/// Passes everything on, and gives a map no more than some of the memory.
class BorrowedCompute final : public internal::cuda::Compute {
 public:
  explicit BorrowedCompute(std::shared_ptr<Compute> device, std::size_t memory_bytes = kAllMemory)
      : device_{std::move(device)}, memory_bytes_{memory_bytes} {}
  [[nodiscard]] bool is_lost() const override { return device_->is_lost(); }
  [[nodiscard]] Result<void*> allocate(std::size_t bytes) override {
    if (bytes > memory_bytes_ - used_bytes_)
      return Error{Errc::unavailable, "the benchmark gives no more memory", internal::cuda::kNoRoom};
    SACCADE_TRY(void* const memory, device_->allocate(bytes));
    used_bytes_ += bytes;
    bytes_of_[memory] = bytes;
    return memory;
  }
  void release(void* memory) noexcept override {
    if (const auto found = bytes_of_.find(memory); found != bytes_of_.end()) {
      used_bytes_ -= found->second;
      bytes_of_.erase(found);
    }
    device_->release(memory);
  }
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
  std::size_t memory_bytes_;
  std::size_t used_bytes_{0};
  std::unordered_map<void*, std::size_t> bytes_of_;
};

}  // namespace saccade::bench

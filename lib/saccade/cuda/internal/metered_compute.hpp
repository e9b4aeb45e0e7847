// SPDX-License-Identifier: Apache-2.0
#pragma once
// MeteredCompute: a device whose traffic is counted.

#include <memory>

#include "saccade/cuda/gpu_map.hpp"
#include "saccade/cuda/internal/compute.hpp"

namespace saccade::internal::cuda {

/// Passes everything on, and counts bytes and kernels.
class MeteredCompute final : public Compute {
 public:
  explicit MeteredCompute(std::unique_ptr<Compute> device) : device_{std::move(device)} {}
  [[nodiscard]] const GpuTraffic& traffic() const { return traffic_; }

  [[nodiscard]] bool is_lost() const override { return device_->is_lost(); }
  [[nodiscard]] Result<void*> allocate(std::size_t bytes) override { return device_->allocate(bytes); }
  void release(void* memory) noexcept override { device_->release(memory); }
  [[nodiscard]] Status copy_in(void* to, const void* from, std::size_t bytes) override {
    traffic_.bytes_sent += bytes;
    return device_->copy_in(to, from, bytes);
  }
  [[nodiscard]] Status copy_out(void* to, const void* from, std::size_t bytes) override {
    traffic_.bytes_read += bytes;
    return device_->copy_out(to, from, bytes);
  }
  [[nodiscard]] Status copy_within(void* to, const void* from, std::size_t bytes) override {
    return device_->copy_within(to, from, bytes);
  }
  [[nodiscard]] Status fill(void* memory, std::uint8_t value, std::size_t bytes) override {
    return device_->fill(memory, value, bytes);
  }
  [[nodiscard]] Status launch(const KernelEntry& kernel, std::size_t blocks, const void* arguments) override {
    ++traffic_.kernels;
    return device_->launch(kernel, blocks, arguments);
  }
  [[nodiscard]] Status finish() override { return device_->finish(); }

 private:
  std::unique_ptr<Compute> device_;
  GpuTraffic traffic_{};
};

}  // namespace saccade::internal::cuda

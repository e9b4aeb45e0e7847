// SPDX-License-Identifier: Apache-2.0
#pragma once
// FailingCompute: an emulated device that a test breaks when it likes.

#include <memory>
#include <string>

#include "saccade/cuda/internal/compute.hpp"

namespace saccade::test {

/// What is wrong with a device.
struct Faults {
  bool lost{false};                 ///< everything fails, for good
  std::string kernel_without_room;  ///< starting this kernel takes memory that is not there
  int times{1};                     ///< how often
};

/// Knows that it is lost once an operation has failed for that, as a driver does.
class FailingCompute final : public internal::cuda::Compute {
 public:
  explicit FailingCompute(std::shared_ptr<Faults> faults) : faults_{std::move(faults)} {}

  [[nodiscard]] bool is_lost() const override { return lost_; }
  [[nodiscard]] Result<void*> allocate(std::size_t bytes) override {
    SACCADE_CHECK(check());
    return device_.allocate(bytes);
  }
  void release(void* memory) noexcept override { device_.release(memory); }
  [[nodiscard]] Status copy_in(void* to, const void* from, std::size_t bytes) override {
    SACCADE_CHECK(check());
    return device_.copy_in(to, from, bytes);
  }
  [[nodiscard]] Status copy_out(void* to, const void* from, std::size_t bytes) override {
    SACCADE_CHECK(check());
    return device_.copy_out(to, from, bytes);
  }
  [[nodiscard]] Status copy_within(void* to, const void* from, std::size_t bytes) override {
    SACCADE_CHECK(check());
    return device_.copy_within(to, from, bytes);
  }
  [[nodiscard]] Status fill(void* memory, std::uint8_t value, std::size_t bytes) override {
    SACCADE_CHECK(check());
    return device_.fill(memory, value, bytes);
  }
  [[nodiscard]] Status launch(const internal::cuda::KernelEntry& kernel, std::size_t blocks,
                              const void* arguments) override {
    SACCADE_CHECK(check());
    if (faults_->kernel_without_room == kernel.name && faults_->times > 0) {
      --faults_->times;
      return Error{Errc::unavailable, "no room for a kernel", internal::cuda::kNoRoom};
    }
    return device_.launch(kernel, blocks, arguments);
  }
  [[nodiscard]] Status finish() override { return check(); }

 private:
  [[nodiscard]] Status check() {
    lost_ = lost_ || faults_->lost;
    return lost_ ? Status{Error{Errc::unavailable, "the device is lost", "cuda"}} : Status{};
  }

  internal::cuda::HostCompute device_{Executor{}};
  std::shared_ptr<Faults> faults_;
  bool lost_{false};
};

}  // namespace saccade::test

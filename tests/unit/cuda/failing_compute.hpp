// SPDX-License-Identifier: Apache-2.0
#pragma once
// FailingCompute: an emulated device that a test breaks when it likes.

#include <memory>
#include <string>

#include "support/checked_compute.hpp"

namespace saccade::test {

/// What is wrong with a device.
struct Faults {
  bool lost{false};                 ///< everything fails, for good
  std::string kernel_without_room;  ///< starting this kernel takes memory that is not there
  int times{1};                     ///< how often
};

/// Knows that it is lost once an operation has failed for that, as a driver does.
class FailingCompute final : public CheckedCompute {
 public:
  explicit FailingCompute(std::shared_ptr<Faults> faults) : faults_{std::move(faults)} {}
  [[nodiscard]] bool is_lost() const override { return lost_; }

 private:
  [[nodiscard]] Status check() override {
    lost_ = lost_ || faults_->lost;
    return lost_ ? Status{Error{Errc::unavailable, "the device is lost", "cuda"}} : Status{};
  }
  [[nodiscard]] Status check_kernel(const internal::cuda::KernelEntry& kernel) override {
    if (faults_->kernel_without_room != kernel.name || faults_->times == 0) return {};
    --faults_->times;
    return Error{Errc::unavailable, "no room for a kernel", internal::cuda::kNoRoom};
  }

  std::shared_ptr<Faults> faults_;
  bool lost_{false};
};

}  // namespace saccade::test

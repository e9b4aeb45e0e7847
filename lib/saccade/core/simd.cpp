// SPDX-License-Identifier: Apache-2.0
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/core/simd.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

std::int64_t running_target() { return HWY_TARGET; }

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "saccade/core/simd.hpp"

namespace saccade {
namespace {

HWY_EXPORT(running_target);

}  // namespace

std::string_view simd_target() { return hwy::TargetName(HWY_DYNAMIC_DISPATCH(running_target)()); }

std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) names.emplace_back(hwy::TargetName(target));
  return names;
}

Status use_simd_target(std::string_view name) {
  hwy::SetSupportedTargetsForTest(0);
  std::string known;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (name == hwy::TargetName(target)) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(target);
      return {};
    }
    known += (known.empty() ? "" : ", ") + std::string{hwy::TargetName(target)};
  }
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  if (name.empty()) return {};
  return Error{Errc::invalid_argument, "this machine runs " + known, std::string{name}};
}

}  // namespace saccade
#endif  // HWY_ONCE

// SPDX-License-Identifier: Apache-2.0
#include "attend_methods.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <utility>

#include "options.hpp"
#include "saccade/attention/dip_detector.hpp"
#include "saccade/attention/gmm_as.hpp"
#include "saccade/attention/zvc.hpp"

namespace saccade::cli {
namespace {

AttendDetector ours(bool /*as_printed*/) {
  return [](const HandTrajectory& trajectory) -> Result<AttentionFindings> {
    SACCADE_TRY(DipResult result, detect_dips(trajectory));
    AttentionFindings findings;
    findings.actions = std::move(result.actions);
    findings.motion = std::move(result.motion);
    findings.dips = std::move(result.dips);
    return findings;
  };
}

AttendDetector gmm_as(bool as_printed) {
  return [config = as_printed ? GmmAsConfig::as_printed()
                              : GmmAsConfig{}](const HandTrajectory& trajectory) -> Result<AttentionFindings> {
    SACCADE_TRY(GmmAsResult result, detect_by_gmm(trajectory, config));
    AttentionFindings findings;
    findings.actions = std::move(result.actions);
    for (const SalientGaussian& gaussian : result.gaussians) {
      findings.gaussians.push_back({gaussian.mean_m, gaussian.covariance_m2, gaussian.is_poi});
    }
    return findings;
  };
}

AttendDetector zvc(bool as_printed) {
  return [config = as_printed ? ZvcConfig::as_printed()
                              : ZvcConfig{}](const HandTrajectory& trajectory) -> Result<AttentionFindings> {
    SACCADE_TRY(ZvcResult result, detect_by_zvc(trajectory, config));
    AttentionFindings findings;
    findings.actions = std::move(result.actions);
    return findings;
  };
}

constexpr std::array kMethods{
    AttendMethod{"ours", ours, false},
    AttendMethod{"gmm-as", gmm_as, true},
    AttendMethod{"zvc", zvc, true},
};

}  // namespace

std::span<const AttendMethod> attend_methods() { return kMethods; }

const AttendMethod* find_attend_method(std::string_view name) {
  const auto found = std::find_if(kMethods.begin(), kMethods.end(),
                                  [name](const AttendMethod& method) { return method.name == name; });
  return found == kMethods.end() ? nullptr : &*found;
}

void add_method_option(CLI::App& command, const AttendMethod*& method) {
  method = &attend_methods().front();
  std::vector<std::string_view> names;
  for (const AttendMethod& known : kMethods) names.push_back(known.name);
  const auto take = [&method](const std::string& name) { method = find_attend_method(name); };
  add_words(command, "--method", names, take, "detector of actions", method->name);
}

void add_hand_format_option(CLI::App& command, std::optional<HandFormat>& format) {
  add_choice(command, "--format", format, kHandFormatNames,
             "format of the files of hands (default: by extension; .traj, .csv, .tum or .txt)");
}

}  // namespace saccade::cli

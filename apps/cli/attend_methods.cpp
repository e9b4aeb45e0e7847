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

void add_hand_file_options(CLI::App& command, HandFileOptions& options) {
  add_choice(command, "--format", options.format, kHandFormatNames,
             "format of the files of hands (default: by extension; .traj, .csv, .tum or .txt)");
  add_value(command, "--hand", options.bag_hand, "TOPIC|FRAME",
            "hand in a bag of ROS: a topic of poses or points, or a frame of TF (default: the only such topic)");
  add_value(command, "--world-frame", options.world_frame, "FRAME",
            "frame of the hand's positions in a bag (default: that of its poses, or the root of its TF tree)");
}

Result<HandRecording> read_hand_file(const std::filesystem::path& path, const HandFileOptions& options) {
  if (is_bag(path)) return read_bag_hand(path, options.bag_hand, options.world_frame);
  if (options.bag_hand.empty() && options.world_frame.empty()) return read_hand_trajectory(path, options.format);
  return Error{Errc::invalid_argument, "--hand and --world-frame are for bags of ROS and MCAP files; this is neither",
               path.string()};
}

}  // namespace saccade::cli

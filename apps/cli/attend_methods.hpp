// SPDX-License-Identifier: Apache-2.0
#pragma once
// AttendMethod: the detectors of hand actions that `saccade attend` offers, by name.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "saccade/core/result.hpp"
#include "saccade/io/bags/bags.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/report/attention_picture.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace CLI {
class App;
}

namespace saccade::cli {

/// Finds points of interest in a trajectory; the findings hold the intermediate results that pictures show.
using AttendDetector = std::function<Result<AttentionFindings>(const HandTrajectory&)>;

struct AttendMethod {
  std::string_view name;
  AttendDetector (*make)(bool as_printed);
  bool has_printed{false};  ///< whether the thesis prints values of its own for it
};

/// The first is the default.
[[nodiscard]] std::span<const AttendMethod> attend_methods();

/// Adds --method, which sets `method`, the default at once.
void add_method_option(CLI::App& command, const AttendMethod*& method);
/// How a recording of a hand is read.
struct HandFileOptions {
  std::optional<HandFormat> format;
  std::string bag_hand;     ///< a topic or a frame of TF, in a bag
  std::string world_frame;  ///< TF frame that positions are in, for a bag
};

/// Adds --format, --hand and --world-frame.
void add_hand_file_options(CLI::App& command, HandFileOptions& options);
/// A file of samples, or a bag.
[[nodiscard]] Result<HandRecording> read_hand_file(const std::filesystem::path& path, const HandFileOptions& options);

/// nullptr for a name that none has.
[[nodiscard]] const AttendMethod* find_attend_method(std::string_view name);

}  // namespace saccade::cli

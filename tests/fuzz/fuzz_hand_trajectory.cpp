// SPDX-License-Identifier: Apache-2.0
// Feeds the readers of hand trajectories and labels: the first byte chooses which. What they accept must be usable.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "saccade/io/frames/trajectory_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text{reinterpret_cast<const char*>(data) + 1, size - 1};
  if (data[0] % 4 == 3) {
    const auto labels_m = saccade::parse_hand_labels(text);
    if (!labels_m) return 0;
    for (const Eigen::Vector3d& label : *labels_m) {
      if (!label.allFinite()) std::abort();
    }
    return 0;
  }
  const auto recording = saccade::parse_hand_trajectory(text, static_cast<saccade::HandFormat>(data[0] % 4));
  if (!recording) return 0;
  if (!saccade::validate(recording->trajectory)) std::abort();
  if (recording->report.good() != recording->trajectory.size()) std::abort();
  if (recording->report.to_string().empty()) std::abort();
  return 0;
}

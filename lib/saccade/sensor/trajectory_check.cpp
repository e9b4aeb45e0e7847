// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/hand_trajectory.hpp"

#include "saccade/core/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace saccade {
namespace {

bool is_finite(const HandSample& sample) { return std::isfinite(sample.time_s) && sample.position_m.allFinite(); }

/// Formats a time with six digits, which suffice for any time.
std::string milliseconds(double time_s) {
  std::ostringstream text;
  text << 1e3 * time_s << " ms";
  return text.str();
}

}  // namespace

SampleReport check_samples(std::span<const HandSample> samples) {
  SampleReport report;
  report.samples = samples.size();
  std::vector<double> intervals;
  const HandSample* last = nullptr;
  for (const HandSample& sample : samples) {
    if (!is_finite(sample)) {
      ++report.not_finite;
    } else if (last != nullptr && sample.time_s <= last->time_s) {
      ++report.not_increasing;
    } else {
      if (last != nullptr) {
        intervals.push_back(sample.time_s - last->time_s);
        if (sample.position_m == last->position_m) ++report.repeats;
      }
      last = &sample;
    }
  }
  if (intervals.empty()) return report;
  report.interval_s = upper_median(intervals);
  report.longest_interval_s = *std::max_element(intervals.begin(), intervals.end());
  const double gap_s = SampleReport::kGapIntervals * report.interval_s;
  report.gaps = static_cast<std::size_t>(
      std::count_if(intervals.begin(), intervals.end(), [gap_s](double interval_s) { return interval_s > gap_s; }));
  return report;
}

HandTrajectory usable_samples(std::span<const HandSample> samples) {
  HandTrajectory usable;
  usable.reserve(samples.size());
  for (const HandSample& sample : samples) {
    if (is_finite(sample) && (usable.empty() || sample.time_s > usable.back().time_s)) usable.push_back(sample);
  }
  return usable;
}

Status validate(std::span<const HandSample> trajectory) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const std::string where = "sample " + std::to_string(i);
    if (!is_finite(trajectory[i])) {
      return Error{Errc::invalid_argument, "the time or the position is not finite; usable_samples leaves it out",
                   where};
    }
    if (i > 0 && trajectory[i].time_s <= trajectory[i - 1].time_s) {
      return Error{Errc::invalid_argument, "the time does not increase; usable_samples leaves such samples out", where};
    }
  }
  return {};
}

std::string SampleReport::to_string() const {
  std::string text = std::to_string(samples) + (samples == 1 ? " sample" : " samples");
  if (interval_s > 0.0) text += ", " + milliseconds(interval_s) + " apart";
  char separator = ';';
  const auto add = [&](std::size_t count, const std::string& what) {
    if (count == 0) return;
    text += separator + (' ' + std::to_string(count) + ' ') + what;
    separator = ',';
  };
  add(not_finite, "not finite");
  add(not_increasing, "without increasing time");
  add(repeats, repeats == 1 ? "repeat" : "repeats");
  add(gaps, std::string{gaps == 1 ? "gap" : "gaps"} + " up to " + milliseconds(longest_interval_s));
  return text;
}

}  // namespace saccade

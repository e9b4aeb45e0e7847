// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/hand_recorder.hpp"

#include <cmath>
#include <utility>

namespace saccade {

Status HandRecorderConfig::validate() const {
  SACCADE_CHECK(saccade::validate(Region{workspace}));
  const auto is_length = [](double value) { return std::isfinite(value) && value >= 0.0; };
  if (!is_length(margin_m) || !is_length(dropout_s) || max_samples < 1) {
    return Error{Errc::invalid_argument, "margin and dropout must be finite and not negative, max_samples positive",
                 "HandRecorderConfig"};
  }
  return {};
}

Result<HandRecorder> HandRecorder::create(HandRecorderConfig config) {
  SACCADE_CHECK(config.validate());
  return HandRecorder{std::move(config)};
}

bool HandRecorder::is_inside(const HandSample& sample) const {
  Box box = config_.workspace;
  if (!task_.empty()) {
    box.min.array() -= config_.margin_m;
    box.max.array() += config_.margin_m;
  }
  return contains(box, sample.position_m);
}

std::optional<HandTrajectory> HandRecorder::push(const HandSample& sample) {
  const bool later = std::isfinite(sample.time_s) && (!last_time_s_ || sample.time_s > *last_time_s_);
  std::optional<HandTrajectory> finished;
  if (later && !task_.empty()) {
    const double away_s = sample.time_s - task_[inside_ - 1].time_s;
    if (away_s > config_.dropout_s || task_.size() >= config_.max_samples) finished = finish();
  }
  if (!later || !sample.position_m.allFinite()) {
    ++bad_samples_;
    return finished;
  }
  last_time_s_ = sample.time_s;
  const bool inside = is_inside(sample);
  if (inside || !task_.empty()) task_.push_back(sample);
  if (inside) inside_ = task_.size();
  return finished;
}

std::optional<HandTrajectory> HandRecorder::finish() {
  task_.resize(inside_);
  inside_ = 0;
  HandTrajectory task = std::exchange(task_, {});
  if (task.size() < config_.min_samples || task.empty()) return std::nullopt;
  return task;
}

}  // namespace saccade

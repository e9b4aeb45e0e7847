// SPDX-License-Identifier: Apache-2.0
#pragma once
// Recorder: told what a run does while it goes on; Recorders: several of them.

#include <span>
#include <vector>

#include "saccade/explore/run_record.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade {

/// As it is here, it records nothing. An error ends the run.
class Recorder {
 public:
  virtual ~Recorder() = default;
  /// Called after each pose of the initial scan.
  [[nodiscard]] virtual Status scanning(const ScanRecord& /*scan*/, const TsdfSnapshot& /*map*/) { return {}; }
  /// Called after the initial scan; may add measures to the record.
  [[nodiscard]] virtual Status scanned(ScanRecord& /*scan*/, const TsdfSnapshot& /*map*/) { return {}; }
  /// Called after each view, before it joins the record; may add measures to it.
  /// @param frames those of the view, without those on the way
  [[nodiscard]] virtual Status viewed(ViewRecord& /*view*/, const TsdfSnapshot& /*map*/,
                                      std::span<const Frame> /*frames*/) {
    return {};
  }
  /// Called at the end, however the run ended.
  [[nodiscard]] virtual Status ended(const RunRecord& /*run*/) { return {}; }
};

/// Several, in their order; they outlive it.
class Recorders final : public Recorder {
 public:
  Recorders(std::initializer_list<Recorder*> recorders) : recorders_{recorders} {}
  [[nodiscard]] Status scanning(const ScanRecord& scan, const TsdfSnapshot& map) override {
    for (Recorder* recorder : recorders_) SACCADE_CHECK(recorder->scanning(scan, map));
    return {};
  }
  [[nodiscard]] Status scanned(ScanRecord& scan, const TsdfSnapshot& map) override {
    for (Recorder* recorder : recorders_) SACCADE_CHECK(recorder->scanned(scan, map));
    return {};
  }
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override {
    for (Recorder* recorder : recorders_) SACCADE_CHECK(recorder->viewed(view, map, frames));
    return {};
  }
  [[nodiscard]] Status ended(const RunRecord& run) override {
    for (Recorder* recorder : recorders_) SACCADE_CHECK(recorder->ended(run));
    return {};
  }

 private:
  std::vector<Recorder*> recorders_;
};

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#pragma once
// Recorder: is informed of a run's progress. Recorders: several of them.

#include <span>
#include <vector>

#include "saccade/explore/run_record.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/camera.hpp"

namespace saccade {

/// Recorder of a run. The base class records nothing. An error ends the run.
class Recorder {
 public:
  virtual ~Recorder() = default;
  /// Called after each pose of the initial scan.
  [[nodiscard]] virtual Status scanning(const ScanRecord& /*scan*/, const TsdfSnapshot& /*map*/) { return {}; }
  /// Called after the initial scan; may add measures to the record.
  [[nodiscard]] virtual Status scanned(ScanRecord& /*scan*/, const TsdfSnapshot& /*map*/) { return {}; }
  /// Called after each view, before it joins the record; may add measures to it.
  /// @param frames the view's frames, without those during the motion
  [[nodiscard]] virtual Status viewed(ViewRecord& /*view*/, const TsdfSnapshot& /*map*/,
                                      std::span<const Frame> /*frames*/) {
    return {};
  }
  /// Called at the end of the run, for whatever reason it ends.
  [[nodiscard]] virtual Status ended(const RunRecord& /*run*/) { return {}; }
};

/// Several recorders, called in their order; they must outlive it.
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

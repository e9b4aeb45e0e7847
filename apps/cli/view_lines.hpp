// SPDX-License-Identifier: Apache-2.0
#pragma once
// ViewLines: says the result of each view as soon as it was taken.

#include <string>
#include <utility>

#include "progress_bar.hpp"
#include "saccade/explore/recorder.hpp"

namespace saccade::cli {

/// "view  3  at (0.120, -0.300, 0.550) m  promised 488.0 cm²  delivered 412.3 (84 %)  …": pose, gains, measures,
/// candidates that the robot refused, and the seconds that the view took, those of the motion included.
[[nodiscard]] std::string view_line(std::size_t number, const ViewRecord& view, const std::string& gain_unit);
/// "rehearsed  at (…) m  promised 488.0 cm²; nothing was looked at": a view of a dry run.
[[nodiscard]] std::string rehearsal_line(const ViewRecord& view, const std::string& gain_unit);

/// Stands last among recorders: it says measures that the others have added.
class ViewLines final : public Recorder {
 public:
  /// @param most  number of views at most, for the progress; 0: not known
  ViewLines(ProgressBar& bar, std::size_t most, std::string gain_unit)
      : bar_{bar}, most_{most}, gain_unit_{std::move(gain_unit)} {}
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override;

 private:
  ProgressBar& bar_;
  std::size_t most_;
  std::string gain_unit_;
  std::size_t number_{0};
};

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once
// OracleStrategy: what one would choose who knew the scene; a bound for strategies that do not.

#include "saccade/explore/contour_strategies.hpp"
#include "saccade/explore/metrics.hpp"

namespace saccade {

/// Greedy: of all contour views the one from which the most observable points of the true objects can be seen that the
/// map's mesh does not have yet (Metrics::coverage), 80° from their normal at most, nothing true in between. The same
/// candidates as the others, so no bound on better candidates; and greedy, so no bound on better sequences.
class OracleStrategy final : public Strategy {
 public:
  /// @param camera  that looks; @param tilt_rad  by how much it is tilted up and down at a view.
  /// Expects valid configurations.
  OracleStrategy(Truth truth, const PinholeCamera& camera, double tilt_rad, const ContourConfig& contours,
                 ContourViewConfig views);
  /// By decreasing number of points, of about kOraclePoints spread over the scene; none where nothing is left to be
  /// seen. O(camera centres · points that are missing · log triangles).
  [[nodiscard]] Result<Proposals> propose(const Situation& situation) const override;

 private:
  Truth truth_;
  PinholeCamera camera_;
  ContourCandidates candidates_;
};
constexpr std::size_t kOraclePoints{3000};

}  // namespace saccade

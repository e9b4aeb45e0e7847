// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/frame_report.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {

double tracking_confidence(const IcpResult& found, const IcpConfig& config) {
  if (!found.converged) return 0.0;
  constexpr double kBestAgreement{0.98};
  constexpr double kBestShare{0.8};
  constexpr double kBestConstraint{100.0};  // times its limit
  const auto between = [](double value, double least, double best) {
    return best > least ? std::clamp((value - least) / (best - least), 0.0, 1.0) : 1.0;
  };
  const double constrained = std::log(found.constraint / config.min_constraint) / std::log(kBestConstraint);
  return std::min({between(found.agreement, config.min_agreement, kBestAgreement),
                   between(found.inlier_share, config.min_inlier_share, kBestShare), between(constrained, 0.0, 1.0)});
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/trajectory_error.hpp"

#include <algorithm>
#include <cmath>

namespace saccade {

Status DepthResidual::add(const DepthImage& measured, const DepthImage& map_cast) {
  if (measured.width() != map_cast.width() || measured.height() != map_cast.height()) {
    return Error{Errc::size_mismatch, "measured depth and ray cast differ in size", {}};
  }
  histogram_.resize(static_cast<std::size_t>(std::lround(kLargest_m / kStep_m)) + 1);
  const double last_bin = static_cast<double>(histogram_.size() - 1);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const float z = measured.data()[i];
    if (!(z > 0.0F) || !std::isfinite(z)) continue;
    ++valid_;
    const float cast = map_cast.data()[i];
    if (!(cast > 0.0F)) continue;
    ++taking_part_;
    const double bin = std::round(std::abs(static_cast<double>(cast) - static_cast<double>(z)) / kStep_m);
    ++histogram_[static_cast<std::size_t>(std::min(bin, last_bin))];
  }
  return {};
}

double DepthResidual::share() const {
  return valid_ == 0 ? 0.0 : static_cast<double>(taking_part_) / static_cast<double>(valid_);
}

double DepthResidual::median_m() const {
  std::uint64_t seen = 0;
  for (std::size_t bin = 0; bin < histogram_.size(); ++bin) {
    seen += histogram_[bin];
    if (2 * seen >= taking_part_ && seen > 0) return static_cast<double>(bin) * kStep_m;
  }
  return 0.0;
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/robot/trajectory.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace saccade {

Trajectory::Trajectory(std::vector<Piece> pieces) : pieces_{std::move(pieces)} {
  double t_s = 0.0;
  for (const Piece& piece : pieces_) {
    begins_s_.push_back(t_s);
    t_s += piece.duration_s;
  }
  begins_s_.push_back(t_s);
}

Trajectory::State Trajectory::at(double t_s) const {
  SACCADE_EXPECTS(!pieces_.empty());
  const auto later = std::upper_bound(begins_s_.begin(), begins_s_.end() - 1, t_s);
  const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, std::distance(begins_s_.begin(), later)) - 1);
  const Piece& piece = pieces_[i];
  const double t = std::clamp(t_s - begins_s_[i], 0.0, piece.duration_s);
  return {piece.q + t * piece.speed + 0.5 * t * t * piece.acceleration, piece.speed + t * piece.acceleration};
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "view_lines.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "summary.hpp"

namespace saccade::cli {
namespace {

std::string gain_text(double gain) { return std::isfinite(gain) ? fixed(gain, gain == std::floor(gain) ? 0 : 1) : "-"; }

/// "4123 (84 %)"; a dash where it was not checked.
std::string delivered_text(const ViewRecord& view) {
  if (!std::isfinite(view.gain_observed)) return "-";
  const bool has_share = std::isfinite(view.gain_predicted) && view.gain_predicted > 0.0;
  const std::string share = has_share ? " (" + fixed(100.0 * view.gain_observed / view.gain_predicted, 0) + " %)" : "";
  return gain_text(view.gain_observed) + share;
}

}  // namespace

std::string rehearsal_line(const ViewRecord& view, const std::string& gain_unit) {
  const Eigen::Vector3d p = view.T_world_camera.translation();
  return "rehearsed at (" + fixed(p.x(), 3) + ", " + fixed(p.y(), 3) + ", " + fixed(p.z(), 3) + ") m  promised " +
         gain_text(view.gain_predicted) + ' ' + gain_unit + ": the arm would go there; nothing was looked at";
}

std::string view_line(std::size_t number, const ViewRecord& view, const std::string& gain_unit) {
  const Eigen::Vector3d p = view.T_world_camera.translation();
  std::ostringstream text;
  text << "view " << std::setw(2) << number << "  at (" << fixed(p.x(), 3) << ", " << fixed(p.y(), 3) << ", "
       << fixed(p.z(), 3) << ") m  promised " << gain_text(view.gain_predicted) << ' ' << gain_unit << "  delivered "
       << delivered_text(view);
  if (view.measures.coverage) text << "  coverage " << percent(*view.measures.coverage);
  text << "  unknown " << view.measures.unknown_left << "  refused " << view.refused.total() << " of "
       << view.candidates << "  " << fixed(1e-3 * view.times.total_ms() + view.motion_s, 1) << " s";
  return text.str();
}

Status ViewLines::viewed(ViewRecord& view, const TsdfSnapshot& /*map*/, std::span<const Frame> /*frames*/) {
  ++number_;
  bar_.say(view_line(number_, view, gain_unit_));
  bar_.update("exploring", number_, most_);
  return {};
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/runs/run_json.hpp"

#include <cmath>
#include <string>

#include "saccade/io/files/json_io.hpp"
#include "saccade/robot/trajectory.hpp"

namespace saccade {
namespace {

using nlohmann::json;

Error damaged(const std::string& what) {
  return Error{Errc::corrupt_data, "the record of a view is damaged: " + what, ""};
}

/// Gains are usually counts, which read better as integers.
json gain_to_json(double gain) {
  constexpr double kExact{9007199254740992.0};
  return gain >= 0.0 && gain < kExact && gain == std::floor(gain) ? json(static_cast<std::uint64_t>(gain)) : json(gain);
}

template <class T>
json to_json(const std::optional<T>& value) {
  return value ? json(*value) : json(nullptr);
}

/// Returns nullopt where the key is missing or null.
template <class T>
std::optional<T> optional_in(const json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() || found->is_null() ? std::nullopt : std::optional{found->get<T>()};
}

/// Reads a pose to the last bit; pose_from_json would make it rigid again.
Result<Pose> exact_pose(const json& value) {
  SACCADE_TRY(Pose pose, pose_from_json(value));
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      pose.matrix()(row, column) = value[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)].get<double>();
    }
  }
  return pose;
}

void read_tilt(const json& value, Tilt& tilt) {
  const auto found = value.find("tilt_rad");
  if (found != value.end()) tilt = {found->at(0).get<double>(), found->at(1).get<double>()};
}

/// Returns null where no frame was tracked.
json tracking_to_json(const TrackedFrames& tracking) {
  if (tracking == TrackedFrames{}) return nullptr;
  return {{"tracked", tracking.tracked},
          {"refused", tracking.refused},
          {"correction_m", tracking.correction_m},
          {"correction_rad", tracking.correction_rad},
          {"why", tracking.why}};
}

void read_tracking(const json& value, TrackedFrames& tracking) {
  const auto found = value.find("tracking");
  if (found == value.end() || found->is_null()) return;
  tracking = {found->at("tracked").get<std::size_t>(), found->at("refused").get<std::size_t>(),
              found->at("correction_m").get<double>(), found->at("correction_rad").get<double>(),
              found->at("why").get<std::string>()};
}

json attention_to_json(const std::optional<ViewAttention>& attention) {
  if (!attention) return nullptr;
  return {{"segments", attention->segments},
          {"contours", attention->contours},
          {"segment", attention->segment},
          {"rank", attention->rank},
          {"saliency", attention->saliency},
          {"why", attention->why},
          {"contours_of_segment", attention->contours_of_segment}};
}

std::optional<ViewAttention> read_attention(const json& value) {
  const auto found = value.find("attention");
  if (found == value.end() || found->is_null()) return std::nullopt;
  ViewAttention attention;
  attention.segments = found->at("segments").get<std::size_t>();
  attention.contours = found->at("contours").get<std::size_t>();
  attention.segment = found->at("segment").get<std::uint32_t>();
  attention.rank = found->at("rank").get<std::size_t>();
  attention.saliency = found->at("saliency").get<double>();
  attention.why = found->at("why").get<std::string>();
  attention.contours_of_segment = found->at("contours_of_segment").get<std::size_t>();
  return attention;
}

Result<ViewRecord> read_view(const json& value) {
  ViewRecord view;
  view.region = value.at("region").get<std::size_t>();
  SACCADE_TRY(view.T_world_camera, exact_pose(value.at("T_world_camera")));
  SACCADE_TRY(view.q, configuration_from_json(value.value("q", json(nullptr))));
  view.gain_predicted = optional_in<double>(value, "gain").value_or(std::nan(""));
  view.gain_observed = optional_in<double>(value, "gain_observed").value_or(std::nan(""));
  view.measures.coverage = optional_in<double>(value, "coverage");
  view.measures.unknown_left = optional_in<std::size_t>(value, "unknown_left").value_or(0);
  view.measures.unknown_near_objects = optional_in<std::size_t>(value, "unknown_near_objects");
  view.reveals_object = optional_in<bool>(value, "points_at_object");
  view.looks_at_object = optional_in<bool>(value, "looks_at_object");
  view.candidates = value.value("candidates", std::size_t{0});
  view.evaluated = value.value("evaluated", std::size_t{0});
  SACCADE_TRY(view.refused, refusals_from_json(value.value("refused", json::object())));
  view.frames = value.value("frames", std::size_t{0});
  view.frames_on_way = value.value("frames_on_way", std::size_t{0});
  read_tracking(value, view.tracking);
  read_tilt(value, view.tilt);
  view.motion_s = value.value("motion_s", 0.0);
  view.retreat_s = value.value("retreat_s", 0.0);
  view.path_m = value.value("path_m", 0.0);
  view.attention = read_attention(value);
  const json ms = value.value("ms", json::object());
  for (const Phase phase : kPhaseNames.values) view.times.add(phase, ms.value(std::string{to_string(phase)}, 0.0));
  return view;
}

}  // namespace

json configuration_to_json(const std::optional<Configuration>& q) {
  return q ? json(std::vector<double>(q->begin(), q->end())) : json(nullptr);
}

Result<std::optional<Configuration>> configuration_from_json(const json& value) {
  if (value.is_null()) return std::optional<Configuration>{};
  try {
    const auto values = value.get<std::vector<double>>();
    if (values.size() > static_cast<std::size_t>(kMaxJoints)) return damaged("too many joints");
    return std::optional<Configuration>{Eigen::Map<const Eigen::VectorXd>{values.data(), std::ssize(values)}};
  } catch (const json::exception& e) {
    return damaged(message_of(e));
  }
}

json times_to_json(const PhaseTimes& times) {
  json ms = json::object();
  for (const Phase phase : kPhaseNames.values) ms[std::string{to_string(phase)}] = times.ms(phase);
  return ms;
}

json view_to_json(const ViewRecord& view, std::size_t index) {
  return {{"index", index},
          {"region", view.region},
          {"gain", gain_to_json(view.gain_predicted)},
          {"gain_observed", gain_to_json(view.gain_observed)},
          {"candidates", view.candidates},
          {"evaluated", view.evaluated},
          {"refused", refusals_to_json(view.refused)},
          {"frames", view.frames},
          {"frames_on_way", view.frames_on_way},
          {"tracking", tracking_to_json(view.tracking)},
          {"tilt_rad", {view.tilt.least_rad, view.tilt.greatest_rad}},
          {"T_world_camera", pose_to_json(view.T_world_camera)},
          {"unknown_left", view.measures.unknown_left},
          {"unknown_near_objects", to_json(view.measures.unknown_near_objects)},
          {"points_at_object", to_json(view.reveals_object)},
          {"looks_at_object", to_json(view.looks_at_object)},
          {"coverage", to_json(view.measures.coverage)},
          {"q", configuration_to_json(view.q)},
          {"motion_s", view.motion_s},
          {"retreat_s", view.retreat_s},
          {"path_m", view.path_m},
          {"attention", attention_to_json(view.attention)},
          {"ms", times_to_json(view.times)}};
}

Result<ViewRecord> view_from_json(const json& value) {
  try {
    return read_view(value);
  } catch (const json::exception& e) {
    return damaged(message_of(e));
  }
}

json views_to_json(const std::vector<ViewRecord>& views) {
  json values = json::array();
  for (const ViewRecord& view : views) values.push_back(view_to_json(view, values.size()));
  return values;
}

Result<std::vector<ViewRecord>> views_from_json(const json& values) {
  std::vector<ViewRecord> views;
  for (const json& value : values) {
    SACCADE_TRY(ViewRecord view, view_from_json(value));
    views.push_back(std::move(view));
  }
  return views;
}

json scan_to_json(const ScanRecord& scan) {
  return {{"coverage", to_json(scan.measures.coverage)},
          {"unknown_left", scan.measures.unknown_left},
          {"views", scan.views},
          {"attempted", scan.attempted},
          {"refused", refusals_to_json(scan.refused)}};
}

Result<ScanRecord> scan_from_json(const json& value) {
  try {
    ScanRecord scan;
    scan.measures.coverage = optional_in<double>(value, "coverage");
    scan.measures.unknown_left = value.at("unknown_left").get<std::size_t>();
    scan.views = value.value("views", std::size_t{0});
    scan.attempted = value.value("attempted", scan.views);
    SACCADE_TRY(scan.refused, refusals_from_json(value.value("refused", json::object())));
    return scan;
  } catch (const json::exception& e) {
    return damaged(message_of(e));
  }
}

json measures_to_json(const Measures& measures) {
  return {{"coverage", to_json(measures.coverage)},
          {"unknown_left", measures.unknown_left},
          {"unknown_near_objects", to_json(measures.unknown_near_objects)},
          {"accuracy_m", to_json(measures.accuracy_m)},
          {"chamfer_m", to_json(measures.chamfer_m)},
          {"f_score", to_json(measures.f_score)}};
}

json phases_to_json(const std::vector<ViewRecord>& views) {
  json phases = json::object();
  if (views.empty()) return phases;
  PhaseTimes times;
  double robot_s = 0.0;
  for (const ViewRecord& view : views) {
    times.add(view.times);
    robot_s += view.motion_s;
  }
  for (const Phase phase : kPhaseNames.values) phases[std::string{to_string(phase)}] = 1e-3 * times.ms(phase);
  phases["robot"] = robot_s;
  return phases;
}

}  // namespace saccade

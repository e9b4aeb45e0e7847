// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/runs/run_messages.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "saccade/io/maps/ternary_export.hpp"
#include "saccade/io/runs/internal/map_messages.hpp"

namespace saccade {
namespace {

using messages::ColorRGBA;
using messages::Marker;

constexpr double kFrustum_m{0.08};  ///< depth of a drawn camera
constexpr double kArrow_m{0.05};    ///< length of a candidate's axis
constexpr double kLine_m{0.003};    ///< width of lines
constexpr ColorRGBA kChosen{0.1F, 0.9F, 0.3F, 1.0F};

messages::Time system_time() {
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  return messages::Time::from_seconds(std::chrono::duration<double>(since).count());
}

/// Returns the corners of a camera's image at a depth, and its centre, as eight lines.
std::vector<messages::Point> frustum_of(const PinholeCamera& camera, const Pose& T_world_camera) {
  const auto corner = [&](double u, double v) { return to_point(T_world_camera * (kFrustum_m * camera.ray(u, v))); };
  const double right = camera.width - 0.5;
  const double bottom = camera.height - 0.5;
  const std::array<messages::Point, 4> corners{corner(-0.5, -0.5), corner(right, -0.5), corner(right, bottom),
                                               corner(-0.5, bottom)};
  const messages::Point centre = to_point(T_world_camera.translation());
  std::vector<messages::Point> lines;
  for (std::size_t i = 0; i < 4; ++i) {
    lines.insert(lines.end(), {centre, corners[i], corners[i], corners[(i + 1) % 4]});
  }
  return lines;
}

/// Returns a colour from blue over green to red.
ColorRGBA heat(double share) {
  const auto x = static_cast<float>(std::clamp(share, 0.0, 1.0));
  return {std::clamp(2.0F * x - 1.0F, 0.0F, 1.0F), 1.0F - std::abs(2.0F * x - 1.0F),
          std::clamp(1.0F - 2.0F * x, 0.0F, 1.0F), 0.8F};
}

/// Draws the best candidates as short lines along their optical axes, coloured by gain.
Marker candidates_marker(const std::vector<RankedView>& candidates, std::size_t most) {
  std::vector<RankedView> best;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(best),
               [](const RankedView& view) { return std::isfinite(view.gain); });
  order_by_gain(best);
  if (best.size() > most) best.resize(most);
  Marker marker;
  marker.ns = "candidates";
  marker.type = Marker::line_list;
  marker.scale = {kLine_m, 0.0, 0.0};
  const double largest = best.empty() ? 1.0 : std::max(best.front().gain, 1e-12);
  for (const RankedView& view : best) {
    const Eigen::Vector3d from = view.T_world_camera.translation();
    marker.points.push_back(to_point(from));
    marker.points.push_back(to_point(from + kArrow_m * view.T_world_camera.linear().col(2)));
    marker.colors.insert(marker.colors.end(), 2, heat(view.gain / largest));
  }
  return marker;
}

Marker chosen_marker(const PinholeCamera& camera, const Pose& T_world_camera) {
  Marker marker;
  marker.ns = "chosen";
  marker.type = Marker::line_list;
  marker.scale = {2.0 * kLine_m, 0.0, 0.0};
  marker.color = kChosen;
  marker.points = frustum_of(camera, T_world_camera);
  return marker;
}

}  // namespace

RunMessages::RunMessages(RunMessagesConfig config, const PinholeCamera& camera)
    : config_{std::move(config)}, camera_{camera} {
  if (!config_.now) config_.now = &system_time;
}

void RunMessages::add(std::unique_ptr<messages::MessageSink> sink) { sinks_.push_back(std::move(sink)); }

messages::Header RunMessages::header() const { return {time_, config_.frame_id}; }

void RunMessages::end(std::unique_ptr<messages::MessageSink>& sink, const Status& status) {
  if (status.ok()) return;
  sink.reset();
  if (config_.failed) config_.failed(status.error());
}

template <class Message>
void RunMessages::send(const std::string& topic, const Message& message) {
  std::array<std::vector<std::byte>, 2> written;  // once for each layout that a sink wants
  for (auto& sink : sinks_) {
    if (!sink) continue;
    auto& bytes = written[sink->wire() == messages::Wire::cdr ? 1 : 0];
    if (bytes.empty()) bytes = messages::write_message(sink->wire(), message);
    end(sink, sink->add(topic, messages::type_of<Message>(), time_, bytes));
  }
}

void RunMessages::flush() {
  for (auto& sink : sinks_) {
    if (sink) end(sink, sink->flush());
  }
}

void RunMessages::finish() {
  for (auto& sink : sinks_) {
    if (sink) end(sink, sink->finish());
  }
  sinks_.clear();
}

bool RunMessages::silent() const {
  return std::none_of(sinks_.begin(), sinks_.end(), [](const auto& sink) { return sink != nullptr; });
}

Status RunMessages::scanned(ScanRecord& /*scan*/, const TsdfSnapshot& map) {
  if (silent()) return {};
  time_ = config_.now();
  send_map(map);
  flush();
  return {};
}

Status RunMessages::viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) {
  if (silent()) return {};
  time_ = config_.now();
  send_view(view);
  // A frame is tilted relative to its view, so the camera is drawn where the frame was taken.
  const bool has_pose = !frames.empty() && frames.back().T_world_camera;
  const Pose& T_world_camera = has_pose ? *frames.back().T_world_camera : view.T_world_camera;
  send("/tf", messages::TFMessage{{{header(), config_.camera_frame_id, to_message(T_world_camera)}}});
  if (!frames.empty()) send_frame(frames.back());
  send_map(map);
  flush();
  return {};
}

void RunMessages::send_map(const TsdfSnapshot& map) {
  send(config_.prefix + "/occupied", occupied_cloud(header(), map, config_.most_points));
  send(config_.prefix + "/frontier",
       cloud_of(header(), thinned(frontier_voxels(map, ~std::size_t{0}), config_.most_points)));
  if (map.config.workspace) send(config_.prefix + "/map_2d", plan_of(header(), map, *map.config.workspace));
}

void RunMessages::send_view(const ViewRecord& view) {
  messages::MarkerArray markers;
  if (view.choice) markers.markers.push_back(candidates_marker(view.choice->candidates, config_.most_candidates));
  markers.markers.push_back(chosen_marker(camera_, view.T_world_camera));
  for (Marker& marker : markers.markers) marker.header = header();
  send(config_.prefix + "/candidates", markers);
  send(config_.prefix + "/next_view", messages::PoseStamped{header(), to_message(view.T_world_camera)});
  messages::Path path{header(), {}};
  for (const Eigen::Vector3d& p : view.path) path.poses.push_back({header(), {to_point(p), {}}});
  send(config_.prefix + "/plan", path);
}

void RunMessages::send_frame(const Frame& frame) {
  messages::Header in_camera{time_, config_.camera_frame_id};
  send(config_.prefix + "/depth/image_raw", depth_message(in_camera, frame.depth));
  send(config_.prefix + "/depth/camera_info", info_message(std::move(in_camera), camera_));
}

}  // namespace saccade

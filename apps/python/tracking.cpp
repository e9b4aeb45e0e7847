// SPDX-License-Identifier: Apache-2.0
// Tracker: tracks a camera against a map, and fuses its frames.
#include "saccade/tracking/reconstruction.hpp"

#include "convert.hpp"
#include "map.hpp"

namespace saccade::python {
namespace {

py::dict track_dict(const FrameReport& report, bool fused) {
  py::dict result;
  result["accepted"] = report.status == FrameReport::Status::fused;
  result["T_world_camera"] = from_pose(report.T_world_camera);
  result["why"] = report.why;
  result["fused"] = fused && report.status == FrameReport::Status::fused;
  result["rmse_m"] = report.icp.rmse_m;
  result["inlier_share"] = report.icp.inlier_share;
  result["agreement"] = report.icp.agreement;
  result["iterations"] = report.icp.iterations;
  result["confidence"] = report.confidence ? py::object{py::float_{*report.confidence}} : py::none();
  result["relocalised"] = report.relocalised;
  return result;
}

/// Reconstruction's loop on a map that Python shares.
class Tracker {
 public:
  Tracker(py::object map, const PinholeCamera& camera, const std::string& mode)
      : map_{std::move(map)}, camera_{camera} {
    const auto found = kTrackingModeNames.find(mode);
    if (!found) throw py::value_error{"mode must be " + kTrackingModeNames.listed() + ", not " + mode};
    mode_ = *found;
    if (!py::isinstance<SharedMap>(map_)) throw py::type_error{"map must be a TsdfMap"};
  }

  py::dict process(const py::array& depth, const std::optional<py::array>& T_hint,
                   const std::optional<py::array>& color, bool fuse) {
    Frame frame;
    frame.depth = to_depth(depth);
    if (color) frame.color = to_color(*color);
    std::optional<Pose> hint;
    if (T_hint) hint = to_pose(*T_hint);
    if (needs_pose(mode_) && !hint) {
      throw py::value_error{"mode " + std::string{to_string(mode_)} + " needs T_hint for every frame"};
    }
    auto& map = map_.cast<SharedMap&>();
    const Pose last = T_world_last_.value_or(hint.value_or(Pose::Identity()));
    const FrameReport report = take(map.write([&](TsdfMap& content) -> Result<FrameReport> {
      SACCADE_TRY(FrameReport found, find(content.content(), frame, hint, last, map.executor()));
      if (!fuse || found.status == FrameReport::Status::lost) return found;
      const ColorImage* colors = frame.color ? &*frame.color : nullptr;
      SACCADE_TRY(found.fusion, content.integrate(camera_, frame.depth, found.T_world_camera, map.executor(), colors));
      if (mode_ == TrackingMode::rgbd) rgbd_.fused(frame, camera_, found.T_world_camera, map.executor());
      return found;
    }));
    if (fuse && report.status == FrameReport::Status::fused) T_world_last_ = report.T_world_camera;
    return track_dict(report, fuse);
  }

  [[nodiscard]] py::object pose() const { return T_world_last_ ? py::object{from_pose(*T_world_last_)} : py::none(); }
  void set_pose(const py::array& T_world_camera) {
    T_world_last_ = to_pose(T_world_camera);
    rgbd_.moved_to(*T_world_last_);
  }

 private:
  /// Finds the pose of a frame: the hint itself, or the result of ICP from hint or last pose, or of RgbdTracker. An
  /// empty map has nothing to align to: the first frame defines the world.
  [[nodiscard]] Result<FrameReport> find(const TsdfSnapshot& map, const Frame& frame, const std::optional<Pose>& hint,
                                         const Pose& last, const Executor& executor) {
    if (mode_ == TrackingMode::rgbd && !map.grid.empty()) {
      if (!T_world_last_) rgbd_.moved_to(last);
      return rgbd_.track(surface_of_map(map, camera_, executor), frame, camera_, executor);
    }
    if (mode_ != TrackingMode::forced && !map.grid.empty()) {
      return track_frame(map, frame, camera_, mode_ == TrackingMode::hint ? *hint : last, executor);
    }
    FrameReport report;
    report.T_world_camera = hint.value_or(last);
    return report;
  }

  py::object map_;
  PinholeCamera camera_;
  TrackingMode mode_{TrackingMode::icp};
  std::optional<Pose> T_world_last_;
  RgbdTracker rgbd_;  ///< used in mode rgbd
};

}  // namespace

void bind_tracking(py::module_& module) {
  py::class_<Tracker>(
      module, "Tracker",
      "Tracks a camera against a TsdfMap (thesis 2.2.1), and fuses its frames into it. Methods return a "
      "dict: accepted, T_world_camera (4 x 4), why (where the track is lost), fused; and of ICP rmse_m "
      "(of point-to-plane distances, metres), inlier_share, agreement, iterations (0 where none ran); confidence (0 to "
      "1, or "
      "None) and relocalised.")
      .def(py::init<py::object, const PinholeCamera&, const std::string&>(), py::arg("map"), py::arg("camera"),
           py::arg("mode") = "icp",
           "`mode`: icp (from the last pose; `T_hint` is that of the first frame, else the identity), rgbd (as icp, "
           "with the colours of fused frames and from the last motion), hint (ICP from "
           "`T_hint`) or forced (`T_hint` as it is).")
      .def(
          "track",
          [](Tracker& tracker, const py::array& depth, const std::optional<py::array>& T_hint,
             const std::optional<py::array>& color) { return tracker.process(depth, T_hint, color, false); },
          py::arg("depth"), py::arg("T_hint") = py::none(), py::arg("color") = py::none(),
          "Finds where a depth image, H x W as of TsdfMap.integrate, was taken; map and last pose stay.")
      .def(
          "fuse",
          [](Tracker& tracker, const py::array& depth, const std::optional<py::array>& T_hint,
             const std::optional<py::array>& color) { return tracker.process(depth, T_hint, color, true); },
          py::arg("depth"), py::arg("T_hint") = py::none(), py::arg("color") = py::none(),
          "As track, and fuses the frame where the track was found. `color`: H x W x 3 uint8.")
      .def_property("T_world_camera", &Tracker::pose, &Tracker::set_pose,
                    "Pose of the last fused frame, 4 x 4, or None. Set it where the camera was moved meanwhile.");
}

}  // namespace saccade::python

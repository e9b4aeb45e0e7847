// SPDX-License-Identifier: Apache-2.0
// Detection of a hand's actions from its trajectory: whole trajectories, and samples as they arrive.
#include "arrays.hpp"
#include "saccade/attention/detector_evaluation.hpp"
#include "saccade/attention/dip_detector.hpp"
#include "saccade/attention/gmm_as.hpp"
#include "saccade/attention/zvc.hpp"
#include "saccade/io/bags/bags.hpp"

namespace saccade::python {
namespace {

enum class ActionMethod { ours, gmm_as, zvc };
constexpr auto kActionMethodNames = make_names<ActionMethod>(
    {{ActionMethod::ours, "ours"}, {ActionMethod::gmm_as, "gmm-as"}, {ActionMethod::zvc, "zvc"}});

py::dict action_dict(const HandAction& action) {
  py::dict result;
  result["time_s"] = action.time_s;
  result["position_m"] = from_point(action.position_m);
  result["saliency"] = action.saliency;
  result["why"] = action.why;
  return result;
}

py::list action_dicts(std::span<const HandAction> actions) {
  py::list result;
  for (const HandAction& action : actions) result.append(action_dict(action));
  return result;
}

HandTrajectory trajectory_of(const py::object& times_s, const py::object& positions_m) {
  const std::vector<double> times = to_numbers(times_s, "times_s");
  const std::vector<Eigen::Vector3d> positions = to_vectors(positions_m, "positions_m");
  if (times.size() != positions.size()) {
    throw py::value_error{"times_s has " + std::to_string(times.size()) + " samples, positions_m has " +
                          std::to_string(positions.size())};
  }
  HandTrajectory trajectory(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) trajectory[i] = {times[i], positions[i], std::nullopt};
  return trajectory;
}

Result<std::vector<HandAction>> detect(const HandTrajectory& trajectory, ActionMethod method, bool as_printed) {
  switch (method) {
    case ActionMethod::gmm_as: {
      SACCADE_TRY(GmmAsResult found, detect_by_gmm(trajectory, as_printed ? GmmAsConfig::as_printed() : GmmAsConfig{}));
      return std::move(found.actions);
    }
    case ActionMethod::zvc: {
      SACCADE_TRY(ZvcResult found, detect_by_zvc(trajectory, as_printed ? ZvcConfig::as_printed() : ZvcConfig{}));
      return std::move(found.actions);
    }
    case ActionMethod::ours: break;
  }
  SACCADE_TRY(DipResult found, detect_dips(trajectory));
  return std::move(found.actions);
}

py::list find_actions(const py::object& times_s, const py::object& positions_m, const std::string& method,
                      bool as_printed) {
  const ActionMethod chosen = value_of(kActionMethodNames, method, "method");
  if (as_printed && chosen == ActionMethod::ours) throw py::value_error{"the thesis prints nothing for method ours"};
  const HandTrajectory trajectory = trajectory_of(times_s, positions_m);
  const auto found = [&] {
    const py::gil_scoped_release released;
    return detect(trajectory, chosen, as_printed);
  }();
  return action_dicts(take(found));
}

py::tuple read_hand(const std::string& path, const std::string& hand, const std::string& world_frame) {
  const auto read = [&]() -> Result<HandRecording> {
    const py::gil_scoped_release released;
    if (is_bag(path)) return read_bag_hand(path, hand, world_frame);
    return read_hand_trajectory(path);
  };
  const HandRecording recording = take(read());
  std::vector<double> times_s;
  std::vector<Eigen::Vector3d> positions_m;
  for (const HandSample& sample : recording.trajectory) {
    times_s.push_back(sample.time_s);
    positions_m.push_back(sample.position_m);
  }
  const auto count = static_cast<py::ssize_t>(times_s.size());
  return py::make_tuple(adopt(std::move(times_s), {count}), from_vectors(positions_m));
}

py::dict score_actions(const std::vector<py::dict>& actions, const py::object& labels_m, double match_radius_m) {
  std::vector<HandAction> found;
  for (const py::dict& action : actions) {
    if (!action.contains("position_m")) throw py::value_error{"an action must be a dict with position_m"};
    found.push_back({to_point(action["position_m"]), 0.0, 0.0, {}});
  }
  const TrajectoryScore scored = score(found, to_vectors(labels_m, "labels_m"), match_radius_m);
  const DetectionCounts& counts = scored.counts;
  py::dict result;
  result["labels"] = counts.labels;
  result["true_positives"] = counts.true_positives;
  result["false_positives"] = counts.false_positives;
  result["precision"] = counts.precision();
  result["recall"] = counts.recall();
  result["location_errors_m"] = scored.location_errors_m;
  return result;
}

}  // namespace

void bind_hands(py::module_& module) {
  module.def("find_actions", &find_actions, py::arg("times_s"), py::arg("positions_m"), py::kw_only(),
             py::arg("method") = "ours", py::arg("as_printed") = false,
             "Finds where a hand did something. `times_s`: N seconds that never decrease; `positions_m`: N x 3 metres, "
             "world frame. `method`: ours (dips of the smoothed speed), gmm-as or zvc (thesis 2.2.4). `as_printed`: "
             "formula and thresholds as the thesis prints them. Returns a list of dicts by time: time_s, position_m, "
             "saliency (in the unit of the method; larger is more certain), why.");
  module.def("read_hand", &read_hand, py::arg("path"), py::kw_only(), py::arg("hand") = "", py::arg("world_frame") = "",
             "Reads the motion of a hand: .traj, .csv, .tum or .txt, or a bag (.bag, .mcap) with a topic or TF frame "
             "`hand`. Returns times_s (N seconds) and positions_m (N x 3 metres); bad samples are left out.");
  module.def("score_actions", &score_actions, py::arg("actions"), py::arg("labels_m"), py::kw_only(),
             py::arg("match_radius_m") = 0.2,
             "Compares actions with where the hand acted in truth, `labels_m`: M x 3 metres. Returns a dict: labels, "
             "true_positives, false_positives, precision, recall (None without a denominator), location_errors_m.");
  py::class_<DipStream>(module, "ActionStream",
                        "Finds actions while the hand is still moving, as soon as it moves away from one.")
      .def(py::init([] { return take(DipStream::create()); }))
      .def(
          "put",
          [](DipStream& stream, double time_s, const py::object& position_m) {
            return action_dicts(take(stream.put({time_s, to_point(position_m), std::nullopt})));
          },
          py::arg("time_s"), py::arg("position_m"),
          "Takes a sample, seconds and (x, y, z) metres in the world frame. Returns the actions, dicts as of "
          "find_actions, that are certain with it: none as a rule.");
}

}  // namespace saccade::python

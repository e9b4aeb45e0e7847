// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/explorer.hpp"

#include <mutex>

#include "arm.hpp"
#include "records.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "seams.hpp"

namespace saccade::python {
namespace {

/// Returns the settings of planners, from those of a map and a camera.
SimulatedRunConfig planner_config(const PinholeCamera& camera, const py::object& strategy, int gain_width,
                                  std::optional<double> min_gain, std::optional<std::vector<double>> radii_m,
                                  int max_views) {
  SimulatedRunConfig config;
  config.camera = camera;
  config.gain_width_px = gain_width;
  config.exploration.max_views = max_views;
  if (radii_m) {
    config.sphere.radii_m = *radii_m;
    config.contour_views.distances_m = *radii_m;
  }
  config = config.with(planner_of(strategy, builtin_planners()));
  if (min_gain) config.planner.min_gain = *min_gain;
  take(config.validate());
  return config;
}

std::vector<Region> regions_to_look_at(const py::object& regions, const TsdfSnapshot& map,
                                       const NamedPlanner& strategy) {
  std::vector<Region> found;
  if (!regions.is_none()) {
    if (!strategy.looks_at_regions) {
      throw py::value_error{"the strategy " + strategy.name +
                            " explores the whole workspace, and takes no regions; sphere and random do"};
    }
    for (const py::handle region : regions) {
      found.push_back(to_region(py::reinterpret_borrow<py::object>(region)));
      take(validate(found.back()));
    }
  } else if (map.config.workspace) {
    found.emplace_back(*map.config.workspace);
  }
  if (found.empty()) {
    throw py::value_error{strategy.looks_at_regions ? "name regions, or give the map a workspace"
                                                    : "give the map a workspace"};
  }
  return found;
}

/// Explorer with all its parts, and the record of its run.
class OwnExplorer {
 public:
  OwnExplorer(SharedMap map, const py::object& camera, const py::object& robot, const py::object& strategy,
              const py::object& regions, const py::object& recorder, const py::object& stopping,
              const py::object& approve, int gain_width, std::optional<double> min_gain,
              std::optional<std::vector<double>> radii_m, int oscillation_frames, double good_enough)
      : map_{std::move(map)},
        camera_{camera_of(camera)},
        recorder_{recorder_of(recorder)},
        stopping_{stopping_of(stopping)},
        approve_{approve.is_none() ? nullptr : std::make_unique<Kept>(body_of(approve, "approve"))},
        config_{planner_config(camera_->intrinsics(), strategy, gain_width, min_gain, std::move(radii_m), 1000)} {
    if (py::isinstance<OwnArm>(robot)) {
      hold(robot.cast<const OwnArm&>());
    } else {
      robot_ = robot_of(robot);
    }
    config_.exploration.oscillation_frames = oscillation_frames;
    config_.exploration.good_enough = good_enough;
    take(config_.exploration.validate());
    planner_.emplace(
        make_planner(config_, config_.camera, regions_to_look_at(regions, map_.snapshot(), config_.strategy)));
  }

  py::dict scan(const py::object& poses, py::object progress) {
    const std::vector<Pose> T_world_camera = to_poses(poses);
    run_ = {};
    work(std::move(progress), [&](Explorer& explorer) -> Status {
      SACCADE_TRY(run_.scan, explorer.scan(T_world_camera));
      return {};
    });
    return to_dict(run_.scan);
  }

  py::dict explore(int max_views, py::object progress) {
    ExplorerConfig wanted = config_.exploration;
    wanted.max_views = max_views;
    take(wanted.validate());
    config_.exploration = wanted;
    work(std::move(progress), [&](Explorer& explorer) -> Status {
      SACCADE_TRY(run_, explorer.explore(*planner_, run_));
      return {};
    });
    return to_dict(run_);
  }

  [[nodiscard]] py::dict record() const { return to_dict(run_); }
  [[nodiscard]] py::object joints() const {
    const std::optional<Configuration> q = robot().configuration();
    if (!q) return py::none();
    return adopt(std::vector<double>(q->begin(), q->end()), {q->size()});
  }

 private:
  /// Puts the camera into the arm's hand: the arm is masked in its frames.
  void hold(const OwnArm& arm) {
    std::unique_ptr<PlannedArm> planned = arm.in(map_.snapshot().config);
    const ArmModel* model = &planned->arm();
    held_.emplace(take(MaskedCamera::create(std::move(camera_), std::move(planned), model, map_.executor())));
  }
  [[nodiscard]] Robot& robot() { return held_ ? held_->robot() : *robot_; }
  [[nodiscard]] const Robot& robot() const { return held_ ? held_->robot() : *robot_; }
  [[nodiscard]] Camera& camera() { return held_ ? static_cast<Camera&>(*held_) : *camera_; }

  template <class Work>
  void work(py::object progress, const Work& body) {
    CallerProgress told{std::move(progress)};
    const Status status = map_.write([&](TsdfMap& map) {
      Explorer explorer{
          {map, camera(), robot(), map_.executor(), recorder_.get(), stopping_.get(), approval(), &told.progress()},
          config_.exploration};
      return body(explorer);
    });
    told.rethrow();
    take(status);
  }

  [[nodiscard]] Approve approval() const {
    if (!approve_) return {};
    return [this](const RankedView& view) {
      const py::gil_scoped_acquire gil;
      const py::object said = approve_->get()(from_pose(view.T_world_camera), view.gain);
      if (py::isinstance<py::bool_>(said)) return said.cast<bool>() ? Approval::go : Approval::skip;
      if (py::isinstance<py::str>(said) && said.cast<std::string>() == "stop") return Approval::stop;
      throw py::value_error{"approve must return True (go), False (skip) or 'stop', not " + std::string{py::str(said)}};
    };
  }

  SharedMap map_;
  std::unique_ptr<Camera> camera_;
  std::unique_ptr<Robot> robot_;
  std::optional<MaskedCamera> held_;  ///< camera and arm combined, used instead of both
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<Stopping> stopping_;
  std::unique_ptr<Kept> approve_;
  SimulatedRunConfig config_;
  std::optional<ViewPlanner> planner_;
  RunRecord run_;
};

/// ViewPlanner without an explorer.
class OwnPlanner {
 public:
  OwnPlanner(const PinholeCamera& camera, const py::object& strategy, py::object regions, int gain_width,
             std::optional<double> min_gain, std::optional<std::vector<double>> radii_m)
      : config_{planner_config(camera, strategy, gain_width, min_gain, std::move(radii_m), 1000)},
        regions_{std::move(regions)} {}

  py::list next_views(const SharedMap& map, std::size_t count, const py::object& taken) {
    const TsdfSnapshot snapshot = map.snapshot();
    if (!planner_)
      planner_.emplace(make_planner(config_, config_.camera, regions_to_look_at(regions_, snapshot, config_.strategy)));
    Attempts attempts;
    for (const Pose& pose : to_poses(taken)) attempts.add_skipped(0, pose);
    const auto rank = [&] {
      const py::gil_scoped_release released;
      const std::scoped_lock lock{mutex_};
      PlanningScene scene{snapshot, map.executor()};
      scene.attempts = &attempts;
      return planner_->rank(scene);
    };
    const Ranking ranking = take(rank());
    py::list views;
    for (const RankedView& view : ranking.untried().first(std::min(count, ranking.untried().size()))) {
      py::dict entry;
      entry["T_world_camera"] = from_pose(view.T_world_camera);
      entry["gain"] = view.gain;
      views.append(entry);
    }
    return views;
  }

 private:
  SimulatedRunConfig config_;
  py::object regions_;
  std::mutex mutex_;  ///< callers from other threads wait
  std::optional<ViewPlanner> planner_;
};

}  // namespace

void bind_explore(py::module_& module) {
  py::class_<OwnPlanner>(module, "ViewPlanner", "Says where to look next; moves and fuses nothing.")
      .def(py::init<const PinholeCamera&, const py::object&, py::object, int, std::optional<double>,
                    std::optional<std::vector<double>>>(),
           py::arg("camera"), py::arg("strategy") = "surface", py::kw_only(), py::arg("regions") = py::none(),
           py::arg("gain_width") = 160, py::arg("min_gain") = py::none(), py::arg("radii_m") = py::none(),
           "`strategy`: a name of trial.strategies(), or a Strategy. `regions`: to look at, one after the other; the "
           "map's workspace by default. `gain_width`: pixels across of the virtual camera. `radii_m`: distances of "
           "views, metres.")
      .def("next_views", &OwnPlanner::next_views, py::arg("map"), py::arg("count") = 16, py::arg("taken") = py::list{},
           "The best views of the map as it is, at most `count`, as dicts of T_world_camera (4 x 4) and gain; empty "
           "where no view is worth taking. `taken`: poses that are not to be named again.");

  py::class_<OwnExplorer>(module, "Explorer",
                          "The loop: chooses a view, moves the camera there, looks, fuses, and begins again.")
      .def(py::init<SharedMap, const py::object&, const py::object&, const py::object&, const py::object&,
                    const py::object&, const py::object&, const py::object&, int, std::optional<double>,
                    std::optional<std::vector<double>>, int, double>(),
           py::arg("map"), py::arg("camera"), py::kw_only(), py::arg("robot") = py::none(),
           py::arg("strategy") = "surface", py::arg("regions") = py::none(), py::arg("recorder") = py::none(),
           py::arg("stopping") = py::none(), py::arg("approve") = py::none(), py::arg("gain_width") = 160,
           py::arg("min_gain") = py::none(), py::arg("radii_m") = py::none(), py::arg("oscillation_frames") = 1,
           py::arg("good_enough") = 1.0,
           "`camera`: an object with `intrinsics` and capture(T_world_camera) -> depth, (depth, color) or (depth, "
           "color, T_world_camera). `robot`: move_to(T_world_camera) -> pose, True, False or None, and where it is "
           "there reachable(N x 4 x 4) -> N bools; None: the camera flies; or an Arm. `recorder`: scanned(scan, map), "
           "viewed(view, map, depth_images), ended(run). `stopping(run)`: true ends the run. "
           "`approve(T_world_camera, gain)`: True, False or 'stop'. `oscillation_frames`: frames at each view, tilted "
           "by up to 5 degrees; 1: one.")
      .def("scan", &OwnExplorer::scan, py::arg("T_world_camera"), py::arg("progress") = py::none(),
           "Looks from each pose (N x 4 x 4) that can be reached, and fuses. Begins a new run.")
      .def("explore", &OwnExplorer::explore, py::arg("max_views") = 12, py::arg("progress") = py::none(),
           "Goes on until nothing is worth another view, or `max_views` were taken in all. Returns the run's record.")
      .def_property_readonly("q", &OwnExplorer::joints, "How the arm's joints stand; None for robots that are no Arm.")
      .def_property_readonly("run", &OwnExplorer::record, "The record so far: scan, views, final, stopped_because.");
}

}  // namespace saccade::python

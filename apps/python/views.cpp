// SPDX-License-Identifier: Apache-2.0
#include "map.hpp"
#include "saccade/views/view_gain.hpp"
#include "saccade/views/view_sphere.hpp"

namespace saccade::python {
namespace {

py::array_t<double> sphere(const py::object& center, const std::vector<double>& radii_m, double longitude_step_deg,
                           double latitude_step_deg, double roll_step_deg, double latitude_min_deg,
                           double latitude_max_deg) {
  ViewSphereConfig config;
  config.radii_m = radii_m;
  config.longitude_step_rad = to_rad(longitude_step_deg);
  config.latitude_step_rad = to_rad(latitude_step_deg);
  config.roll_step_rad = to_rad(roll_step_deg);
  config.latitude_min_rad = to_rad(latitude_min_deg);
  config.latitude_max_rad = to_rad(latitude_max_deg);
  return from_poses(poses_of(take(view_sphere(to_point(center), config))));
}

GainCount count_of(const std::string& name) {
  const std::optional<GainCount> count = kGainCountNames.find(name);
  if (!count) throw py::value_error{"count must be " + kGainCountNames.listed() + ", not " + name};
  return *count;
}

py::array_t<std::uint64_t> gains(const SharedMap& map, const py::object& region, const py::object& poses,
                                 const PinholeCamera& camera, double tilt_deg, const std::string& count,
                                 py::object progress) {
  GainConfig config;
  config.sensor = camera;
  config.tilt_rad = to_rad(tilt_deg);
  config.count = count_of(count);
  const Region bounds = to_region(region);
  const std::vector<Pose> T_world_camera = to_poses(poses);
  const TsdfSnapshot snapshot = map.snapshot();
  CallerProgress told{std::move(progress)};
  const auto evaluate = [&] {
    const py::gil_scoped_release released;
    return evaluate_views(snapshot, bounds, T_world_camera, config, map.executor(), told.progress());
  };
  auto result = evaluate();
  told.rethrow();
  const auto size = static_cast<py::ssize_t>(T_world_camera.size());
  return adopt(std::move(take(std::move(result)).gains), {size});
}

}  // namespace

void bind_views(py::module_& module) {
  module.def("view_sphere", &sphere, py::arg("center"), py::kw_only(), py::arg("radii_m") = std::vector<double>{0.8},
             py::arg("longitude_step_deg") = 30.0, py::arg("latitude_step_deg") = 10.0, py::arg("roll_step_deg") = 45.0,
             py::arg("latitude_min_deg") = 0.0, py::arg("latitude_max_deg") = 90.0,
             "T_world_camera, N x 4 x 4, of views around `center` that look at it; 960 by default (thesis 2.2.3).");
  module.def("view_gains", &gains, py::arg("map"), py::arg("region"), py::arg("T_world_camera"), py::arg("camera"),
             py::kw_only(), py::arg("tilt_deg") = 0.0, py::arg("count") = "rays", py::arg("progress") = py::none(),
             "uint64, one for each pose (N x 4 x 4): rays of the camera whose first voxel that is not empty is unknown "
             "and inside the region; with count='voxels' those voxels, each once. `progress(stage, done, total)`.");
}

}  // namespace saccade::python

// SPDX-License-Identifier: Apache-2.0
// The depth filter for a Kinect v2.
#include "arrays.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"

namespace saccade::python {
namespace {

py::tuple filter_depth(const PinholeCamera& camera, const py::array& depth, const std::string& method,
                       double baseline_m, const std::string& emitter_side, double veil_angle_deg, bool shadow_points,
                       bool veil_points, std::size_t threads) {
  DepthFilterConfig config;
  config.method = value_of(kDepthFilterMethodNames, method, "method");
  config.emitter_side = value_of(kEmitterSideNames, emitter_side, "emitter_side");
  config.baseline_m = baseline_m;
  config.veil_angle_rad = to_rad(veil_angle_deg);
  config.remove_shadow_points = shadow_points;
  config.remove_veil_points = veil_points;
  const DepthFilter filter = take(DepthFilter::create(camera, config));
  const DepthImage image = to_depth(depth);
  auto filtered = [&] {
    const py::gil_scoped_release released;
    return filter.filter(image, Executor::with_threads(threads));
  }();
  const FilteredDepth result = take(std::move(filtered));
  std::vector<std::uint8_t> pixels;
  pixels.reserve(result.pixels.size());
  for (const FilteredPixel pixel : result.pixels.pixels()) pixels.push_back(static_cast<std::uint8_t>(pixel));
  return py::make_tuple(from_depth(result.depth),
                        adopt(std::move(pixels), {result.depth.height(), result.depth.width()}));
}

}  // namespace

void bind_filter(py::module_& module) {
  const DepthFilterConfig config;
  module.def(
      "filter_kinect_v2", &filter_depth, py::arg("camera"), py::arg("depth"), py::kw_only(),
      py::arg("method") = "surface", py::arg("baseline_m") = config.baseline_m, py::arg("emitter_side") = "left",
      py::arg("veil_angle_deg") = 10.0, py::arg("shadow_points") = true, py::arg("veil_points") = true,
      py::arg("threads") = 0,
      "Removes the wrong points of a Kinect v2's depth image, H x W as of TsdfMap.integrate (thesis 3.1.3). "
      "`method`: surface (keeps what lies on a surface) or thesis (Algorithm 5, eq. 3.19). `baseline_m`: from "
      "the camera to the emitter, which is on the `emitter_side` left or right of the image. Returns the depth, "
      "H x W float32 with 0 where a point was removed, and what each pixel is, H x W uint8: 0 no return, 1 kept, "
      "2 shadow point, 3 veil point.");
}

}  // namespace saccade::python

// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "convert.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade::python {
namespace {

PinholeCamera make_camera(int width, int height, double fx, double fy, std::optional<double> cx,
                          std::optional<double> cy, double min_range_m, double max_range_m) {
  const PinholeCamera camera{
      width, height, fx, fy, cx.value_or(0.5 * (width - 1)), cy.value_or(0.5 * (height - 1)), min_range_m, max_range_m};
  take(camera.validate());
  return camera;
}

std::string text_of(const PinholeCamera& c) {
  return py::str("PinholeCamera({}, {}, fx={}, fy={}, cx={}, cy={}, min_range_m={}, max_range_m={})")
      .format(c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.min_range_m, c.max_range_m);
}

}  // namespace

void bind_sensor(py::module_& module) {
  py::class_<PinholeCamera>(
      module, "PinholeCamera",
      "An undistorted camera: x right, y down, z forward; pixel (u, v) has its centre at integers.")
      .def(py::init(&make_camera), py::arg("width"), py::arg("height"), py::kw_only(), py::arg("fx"), py::arg("fy"),
           py::arg("cx") = py::none(), py::arg("cy") = py::none(), py::arg("min_range_m") = 0.4,
           py::arg("max_range_m") = 6.0,
           "Focal lengths and centre in pixels; the centre defaults to that of the image. Returns outside the range, "
           "metres along z, are not trusted.")
      .def_readonly("width", &PinholeCamera::width)
      .def_readonly("height", &PinholeCamera::height)
      .def_readonly("fx", &PinholeCamera::fx)
      .def_readonly("fy", &PinholeCamera::fy)
      .def_readonly("cx", &PinholeCamera::cx)
      .def_readonly("cy", &PinholeCamera::cy)
      .def_readonly("min_range_m", &PinholeCamera::min_range_m)
      .def_readonly("max_range_m", &PinholeCamera::max_range_m)
      .def(
          "scaled_to_width",
          [](const PinholeCamera& camera, int width) {
            if (width < 1) throw py::value_error{"width must be one pixel at least, not " + std::to_string(width)};
            PinholeCamera flat = camera;
            flat.width = width;
            take(flat.validate());  // before the height is computed from it
            const PinholeCamera scaled = camera.scaled_to_width(width);
            take(scaled.validate());
            return scaled;
          },
          py::arg("width"), "The camera with `width` pixels across; field of view and range stay.")
      .def("__eq__", [](const PinholeCamera& a, const PinholeCamera& b) { return a == b; })
      .def("__repr__", &text_of);

  py::class_<Box>(module, "Box", "Axis-aligned box in the world frame, metres; contains p where min <= p < max.")
      .def(py::init([](const py::object& min, const py::object& max) {
             return Box{to_point(min), to_point(max)};
           }),
           py::arg("min"), py::arg("max"))
      .def_property_readonly("min", [](const Box& box) { return from_point(box.min); })
      .def_property_readonly("max", [](const Box& box) { return from_point(box.max); });
  py::class_<Sphere>(module, "Sphere", "Ball in the world frame, metres.")
      .def(py::init([](const py::object& center, double radius_m) {
             return Sphere{to_point(center), radius_m};
           }),
           py::arg("center"), py::arg("radius_m"))
      .def_property_readonly("center", [](const Sphere& sphere) { return from_point(sphere.center); })
      .def_readonly("radius_m", &Sphere::radius_m);
  py::class_<Cylinder>(module, "Cylinder", "Solid cylinder around the segment base to top, metres.")
      .def(py::init([](const py::object& base, const py::object& top, double radius_m) {
             return Cylinder{to_point(base), to_point(top), radius_m};
           }),
           py::arg("base"), py::arg("top"), py::arg("radius_m"));

  module.def(
      "look_at",
      [](const py::object& position, const py::object& target, const py::object& up, double roll_rad) {
        const Eigen::Vector3d from = to_point(position);
        const Eigen::Vector3d to = to_point(target);
        const Eigen::Vector3d above = to_point(up);
        if (!(from.allFinite() && to.allFinite() && above.allFinite() && std::isfinite(roll_rad))) {
          throw py::value_error{"position, target, up and roll_rad must be finite"};
        }
        if (from == to) throw py::value_error{"position and target are the same point: the camera looks nowhere"};
        return from_pose(look_at(from, to, above, roll_rad));
      },
      py::arg("position"), py::arg("target"), py::arg("up") = py::make_tuple(0.0, 0.0, 1.0), py::arg("roll_rad") = 0.0,
      "T_world_camera, 4 x 4, of a camera at `position` whose optical axis points at `target`.");
}

}  // namespace saccade::python

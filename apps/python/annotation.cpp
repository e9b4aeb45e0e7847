// SPDX-License-Identifier: Apache-2.0
// Annotation: labels of a cloud's points from clicks; a simulated annotator who knows the ground truth.
#include "saccade/annotate/annotation.hpp"

#include <mutex>

#include "arrays.hpp"
#include "saccade/annotate/annotation_error.hpp"
#include "saccade/annotate/selection.hpp"
#include "saccade/annotate/simulated_annotator.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade::python {
namespace {

Neighbourhood neighbourhood_of(const PointCloud& cloud, int neighbours, const Executor& executor,
                               CallerProgress& told) {
  NeighbourhoodConfig config;
  config.neighbours = neighbours;
  auto built = [&] {
    const py::gil_scoped_release released;
    return Neighbourhood::build(cloud, config, executor, told.progress());
  }();
  told.rethrow();
  return take(std::move(built));
}

std::vector<std::uint32_t> indices_of(const py::object& points) {
  const bool is_one = !py::isinstance<py::array>(points) && PyIndex_Check(points.ptr()) != 0;
  std::vector<std::uint32_t> indices;
  for (const double index : is_one ? std::vector{py::float_{points}.cast<double>()} : to_numbers(points, "points")) {
    if (!(index >= 0.0 && index < 4294967295.0 && index == std::floor(index))) {
      throw py::value_error{"points must be indices, not " + std::to_string(index)};
    }
    indices.push_back(static_cast<std::uint32_t>(index));
  }
  return indices;
}

/// Maps the world to the clip coordinates of the picture that a pinhole camera takes. What is nearer than 1 mm is not
/// in view.
Eigen::Matrix4d clip_of(const PinholeCamera& camera, const Pose& T_world_camera) {
  constexpr double kNear_m{0.001};
  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  clip.row(0) << 2.0 * camera.fx / camera.width, 0.0, (2.0 * camera.cx + 1.0) / camera.width - 1.0, 0.0;
  clip.row(1) << 0.0, -2.0 * camera.fy / camera.height, 1.0 - (2.0 * camera.cy + 1.0) / camera.height, 0.0;
  clip.row(2) << 0.0, 0.0, 1.0, -2.0 * kNear_m;
  clip.row(3) << 0.0, 0.0, 1.0, 0.0;
  return clip * T_world_camera.inverse().matrix();
}

std::vector<ScreenPoint> screen_points(const py::object& pixels, const char* name) {
  std::vector<ScreenPoint> points;
  for (const auto& row : pixels) {
    const std::vector<double> pixel = to_numbers(py::reinterpret_borrow<py::object>(row), name);
    if (pixel.size() != 2) throw py::value_error{std::string{name} + " must be pixels (u, v)"};
    points.emplace_back(pixel[0], pixel[1]);
  }
  return points;
}

/// The one shape that is not None.
ScreenShape screen_shape(const py::object& rectangle, const py::object& polygon, const py::object& stroke,
                         double radius_px) {
  const int given = static_cast<int>(!rectangle.is_none()) + static_cast<int>(!polygon.is_none()) +
                    static_cast<int>(!stroke.is_none());
  if (given != 1) throw py::value_error{"give one of rectangle, polygon and stroke"};
  if (!polygon.is_none()) return ScreenPolygon{screen_points(polygon, "polygon")};
  if (!stroke.is_none()) return ScreenStroke{screen_points(stroke, "stroke"), radius_px};
  const std::vector<ScreenPoint> corners = screen_points(rectangle, "rectangle");
  if (corners.size() != 2) throw py::value_error{"rectangle must be two opposite corners ((u, v), (u, v))"};
  return ScreenRectangle{corners[0], corners[1]};
}

/// Annotation of one client. Python threads may call it concurrently: they wait for each other.
class PythonAnnotation {
 public:
  PythonAnnotation(const py::object& points, const py::object& normals, const py::object& colors, int neighbours,
                   std::size_t threads, py::object progress)
      : executor_{Executor::with_threads(threads)} {
    CallerProgress told{std::move(progress)};
    PointCloud cloud = to_cloud(points, normals, colors, py::none());
    if (cloud.positions_m.empty()) throw py::value_error{"points is empty"};
    annotation_.emplace(std::make_shared<Neighbourhood>(neighbourhood_of(cloud, neighbours, executor_, told)),
                        executor_);
    positions_m_ = std::move(cloud.positions_m);
    offset_m_ = cloud.offset_m;
  }

  /// Place of the origin that the annotation works in, in the points' coordinates.
  [[nodiscard]] const Eigen::Vector3d& offset_m() const { return offset_m_; }

  [[nodiscard]] std::vector<std::uint32_t> select(const SelectionView& view, const ScreenShape& shape,
                                                  double below_m) const {
    const auto find = [&] {
      const py::gil_scoped_release released;
      return select_points(positions_m_, view, shape, below_m, executor_);
    };
    return take(find());
  }

  /// Applies a change. Returns the number of points with a new label; −1: there was nothing to do.
  std::int64_t change(AnnotationChange change) {
    const auto apply = [&]() -> Result<std::int64_t> {
      const py::gil_scoped_release released;
      const std::scoped_lock lock{mutex_};
      AnnotationAction action{0, std::move(change)};
      SACCADE_CHECK(annotation_->validate(action));
      const Applied applied = annotation_->apply(std::move(action));
      return applied.done ? static_cast<std::int64_t>(applied.points.size()) : std::int64_t{-1};
    };
    return take(apply());
  }

  /// Calls body(const Annotation&) without the GIL, with changes blocked.
  template <class Body>
  auto read(const Body& body) const {
    const py::gil_scoped_release released;
    const std::scoped_lock lock{mutex_};
    return body(*annotation_);
  }

 private:
  mutable std::mutex mutex_;
  Executor executor_;
  std::optional<Annotation> annotation_;
  std::vector<Eigen::Vector3f> positions_m_;
  Eigen::Vector3d offset_m_{Eigen::Vector3d::Zero()};
};

py::array_t<std::uint32_t> select_in_picture(const PythonAnnotation& annotation, const PinholeCamera& camera,
                                             const py::array& T_world_camera, const py::object& rectangle,
                                             const py::object& polygon, const py::object& stroke, double radius_px,
                                             double below_m, int point_size_px) {
  take(camera.validate());
  Pose T_cloud_camera = to_pose(T_world_camera);
  T_cloud_camera.translation() -= annotation.offset_m();
  const SelectionView view{clip_of(camera, T_cloud_camera), camera.width, camera.height, point_size_px};
  std::vector<std::uint32_t> found =
      annotation.select(view, screen_shape(rectangle, polygon, stroke, radius_px), below_m);
  const auto count = static_cast<py::ssize_t>(found.size());
  return adopt(std::move(found), {count});
}

py::array_t<std::uint32_t> labels_of(const PythonAnnotation& annotation) {
  std::vector<std::uint32_t> labels = annotation.read([](const Annotation& state) {
    return std::vector<std::uint32_t>{state.labels().begin(), state.labels().end()};
  });
  const auto count = static_cast<py::ssize_t>(labels.size());
  return adopt(std::move(labels), {count});
}

py::dict control_points_of(const PythonAnnotation& annotation) {
  py::dict result;
  for (const ControlPoint& control : annotation.read([](const Annotation& a) { return a.control_points(); })) {
    result[py::cast(control.point)] = control.label;
  }
  return result;
}

py::list simulate(const py::object& points, const py::object& truth, const py::object& normals,
                  const py::object& colors, std::size_t clicks, int neighbours, std::size_t threads,
                  py::object progress) {
  CallerProgress told{std::move(progress)};
  const PointCloud cloud = to_cloud(points, normals, colors, py::none());
  std::vector<std::uint32_t> labels = to_labels(truth, "truth");
  for (std::uint32_t& label : labels) label = label == kUnlabelled ? kNoLabel : label;
  const Executor executor = Executor::with_threads(threads);
  auto graph = std::make_shared<Neighbourhood>(neighbourhood_of(cloud, neighbours, executor, told));
  SimulatedAnnotator annotator = take(SimulatedAnnotator::create(std::move(graph), cloud, std::move(labels)));
  py::list result;
  while (result.size() < clicks) {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set{};
    const auto click = [&] {
      const py::gil_scoped_release released;
      return annotator.next();
    }();
    if (!click) break;
    py::dict made;
    made["point"] = click->point;
    made["label"] = click->label;
    made["wrong"] = click->score.wrong;
    made["mean_iou"] = click->score.mean_iou;
    result.append(made);
  }
  return result;
}

}  // namespace

void bind_annotation(py::module_& module) {
  py::class_<PythonAnnotation>(module, "Annotation",
                               "Labels of a cloud's points, which spread from clicks along surfaces (thesis 4.2).")
      .def(py::init<const py::object&, const py::object&, const py::object&, int, std::size_t, py::object>(),
           py::arg("points"), py::kw_only(), py::arg("normals") = py::none(), py::arg("colors") = py::none(),
           py::arg("neighbours") = NeighbourhoodConfig{}.neighbours, py::arg("threads") = 0,
           py::arg("progress") = py::none(),
           "`points`: N x 3 metres; `normals`: N x 3, else estimated; `colors`: N x 3, uint8 or floats in [0, 1]. "
           "Labels "
           "are whole numbers from 1; 0: none.")
      .def(
          "click",
          [](PythonAnnotation& annotation, const py::object& points, std::uint32_t label) {
            return annotation.change(SetControlPoints{indices_of(points), label, 0.0});
          },
          py::arg("points"), py::arg("label"),
          "Makes a point, by its index, or several, control points of a label. Returns the number of points with "
          "another label than before, as do the other actions.")
      .def(
          "remove",
          [](PythonAnnotation& annotation, const py::object& points) {
            return annotation.change(RemoveControlPoints{indices_of(points)});
          },
          py::arg("points"), "Makes points control points no more.")
      .def(
          "paint",
          [](PythonAnnotation& annotation, const py::object& points, std::uint32_t label) {
            return annotation.change(PaintPoints{indices_of(points), label});
          },
          py::arg("points"), py::arg("label"),
          "Gives these points, by their indices, a label whatever spreads to them; 0: they follow clicks again.")
      .def(
          "select", &select_in_picture, py::arg("camera"), py::arg("T_world_camera"), py::kw_only(),
          py::arg("rectangle") = py::none(), py::arg("polygon") = py::none(), py::arg("stroke") = py::none(),
          py::arg("radius_px") = 10.0, py::arg("below_m") = kOnSurface_m,
          py::arg("point_size_px") = SelectionView{}.point_size_px,
          "Finds the points that a shape contains in the picture of a camera (thesis 4.2.2). `rectangle`: two opposite "
          "corners; `polygon`: corners of a lasso; `stroke`: a line, `radius_px` wide to either side; each in pixels "
          "(u, v). `below_m`: metres behind what is seen that are still taken, 0: the surface that is seen, inf: "
          "however "
          "deep. `point_size_px`: edge of a drawn point. Returns indices, uint32, ascending, for click and paint.")
      .def(
          "undo", [](PythonAnnotation& annotation) { return annotation.change(UndoAction{}); },
          "Takes back the latest action. -1: there is none.")
      .def(
          "redo", [](PythonAnnotation& annotation) { return annotation.change(RedoAction{}); },
          "Brings back what was undone last. -1: there is nothing.")
      .def("labels", &labels_of, "N uint32; 0: none.")
      .def_property_readonly("control_points", &control_points_of, "dict from a point's index to its label.")
      .def_property_readonly(
          "counts",
          [](const PythonAnnotation& annotation) {
            return annotation.read([](const Annotation& a) { return a.counts(); });
          },
          "dict from a label to the number of its points.")
      .def("__len__", [](const PythonAnnotation& annotation) {
        return annotation.read([](const Annotation& a) { return a.labels().size(); });
      });
  module.def(
      "annotation_score",
      [](const py::object& labels, const py::object& truth) {
        auto given = to_labels(labels, "labels");
        auto right = to_labels(truth, "truth");
        for (std::uint32_t& label : given) label = label == kUnlabelled ? kNoLabel : label;
        for (std::uint32_t& label : right) label = label == kUnlabelled ? kNoLabel : label;
        const AnnotationScore score = take(score_annotation(given, right));
        py::dict result;
        result["points"] = score.points;
        result["wrong"] = score.wrong;
        result["mean_iou"] = score.mean_iou;
        return result;
      },
      py::arg("labels"), py::arg("truth"),
      "Compares labels with true ones, N whole numbers each, 0 in truth: the point does not count. Returns a dict: "
      "points that count, wrong ones, mean_iou over the labels.");
  module.def("simulate_annotation", &simulate, py::arg("points"), py::arg("truth"), py::kw_only(),
             py::arg("normals") = py::none(), py::arg("colors") = py::none(), py::arg("clicks") = 20,
             py::arg("neighbours") = NeighbourhoodConfig{}.neighbours, py::arg("threads") = 0,
             py::arg("progress") = py::none(),
             "Clicks as someone who knows the true labels, N whole numbers, 0: does not matter: each at the centre of "
             "the largest region that is wrong. Returns a list of dicts, one a click: point, label, and with it wrong "
             "(points) and mean_iou.");
}

}  // namespace saccade::python

// SPDX-License-Identifier: Apache-2.0
// SurfelMap: coloured discs from frames with poses, as averages or as winning modes.
#include <mutex>

#include "arrays.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/io/clouds/surfel_cloud.hpp"
#include "saccade/surfel/exposure_compensation.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "saccade/surfel/surfel_points.hpp"

namespace saccade::python {
namespace {

/// Choices as named by saccade surfels.
enum class SurfelChoice { sharpened, densest, heaviest };
constexpr auto kSurfelChoiceNames = make_names<SurfelChoice>(
    {{SurfelChoice::sharpened, "sharpened"}, {SurfelChoice::densest, "densest"}, {SurfelChoice::heaviest, "heaviest"}});

/// Fusion and mode filter of one sequence of frames. Python threads may call it concurrently: they wait for each other.
class PythonSurfels {
 public:
  PythonSurfels(bool mode_filter, const std::string& choice, int max_modes, double image_sigma,
                bool exposure_compensation, std::size_t threads)
      : executor_{Executor::with_threads(threads)} {
    SurfelFusionConfig fusion;
    fusion.image_sigma = image_sigma;
    fusion_ = take(SurfelFusion::create(fusion));
    const SurfelChoice chosen = value_of(kSurfelChoiceNames, choice, "choice");
    ModeFilterConfig filter;
    filter.max_modes = max_modes;
    filter.enhance_depth = chosen == SurfelChoice::heaviest;
    if (chosen != SurfelChoice::sharpened) filter.sharpening.strength = 0.0;
    if (chosen == SurfelChoice::heaviest) filter.choice_sigmas = 0.0;
    at_averages_ = chosen != SurfelChoice::heaviest;
    if (mode_filter) filter_ = take(ModeFilter::create(filter));
    if (exposure_compensation) exposure_ = take(ExposureCompensation::create());
  }

  py::dict integrate(const PinholeCamera& camera, const py::array& depth, const py::array& T_world_camera,
                     const std::optional<py::array>& color) {
    Frame frame;
    frame.depth = to_depth(depth);
    frame.T_world_camera = to_pose(T_world_camera);
    if (color) frame.color = to_color(*color);
    const auto add = [&]() -> Result<SurfelFusionReport> {
      const py::gil_scoped_release released;
      const std::scoped_lock lock{mutex_};
      SACCADE_TRY(const SurfelFusionReport report, exposure_ ? fusion_->add_frame(frame, camera, *exposure_, executor_)
                                                             : fusion_->add_frame(frame, camera, executor_));
      if (!filter_) return report;
      SACCADE_TRY(const ModeFilterReport filtered, filter_->add_frame(frame, fusion_->association(), executor_));
      static_cast<void>(filtered);
      return report;
    };
    const SurfelFusionReport report = take(add());
    py::dict result;
    result["points"] = report.points;
    result["associated"] = report.associated;
    result["created"] = report.created;
    result["contradicted"] = report.contradicted;
    result["gain"] = report.exposure ? py::cast(report.exposure->gain) : py::none();
    return result;
  }

  [[nodiscard]] std::size_t size() const {
    const std::scoped_lock lock{mutex_};
    return fusion_->map().size();
  }

  [[nodiscard]] py::dict points(double min_confidence, bool averages) const {
    SurfelPoints made;
    {
      const py::gil_scoped_release released;
      const std::scoped_lock lock{mutex_};
      made = surfel_points(fusion_->map(), winners(averages), min_confidence);
    }
    const auto count = static_cast<py::ssize_t>(made.size());
    py::dict result;
    result["points"] = from_vectors(made.positions_m);
    result["normals"] = from_vectors(made.normals);
    result["colors"] = made.has_color ? py::object{from_colors(made.colors)} : py::none();
    result["radii"] = adopt(std::move(made.radii_m), {count});
    result["confidences"] = adopt(std::move(made.weights), {count});
    return result;
  }

  void save(const std::string& path, double min_confidence, bool averages) const {
    const auto write = [&]() -> Status {
      const py::gil_scoped_release released;
      const std::scoped_lock lock{mutex_};
      return write_surfel_cloud(path, fusion_->map(), winners(averages), min_confidence);
    };
    take(write());
  }

 private:
  /// Returns the modes that represent the surfels; empty for averages.
  [[nodiscard]] std::vector<SurfelMode> winners(bool averages) const {
    if (!filter_ || averages) return {};
    std::vector<SurfelMode> modes = filter_->winners(executor_);
    if (at_averages_) put_at_averages(modes, fusion_->map());
    return modes;
  }

  mutable std::mutex mutex_;
  Executor executor_;
  std::optional<SurfelFusion> fusion_;
  std::optional<ModeFilter> filter_;
  std::optional<ExposureCompensation> exposure_;
  bool at_averages_{true};
};

py::array_t<float> guided_filter(const py::array& depth, const py::array& guide_depth, const py::array& guide_color,
                                 int radius_px, double color_sigma, double depth_sigma_m, std::size_t threads) {
  const GuidedFilterConfig config{radius_px, color_sigma, depth_sigma_m};
  take(config.validate());
  const DepthImage measured = to_depth(depth);
  const DepthImage guide = to_depth(guide_depth);
  const ColorImage color = to_color(guide_color);
  const auto fits = [&](const auto& image) {
    return image.width() == measured.width() && image.height() == measured.height();
  };
  if (!fits(guide) || !fits(color)) throw py::value_error{"depth, guide_depth and guide_color differ in size"};
  DepthImage enhanced{measured.width(), measured.height()};
  {
    const py::gil_scoped_release released;
    std::vector<Eigen::Vector4f> guidance(measured.size());
    std::vector<std::uint8_t> used(measured.size());
    for (std::size_t i = 0; i < measured.size(); ++i) {
      const float d = guide.pixels()[i];
      used[i] = std::isfinite(d) && d > 0.0F && std::isfinite(measured.pixels()[i]) && measured.pixels()[i] > 0.0F;
      const Rgb8& c = color.pixels()[i];
      guidance[i] = {float(c[0]) / 255.0F, float(c[1]) / 255.0F, float(c[2]) / 255.0F, d};
    }
    GuidedFilter{config}.apply(measured.width(), measured.height(), measured.pixels(), guidance, used,
                               Executor::with_threads(threads), {enhanced.data(), enhanced.size()});
  }
  return from_depth(enhanced);
}

}  // namespace

void bind_surfels(py::module_& module) {
  const GuidedFilterConfig guided;
  py::class_<PythonSurfels>(module, "SurfelMap",
                            "Small coloured discs on surfaces, from frames with poses (thesis 4.1.1). World frame, "
                            "metres.")
      .def(py::init<bool, const std::string&, int, double, bool, std::size_t>(), py::kw_only(),
           py::arg("mode_filter") = true, py::arg("choice") = "sharpened",
           py::arg("max_modes") = ModeFilterConfig{}.max_modes,
           py::arg("image_sigma") = SurfelFusionConfig{}.image_sigma, py::arg("exposure_compensation") = false,
           py::arg("threads") = 0,
           "`mode_filter`: of each surfel's colours one that was seen, not a blend; it needs frames with colour. "
           "`choice`: sharpened, densest, or heaviest (thesis, eq. 4.11, with depths guided by colour). "
           "`exposure_compensation`: colours of each frame are brought to the exposure of the first; `threads`: 0 for "
           "all cores.")
      .def("integrate", &PythonSurfels::integrate, py::arg("camera"), py::arg("depth"), py::arg("T_world_camera"),
           py::arg("color") = py::none(),
           "Fuses a frame; arrays as of TsdfMap.integrate. Returns a dict: points (pixels that count), associated, "
           "created, contradicted, gain (of the exposure, or None).")
      .def("__len__", &PythonSurfels::size)
      .def(
          "points", &PythonSurfels::points, py::kw_only(), py::arg("min_confidence") = 0.0, py::arg("averages") = false,
          "Surfels of at least that confidence, as a dict: points N x 3 and normals N x 3 float32; colors N x 3 uint8, "
          "or None; radii N float32, metres; confidences N float32. `averages`: without the mode filter.")
      .def("save", &PythonSurfels::save, py::arg("path"), py::kw_only(), py::arg("min_confidence") = 0.0,
           py::arg("averages") = false, "Writes these surfels: PLY for a name that ends in .ply, else PCD.");
  module.def(
      "guided_filter", &guided_filter, py::arg("depth"), py::arg("guide_depth"), py::arg("guide_color"), py::kw_only(),
      py::arg("radius_px") = guided.radius_px, py::arg("color_sigma") = guided.color_sigma,
      py::arg("depth_sigma_m") = guided.depth_sigma_m, py::arg("threads") = 0,
      "Smooths a depth image where its guide, depth H x W metres and colour H x W x 3 uint8, is smooth, and keeps "
      "the guide's edges (thesis, Algorithm 7). Returns H x W float32; pixels without depth or guide stay.");
}

}  // namespace saccade::python

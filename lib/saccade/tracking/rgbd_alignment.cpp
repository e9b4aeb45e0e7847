// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/rgbd_alignment.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <vector>

#include "saccade/tracking/internal/align_loop.hpp"
#include "saccade/tracking/internal/color_alignment.hpp"

namespace saccade {
namespace {

constexpr double kLargestGain{4.0};

/// Grey images at strides 1, 2, 4, …
std::vector<Image<float>> pyramid(const Image<float>& grey, int coarsest_stride, const Executor& executor) {
  std::vector<Image<float>> levels{grey};
  for (int stride = 2; stride <= coarsest_stride; stride *= 2) levels.push_back(halved(levels.back(), executor));
  return levels;
}

const Image<float>& at_stride(const std::vector<Image<float>>& levels, int stride) {
  return levels[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(stride)))];
}

int coarsest_stride(const IcpConfig& config) { return *std::max_element(config.strides.begin(), config.strides.end()); }

/// Both terms of one frame.
class RgbdEquations {
 public:
  RgbdEquations(const GreyPoints& measured, const GreyPoints& model, const PinholeCamera& camera,
                const Executor& executor, const RgbdConfig& config)
      : measured_{measured},
        model_{model},
        camera_{camera},
        executor_{executor},
        config_{config},
        far_{model.points, camera, {config.far.max_distance_m, config.far.max_normal_angle_rad}},
        near_{model.points, camera, {config.icp.max_distance_m, config.icp.max_normal_angle_rad}} {
    if (measured.grey.empty() || model.grey.empty() || !(config.color_weight > 0.0)) return;
    const int coarsest = std::max(coarsest_stride(config.far), config.finest_color_stride);
    measured_grey_ = pyramid(measured.grey, coarsest, executor);
    model_grey_ = pyramid(model.grey, coarsest, executor);
  }

  /// The steps that follow are those of RgbdConfig::icp. They compare grey values without what varies slowly over the
  /// image: with it, vignetting would draw the camera aside.
  void come_near() {
    geometry_ = &near_;
    weight_ = config_.color_weight;
    stride_ = color_stride_ = 0;
    result_.gain = 1.0;
    colors_.reset();
    if (measured_grey_.empty()) return;
    const int coarsest = std::max(coarsest_stride(config_.icp), config_.finest_color_stride);
    measured_grey_ = pyramid(flattened(measured_.grey, executor_), coarsest, executor_);
    model_grey_ = pyramid(flattened(model_.grey, executor_), coarsest, executor_);
  }

  [[nodiscard]] NormalEquations linearize(const Pose& T_model_camera, int stride) {
    if (stride != stride_) set_stride(stride);
    NormalEquations sums = geometry_->linearize(T_model_camera, *level_, executor_);
    if (!colors_) return sums;
    const ColorEquations color = colors_->linearize(T_model_camera, result_.gain, config_.color_sigma, executor_);
    result_.used_color =
        static_cast<double>(color.pairs * scale_) > config_.min_color_overlap * static_cast<double>(sums.pairs);
    if (!result_.used_color) return sums;
    result_.color_agreement = static_cast<double>(color.agreeing) / static_cast<double>(color.pairs);
    if (color.measured > 0.0) {
      result_.gain = std::clamp(color.reference / color.measured, 1.0 / kLargestGain, kLargestGain);
    }
    const double weight = weight_ * static_cast<double>(scale_);
    sums.JtJ += weight * color.sums.JtJ;
    sums.Jtr += weight * color.sums.Jtr;
    return sums;
  }

  [[nodiscard]] const RgbdResult& result() const { return result_; }

 private:
  void set_stride(int stride) {
    stride_ = stride;
    level_.emplace(measured_.points, stride);
    if (measured_grey_.empty()) return;
    const int color_stride = std::max(stride, config_.finest_color_stride);
    scale_ = static_cast<std::size_t>((color_stride / stride) * (color_stride / stride));
    if (colors_ && color_stride == color_stride_) return;
    color_stride_ = color_stride;
    color_points_.emplace(measured_.points, color_stride);
    colors_.emplace(color_points_->points(), at_stride(measured_grey_, color_stride), model_.points.z,
                    at_stride(model_grey_, color_stride), camera_, executor_);
  }

  const GreyPoints& measured_;
  const GreyPoints& model_;
  const PinholeCamera& camera_;
  const Executor& executor_;
  const RgbdConfig& config_;
  Alignment far_, near_;
  const Alignment* geometry_{&far_};
  double weight_{config_.far_color_weight};
  std::vector<Image<float>> measured_grey_, model_grey_;
  int stride_{0};
  int color_stride_{0};
  std::size_t scale_{1};  ///< points of the level for each that has a grey value
  std::optional<Level> level_, color_points_;
  std::optional<ColorLevel> colors_;
  RgbdResult result_;
};

}  // namespace

Status RgbdConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "RGB-D tracking"}; };
  for (const IcpConfig* stage : {&far, &icp}) {
    SACCADE_CHECK(stage->validate());
    for (const int stride : stage->strides) {
      if (!std::has_single_bit(static_cast<unsigned>(stride))) return fail("strides must be powers of two");
    }
  }
  if (finest_color_stride < 1 || !std::has_single_bit(static_cast<unsigned>(finest_color_stride))) {
    return fail("the stride of colours must be a power of two");
  }
  if (!(color_sigma > 0.0) || !(color_weight >= 0.0)) return fail("the noise of colours must be positive");
  return {};
}

RgbdResult align_rgbd(const GreyPoints& measured, const GreyPoints& model, const PinholeCamera& camera,
                      const Pose& T_model_camera_start, const Executor& executor, const RgbdConfig& config) {
  RgbdEquations equations{measured, model, camera, executor, config};
  const auto linearize = [&](const Pose& T_model_camera, int stride) -> Result<NormalEquations> {
    return equations.linearize(T_model_camera, stride);
  };
  const auto align_in = [&](const IcpConfig& stage, const Pose& start) {
    return align_by(linearize, measured.points, model.points, camera, start, stage).value();
  };
  const Pose T_far =
      config.looks_far ? align_in(config.far, T_model_camera_start).T_model_camera : T_model_camera_start;
  equations.come_near();
  IcpResult icp = align_in(config.icp, T_far);
  const Pose moved = T_model_camera_start.inverse() * icp.T_model_camera;
  if (icp.converged && (moved.translation().norm() > config.icp.max_translation_m ||
                        rotation_angle_rad(moved) > config.icp.max_rotation_rad)) {
    icp.converged = false;
    icp.why = "the motion found is larger than a camera makes between two frames";
  }
  RgbdResult result = equations.result();
  result.icp = icp;
  return result;
}

}  // namespace saccade

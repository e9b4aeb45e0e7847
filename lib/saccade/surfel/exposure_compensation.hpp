// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExposureCompensation: brings the colours of each frame to the exposure of the surfels that it sees.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/surfel/surfel_association.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// Parameters of ExposureCompensation. Colours are in [0, 1], as sRGB encodes them.
struct ExposureCompensationConfig {
  int step_px{4};                ///< every so many-th pixel of every so many-th row is looked at
  double darkest{0.04};          ///< of a surfel's channel: what is darker is noise
  double brightest{0.9};         ///< what is brighter may be saturated, here or in the frame
  double outlier_color{0.03};    ///< a value that differs by more counts as if it differed by so much (Huber)
  double settled_weight{100.0};  ///< w_s: so heavy a surfel counts half as much as any can
  double min_samples{100.0};     ///< equally heavy values that it takes to tell a gain,
  double min_agreement{0.3};     ///< and the share of all that must not be outliers
  double max_gain{4.0};          ///< relative to the first frame, and 1/max_gain at the lower end

  /// invalid_argument for numbers that are not positive, a range that is empty, or a largest gain of 1 or less.
  [[nodiscard]] Status validate() const;
};

/// What became of one frame.
struct ExposureReport {
  double gain{1.0};       ///< of the frame, in linear light, relative to the map
  bool estimated{false};  ///< false: too little to tell, so the gain is that of the frame before; 1 of the first
  double samples{0.0};    ///< how many equally heavy values would tell as much as those there were
  double agreement{0.0};  ///< share of their weight that is not of outliers
};

/// A camera with automatic gain gives one place several colours, and the mode filter would choose now this one, now
/// that one (thesis §4.1.3). The gain of a frame is the factor of linear light between its colours and the averages of
/// the surfels that its pixels see; the frame's colours are divided by it before they are averaged. So all have the
/// exposure of the first frame with colour.
/// Above its toe, sRGB makes of a factor g of light a factor g^(1/2.4) of (value + 0.055): that is fitted, by Huber's
/// estimator from the median on, with the weights of the averages themselves (eq. 4.2). Which surfels count is decided
/// by the surfels, not by the frame. So noise of the frame biases nothing, an estimate is where the averages stay as
/// they are, and gains do not drift.
/// Beyond what the first frame could show, nothing comes back: what is brighter than its white is white, and what is
/// saturated in a brighter frame gets the surfel's colour where that is brighter, else what white becomes.
/// One caller at a time. The thread count never changes a bit of the result.
class ExposureCompensation {
 public:
  [[nodiscard]] static Result<ExposureCompensation> create(const ExposureCompensationConfig& config = {});

  /// Estimates the gain of a frame's colours and divides them by it. O(pixels).
  /// Expects an image of the association's size.
  /// @param seen  which surfels the frame saw; those that it made itself have no colour yet.
  ExposureReport apply(const SurfelAssociation& seen, const SurfelMap& map, const Executor& executor,
                       ColorImage& color);

  [[nodiscard]] const ExposureCompensationConfig& config() const { return config_; }

 private:
  /// A channel of a pixel and of its surfel, both + 0.055.
  struct Sample {
    float frame;
    float surfel;
    float weight;
  };
  /// Of the samples, for a factor between frame and surfels.
  struct Fit {
    double weight{0.0};
    double squared_weight{0.0};
    double agreeing_weight{0.0};
    double difference{0.0};  ///< of frame and surfels, weighted, outliers cut off
    double slope{0.0};       ///< how that changes with 1 / factor
  };

  explicit ExposureCompensation(const ExposureCompensationConfig& config) : config_{config} {}
  void collect(const SurfelAssociation& seen, const SurfelMap& map, const Executor& executor, const ColorImage& color);
  void estimate(const Executor& executor, ExposureReport& report) const;
  [[nodiscard]] double median_factor(const Executor& executor) const;
  [[nodiscard]] Fit fit(double factor, const Executor& executor) const;

  ExposureCompensationConfig config_;
  double gain_{1.0};
  std::size_t frame_{0};
  std::vector<std::vector<Sample>> samples_;  ///< by rows of pixels
};

}  // namespace saccade

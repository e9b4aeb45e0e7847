// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExposureCompensation: adapts the colours of each frame to the exposure of the surfels that it sees.

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
  int step_px{4};                ///< step between the pixels used, along rows and columns
  double darkest{0.04};          ///< limit for a surfel's channel; darker values are noise
  double brightest{0.9};         ///< brighter values may be saturated, in the surfel or in the frame
  double outlier_color{0.03};    ///< larger differences count as if they were this large (Huber)
  double settled_weight{100.0};  ///< w_s: a surfel of this weight counts half as much as the heaviest
  double min_samples{100.0};     ///< equally heavy values required to estimate a gain
  double min_agreement{0.3};     ///< smallest share of the values that are not outliers
  double max_gain{4.0};          ///< relative to the first frame; the lower limit is 1/max_gain

  /// Answers invalid_argument for numbers that are not positive, an empty range, or a largest gain of 1 or less.
  [[nodiscard]] Status validate() const;
};

/// Result of compensating one frame.
struct ExposureReport {
  double gain{1.0};       ///< gain of the frame in linear light, relative to the map
  bool estimated{false};  ///< false: too few samples, so the gain is that of the previous frame, or 1 for the first
  double samples{0.0};    ///< number of equally heavy values with the same information
  double agreement{0.0};  ///< share of the samples' weight that is not outliers
};

/// A camera with automatic gain gives one place several colours, and the mode filter would choose now one, now another
/// (thesis §4.1.3). The gain of a frame is the factor in linear light between its colours and the averages of the
/// surfels that its pixels see. The frame's colours are divided by it before they are averaged, so that all frames have
/// the exposure of the first frame with colour.
/// Above its toe, sRGB turns a factor g of light into a factor g^(1/2.4) of (value + 0.055). This factor is fitted by
/// Huber's estimator, starting at the median, with the weights of the averages themselves (eq. 4.2). The surfels decide
/// which surfels count, not the frame. So noise of the frame biases nothing, an estimate leaves the averages as they
/// are, and gains do not drift.
/// Light beyond the range of the first frame is lost: anything brighter than its white is white. Pixels saturated in a
/// brighter frame get the surfel's colour where that is brighter, otherwise the value that white is divided to.
/// One caller at a time. The thread count never changes a bit of the result.
class ExposureCompensation {
 public:
  [[nodiscard]] static Result<ExposureCompensation> create(const ExposureCompensationConfig& config = {});

  /// Estimates the gain of a frame's colours and divides them by it. O(pixels).
  /// Expects an image of the association's size.
  /// @param seen  the surfels that the frame saw; those that it made itself have no colour yet.
  ExposureReport apply(const SurfelAssociation& seen, const SurfelMap& map, const Executor& executor,
                       ColorImage& color);

  [[nodiscard]] const ExposureCompensationConfig& config() const { return config_; }

 private:
  /// One channel of a pixel and of its surfel, both + 0.055.
  struct Sample {
    float frame;
    float surfel;
    float weight;
  };
  /// Sums over the samples for a factor between frame and surfels.
  struct Fit {
    double weight{0.0};
    double squared_weight{0.0};
    double agreeing_weight{0.0};
    double difference{0.0};  ///< weighted difference of frame and surfels, with outliers limited
    double slope{0.0};       ///< derivative of the difference by 1 / factor
  };

  explicit ExposureCompensation(const ExposureCompensationConfig& config) : config_{config} {}
  void collect(const SurfelAssociation& seen, const SurfelMap& map, const Executor& executor, const ColorImage& color);
  void estimate(const Executor& executor, ExposureReport& report) const;
  [[nodiscard]] double median_factor(const Executor& executor) const;
  [[nodiscard]] Fit fit(double factor, const Executor& executor) const;

  ExposureCompensationConfig config_;
  double gain_{1.0};
  std::size_t frame_{0};
  std::vector<std::vector<Sample>> samples_;  ///< one list per row of pixels
};

}  // namespace saccade

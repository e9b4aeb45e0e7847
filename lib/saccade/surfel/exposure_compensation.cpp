// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/exposure_compensation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "saccade/sensor/srgb.hpp"

namespace saccade {
namespace {

constexpr std::size_t kSampledRowsPerTask{8};
constexpr std::size_t kCorrectedRowsPerTask{32};
constexpr std::size_t kSamplesAhead{8};
constexpr int kFits{4};
constexpr std::size_t kRatioBins{1024};
constexpr float kWeightUnits{16777216.0F};
constexpr float kOffset{static_cast<float>(kSrgbOffset)};
/// Largest code that stands for one brightness; codes above may stand for any brighter light.
constexpr std::uint8_t kLastUnsaturated{250};

/// Returns the factor of the sRGB values, + 0.055, that a gain causes, and the inverse.
double factor_of(double gain) { return std::pow(gain, 1.0 / kSrgbExponent); }
double gain_of(double factor) { return std::pow(factor, kSrgbExponent); }

std::uint8_t code_of(double encoded) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(encoded, 0.0, 1.0) * 255.0));
}

/// Returns the codes of the divided light by code. If every frame rounded to the nearest code, a small gain would
/// change nothing, and the averages would follow it. So frames round at different places.
std::array<std::uint8_t, 256> divided_codes(double gain, std::size_t frame) {
  constexpr std::array<double, 4> kRoundUpFrom{0.375, 0.875, 0.125, 0.625};
  const double up = 1.0 - kRoundUpFrom[frame % kRoundUpFrom.size()];
  std::array<std::uint8_t, 256> codes{};
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const double encoded = srgb_of_linear(linear_of_srgb(static_cast<double>(i) / 255.0) / gain);
    codes[i] = static_cast<std::uint8_t>(std::min(std::floor(encoded * 255.0 + up), 255.0));
  }
  return codes;
}

/// Corrects a row: a pixel saturated in a brighter frame may be as bright as its surfel.
void correct_row(const SurfelAssociation& seen, const SurfelMap& map, const std::array<std::uint8_t, 256>& codes,
                 bool is_brighter, int v, ColorImage& color) {
  Rgb8* pixels = color.row(v);
  const SurfelId* ids = seen.of_pixel.row(v);
  for (int u = 0; u < color.width(); ++u) {
    Rgb8& pixel = pixels[u];
    const Rgb8 before = pixel;
    for (std::size_t k = 0; k < 3; ++k) pixel[k] = codes[before[k]];
    if (!is_brighter || std::max({before[0], before[1], before[2]}) <= kLastUnsaturated) continue;
    if (ids[u] >= seen.first_new || map.colors[ids[u]].weight <= 0.0F) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const double of_surfel = double{map.colors[ids[u]].color[static_cast<int>(k)]};
      if (before[k] > kLastUnsaturated) pixel[k] = std::max(pixel[k], code_of(of_surfel));
    }
  }
}

}  // namespace

Status ExposureCompensationConfig::validate() const {
  if (step_px < 1 || !(min_samples >= 1.0 && settled_weight >= 0.0 && min_agreement > 0.0 && min_agreement <= 1.0)) {
    return Error{Errc::invalid_argument, "exposure compensation: step, samples and agreement must be positive", {}};
  }
  if (!(darkest >= 0.0 && darkest < brightest && brightest < 1.0 && outlier_color > 0.0)) {
    return Error{Errc::invalid_argument, "exposure compensation: colours must be within 0 and 1, darkest first", {}};
  }
  if (!(std::isfinite(max_gain) && max_gain > 1.0)) {
    return Error{Errc::invalid_argument, "exposure compensation: the largest gain must be above 1", {}};
  }
  return {};
}

Result<ExposureCompensation> ExposureCompensation::create(const ExposureCompensationConfig& config) {
  SACCADE_CHECK(config.validate());
  return ExposureCompensation{config};
}

void ExposureCompensation::collect(const SurfelAssociation& seen, const SurfelMap& map, const Executor& executor,
                                   const ColorImage& color) {
  const int step = config_.step_px;
  const auto rows = static_cast<std::size_t>((color.height() + step - 1) / step);
  const auto darkest = static_cast<float>(config_.darkest);
  const auto brightest = static_cast<float>(config_.brightest);
  const auto settled = static_cast<float>(config_.settled_weight);
  samples_.resize((rows + kSampledRowsPerTask - 1) / kSampledRowsPerTask);
  executor.parallel_for(rows, kSampledRowsPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Sample>& samples = samples_[begin / kSampledRowsPerTask];
    samples.clear();
    for (std::size_t row = begin; row < end; ++row) {
      const int v = static_cast<int>(row) * step;
      const SurfelId* ids = seen.of_pixel.row(v);
      const int ahead = static_cast<int>(kSamplesAhead) * step;
      for (int u = 0; u < color.width(); u += step) {
        if (u + ahead < color.width() && ids[u + ahead] < seen.first_new) {
          __builtin_prefetch(&map.colors[ids[u + ahead]]);
        }
        if (ids[u] >= seen.first_new) continue;  // no surfel, or a new one
        const SurfelColor& surfel = map.colors[ids[u]];
        if (surfel.weight <= 0.0F) continue;
        const Eigen::Vector3f of_frame = unit_color(color(u, v));
        const float weight = seen.weight(u, v) * surfel.weight / (surfel.weight + settled);
        for (int k = 0; k < 3; ++k) {
          if (surfel.color[k] < darkest || surfel.color[k] > brightest) continue;
          samples.push_back({of_frame[k] + kOffset, surfel.color[k] + kOffset, weight});
        }
      }
    }
  });
}

/// Returns the weighted median of frame / surfel.
double ExposureCompensation::median_factor(const Executor& executor) const {
  const double most = factor_of(config_.max_gain);
  const auto bins_per_unit = static_cast<float>(double{kRatioBins} / most);
  std::vector<std::array<std::uint64_t, kRatioBins>> weights(samples_.size());
  executor.parallel_for(samples_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t task = begin; task < end; ++task) {
      for (const Sample& sample : samples_[task]) {
        const auto bin = static_cast<std::size_t>(sample.frame / sample.surfel * bins_per_unit);
        weights[task][std::min(bin, kRatioBins - 1)] += static_cast<std::uint64_t>(sample.weight * kWeightUnits);
      }
    }
  });
  std::array<std::uint64_t, kRatioBins> below{};
  std::uint64_t sum{0};
  for (std::size_t bin = 0; bin < kRatioBins; ++bin) {
    for (const auto& of_rows : weights) sum += of_rows[bin];
    below[bin] = sum;
  }
  const auto half = std::lower_bound(below.begin(), below.end(), (sum + 1) / 2) - below.begin();
  return std::clamp((static_cast<double>(half) + 0.5) / double{bins_per_unit}, 1.0 / most, most);
}

ExposureCompensation::Fit ExposureCompensation::fit(double factor, const Executor& executor) const {
  const auto inverse = static_cast<float>(1.0 / factor);
  const auto outlier = static_cast<float>(config_.outlier_color);
  // Range of a surfel's value for which the frame's value would be within the valid range.
  const auto least = static_cast<float>((config_.darkest + kSrgbOffset) / factor);
  const auto most = static_cast<float>((config_.brightest + kSrgbOffset) / factor);
  std::vector<Fit> fits(samples_.size());
  executor.parallel_for(samples_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t task = begin; task < end; ++task) {
      Fit sum;
      for (const Sample& sample : samples_[task]) {
        if (sample.surfel < least || sample.surfel > most) continue;
        const float difference = inverse * sample.frame - sample.surfel;
        const float distance = std::abs(difference);
        const float trusted = distance <= outlier ? sample.weight : sample.weight * (outlier / distance);
        sum.weight += double{sample.weight};
        sum.squared_weight += double{sample.weight * sample.weight};
        sum.agreeing_weight += distance <= outlier ? double{sample.weight} : 0.0;
        sum.difference += double{trusted * difference};
        sum.slope += double{trusted * sample.frame};
      }
      fits[task] = sum;
    }
  });
  Fit all;
  for (const Fit& of_rows : fits) {
    all.weight += of_rows.weight;
    all.squared_weight += of_rows.squared_weight;
    all.agreeing_weight += of_rows.agreeing_weight;
    all.difference += of_rows.difference;
    all.slope += of_rows.slope;
  }
  return all;
}

/// Estimates by reweighted least squares the 1 / factor that brings the frame to the surfels.
void ExposureCompensation::estimate(const Executor& executor, ExposureReport& report) const {
  const double most = factor_of(config_.max_gain);
  double factor = median_factor(executor);
  for (int i = 0;; ++i) {
    const Fit now = fit(factor, executor);
    if (!(now.slope > 0.0)) return;
    if (i == kFits) {
      report.samples = now.weight * now.weight / now.squared_weight;
      report.agreement = now.agreeing_weight / now.weight;
      report.estimated = report.samples >= config_.min_samples && report.agreement >= config_.min_agreement;
      break;
    }
    const double inverse = 1.0 / factor - now.difference / now.slope;
    factor = std::clamp(1.0 / std::max(inverse, 1.0 / most), 1.0 / most, most);
  }
  if (report.estimated) report.gain = gain_of(factor);
}

ExposureReport ExposureCompensation::apply(const SurfelAssociation& seen, const SurfelMap& map,
                                           const Executor& executor, ColorImage& color) {
  SACCADE_EXPECTS(color.width() == seen.of_pixel.width() && color.height() == seen.of_pixel.height());
  ExposureReport report;
  report.gain = gain_;
  collect(seen, map, executor, color);
  estimate(executor, report);
  gain_ = report.gain;
  const std::array<std::uint8_t, 256> codes = divided_codes(gain_, frame_++);
  executor.parallel_for(static_cast<std::size_t>(color.height()), kCorrectedRowsPerTask,
                        [&](std::size_t begin, std::size_t end) {
                          for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
                            correct_row(seen, map, codes, gain_ > 1.0, v, color);
                          }
                        });
  return report;
}

}  // namespace saccade

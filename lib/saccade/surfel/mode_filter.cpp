// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/mode_filter.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include "saccade/core/clock.hpp"
#include "saccade/surfel/mode_choice.hpp"

namespace saccade {
namespace {

constexpr std::size_t kModeRowsPerTask{16};
constexpr std::size_t kWinnersPerTask{4096};
constexpr std::uint8_t kNoMode{255};
constexpr int kMostModes{32};

/// Algorithm 6's parameters, in units of ColorUnits.
struct ColorLimits {
  ColorLimits(const ModeFilterConfig& config, float lightest_pixel)
      : sigma{config.guided.color_sigma * 255.0 * ColorUnits::kPerLevel},
        squared_new{whole(std::pow(config.color_sigmas * sigma, 2.0))},
        squared_per_octave{static_cast<float>(2.0 * sigma * sigma * std::numbers::ln2 * 1.0001)},
        lightest{lightest_pixel} {}

  static std::int64_t whole(double squared) {
    constexpr std::int64_t kFarthest{std::int64_t{1} << 46};  // no colours are so far apart
    return squared < static_cast<double>(kFarthest) ? static_cast<std::int64_t>(squared) : kFarthest;
  }

  double sigma;
  std::int64_t squared_new;  ///< (K · σ_c)²
  float squared_per_octave;  ///< 2σ_c² ln 2: line 22 holds within 2σ_c² ln(w_n / w_i)
  float lightest;            ///< no mode is lighter
};

void merge(const StoredModes& modes, std::size_t n, const ColorUnits& color, const Eigen::Vector3f& position_m,
           float weight) {
  const float sum = modes.weights[n] + weight;
  modes.colors[n] = mean_color(ColorUnits::unpacked(modes.colors[n]), color, weight / sum).packed();
  modes.set_position(n, weighted_mean(modes.position_m(n), modes.weights[n], position_m, weight));
  modes.weights[n] = sum;
}

/// Line 22: p_N(c_i, c_n, σ_c) · w_n > p_N(c_i, c_i, σ_c) · w_i; the common factor of the densities is left out.
bool absorbs(const StoredModes& modes, std::size_t n, std::size_t i, double sigma) {
  const auto squared = static_cast<double>(
      squared_distance(ColorUnits::unpacked(modes.colors[n]), ColorUnits::unpacked(modes.colors[i])));
  return std::exp(-squared / (2.0 * sigma * sigma)) * double{modes.weights[n]} > double{modes.weights[i]};
}

/// ⌊log₂ weight⌋ and a constant.
float octave(float weight) { return static_cast<float>(std::bit_cast<std::int32_t>(weight) >> 23); }

/// The modes of one surfel while a frame is taken in, and which of them its pixels went into.
class ModesOfSurfel {
 public:
  ModesOfSurfel(ModeStore& store, SurfelId id, const ModeFilterConfig& config, const ColorLimits& limits,
                std::size_t pixels, ModeFilterReport& counts)
      : modes_{store.modes(id)}, config_{config}, limits_{limits}, counts_{counts}, pixels_{pixels} {
    std::fill_n(mode_of_pixel_.begin(), pixels, kNoMode);
  }

  [[nodiscard]] const StoredModes& modes() const { return modes_; }
  [[nodiscard]] std::uint8_t mode_of_pixel(std::size_t k) const { return mode_of_pixel_[k]; }
  /// Lines 6 and 8.
  [[nodiscard]] std::optional<std::size_t> mode_for(const ColorQuery& answered) const {
    if (answered.count == 0 || answered.nearest.squared_units > limits_.squared_new) return std::nullopt;
    return answered.nearest.index;
  }
  [[nodiscard]] std::optional<std::size_t> mode_for(const ColorUnits& color) const {
    ColorQuery query{modes_.colors, modes_.count(), color, {}};
    find_nearest({&query, 1}, query.count);
    return mode_for(query);
  }

  /// Lines 1–26 for the k-th pixel with its measured point.
  void observe(std::size_t k, const ColorUnits& color, const Eigen::Vector3f& position_m, float weight,
               std::optional<std::size_t> nearest) {
    if (!nearest) {
      if (modes_.count() >= static_cast<std::size_t>(config_.max_modes)) evict_lightest();
      modes_.add(color, position_m, weight);
      ++counts_.new_modes;
      return;
    }
    merge(modes_, *nearest, color, position_m, weight);
    mode_of_pixel_[k] = static_cast<std::uint8_t>(*nearest);
    compress(*nearest);
  }

 private:
  /// Lines 21–26.
  void compress(std::size_t n) {
    if (near_enough(n) == 0) return;
    for (std::size_t i = 0; i < modes_.count();) {
      if (i == n || !absorbs(modes_, n, i, limits_.sigma)) {
        ++i;
        continue;
      }
      merge(modes_, n, ColorUnits::unpacked(modes_.colors[i]), modes_.position_m(i), modes_.weights[i]);
      ++counts_.merged_modes;
      remove(i, static_cast<std::uint8_t>(n));
      if (i < n) --n;
    }
  }
  /// Modes that n could absorb if they were as light as one pixel: almost always none.
  [[nodiscard]] std::uint32_t near_enough(std::size_t n) const {
    const float most_octaves = octave(modes_.weights[n]) - octave(limits_.lightest) + 1.0F;
    const std::uint32_t all = colors_within(modes_.colors, modes_.count(), ColorUnits::unpacked(modes_.colors[n]),
                                            static_cast<std::int64_t>(most_octaves * limits_.squared_per_octave) + 1);
    return all & ~(1U << n);
  }
  void evict_lightest() {
    const auto i =
        static_cast<std::size_t>(std::min_element(modes_.weights, modes_.weights + modes_.count()) - modes_.weights);
    counts_.evicted_weight += double{modes_.weights[i]};
    ++counts_.evicted_modes;
    remove(i, kNoMode);
  }
  void remove(std::size_t i, std::uint8_t heir) {
    for (std::size_t k = 0; k < pixels_; ++k) {
      std::uint8_t& mode = mode_of_pixel_[k];
      if (mode == i) mode = heir;
      if (mode != kNoMode && mode > i) --mode;
    }
    modes_.remove(i);
  }

  StoredModes modes_;
  const ModeFilterConfig& config_;
  const ColorLimits& limits_;
  ModeFilterReport& counts_;
  std::size_t pixels_;
  std::array<std::uint8_t, SurfelAssociation::kNewSurfel> mode_of_pixel_;
};

void add_counts(ModeFilterReport& sum, const ModeFilterReport& counts) {
  sum.pixels += counts.pixels;
  sum.guided += counts.guided;
  sum.new_modes += counts.new_modes;
  sum.merged_modes += counts.merged_modes;
  sum.evicted_modes += counts.evicted_modes;
  sum.evicted_weight += counts.evicted_weight;
}

}  // namespace

Status ModeFilterConfig::validate() const {
  SACCADE_CHECK(guided.validate());
  if (!(color_sigmas > 0.0)) return Error{Errc::invalid_argument, "mode filter: K must be positive", {}};
  if (max_modes < 1 || max_modes > kMostModes) {
    return Error{Errc::invalid_argument, "mode filter: a surfel has 1 to 32 modes", {}};
  }
  if (!(max_depth_change_m > 0.0)) {
    return Error{Errc::invalid_argument, "mode filter: the largest change of a depth must be positive", {}};
  }
  if (!(choice_sigmas >= 0.0 && std::isfinite(choice_sigmas))) {
    return Error{Errc::invalid_argument, "mode filter: choice_sigmas must be 0 or more", {}};
  }
  SACCADE_CHECK(sharpening.validate());
  return {};
}

Result<ModeFilter> ModeFilter::create(const ModeFilterConfig& config) {
  SACCADE_CHECK(config.validate());
  return ModeFilter{config};
}

void ModeFilter::integrate(const Frame& frame, const SurfelAssociation& seen, const Executor& executor,
                           ModeFilterReport& report) {
  const auto rows = static_cast<std::size_t>(seen.camera.height);
  const auto width = static_cast<std::size_t>(seen.camera.width);
  lightest_ = std::min(lightest_, *std::min_element(seen.column_weights.begin(), seen.column_weights.end()) *
                                      *std::min_element(seen.row_weights.begin(), seen.row_weights.end()));
  const ColorLimits limits{config_, lightest_};
  const BackProjection back_project{seen};
  const Eigen::Vector3f forward = back_project.R_world_camera.col(2);
  std::vector<ModeFilterReport> counts((rows + kModeRowsPerTask - 1) / kModeRowsPerTask);
  executor.parallel_for(rows, kModeRowsPerTask, [&](std::size_t begin, std::size_t end) {
    ModeFilterReport& count = counts[begin / kModeRowsPerTask];
    std::vector<ColorQuery> queries;
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
      // First the nearest modes of all pixels of a row's surfels, at the frame's beginning.
      queries.clear();
      const auto ask = [&](SurfelId id, std::span<const SeenPixel> pixels) {
        const StoredModes modes = store_.modes(id);
        for (const auto& [u, v] : pixels) {
          ColorQuery& query = queries.emplace_back();  // member by member: what is stored in parts is slow to copy
          query.packed = modes.colors;
          query.count = modes.count();
          query.color = color_units((*frame.color)(u, v));
        }
      };
      for_each_seen_surfel(
          seen, row, row + 1, [&](SurfelId id, int, int) { store_.fetch(id); }, ask);
      find_nearest(queries, static_cast<std::size_t>(config_.max_modes));
      auto answered = queries.cbegin();
      for_each_seen_surfel(
          seen, row, row + 1, [](SurfelId, int, int) {},
          [&](SurfelId id, std::span<const SeenPixel> pixels) {
            ModesOfSurfel surfel{store_, id, config_, limits, pixels.size(), count};
            const StoredModes& modes = surfel.modes();
            for (std::size_t k = 0; config_.enhance_depth && k < pixels.size(); ++k) {
              const std::optional<std::size_t> nearest = surfel.mode_for(answered[static_cast<std::ptrdiff_t>(k)]);
              if (!nearest) continue;
              const auto& [u, v] = pixels[k];
              const std::size_t i = static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u);
              const Eigen::Vector3f color = unit_color(ColorUnits::unpacked(modes.colors[*nearest]));
              guidance_[i] = {color.x(), color.y(), color.z(),
                              forward.dot(modes.position_m(*nearest) - back_project.center_world)};
              used_[i] = 1;
              ++count.guided;
            }
            for (std::size_t k = 0; k < pixels.size(); ++k, ++answered) {
              const auto& [u, v] = pixels[k];
              surfel.observe(k, answered->color, back_project(u, v, frame.depth(u, v)), seen.weight(u, v),
                             k == 0 ? surfel.mode_for(*answered) : surfel.mode_for(answered->color));
            }
            for (std::size_t k = 0; config_.enhance_depth && k < pixels.size(); ++k) {
              const auto& [u, v] = pixels[k];
              mode_of_pixel_[static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u)] =
                  surfel.mode_of_pixel(k);
            }
            count.pixels += pixels.size();
          });
    }
  });
  for (const ModeFilterReport& count : counts) add_counts(report, count);
}

void ModeFilter::move_to_enhanced(const Frame& frame, const SurfelAssociation& seen, const Executor& executor) {
  const auto rows = static_cast<std::size_t>(seen.camera.height);
  const auto width = static_cast<std::size_t>(seen.camera.width);
  const BackProjection back_project{seen};
  executor.parallel_for(rows, kModeRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for_each_seen_surfel(
        seen, static_cast<int>(begin), static_cast<int>(end), [&](SurfelId id, int, int) { store_.fetch_places(id); },
        [&](SurfelId id, std::span<const SeenPixel> pixels) {
          for (const auto& [u, v] : pixels) {
            const std::size_t i = static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u);
            const float enhanced_m = enhanced_m_[i];
            const float depth_m = frame.depth.data()[i];
            if (used_[i] == 0 || mode_of_pixel_[i] == kNoMode || !(enhanced_m > 0.0F) || enhanced_m == depth_m ||
                !(std::abs(double{enhanced_m} - double{depth_m}) <= config_.max_depth_change_m)) {
              continue;
            }
            const StoredModes modes = store_.modes(id);
            const std::size_t n = mode_of_pixel_[i];
            const Eigen::Vector3f step = back_project(u, v, enhanced_m) - back_project(u, v, depth_m);
            modes.set_position(n, modes.position_m(n) + step * (seen.weight(u, v) / modes.weights[n]));
          }
        });
  });
}

Result<ModeFilterReport> ModeFilter::add_frame(const Frame& frame, const SurfelAssociation& seen,
                                               const Executor& executor) {
  const int width = seen.of_pixel.width();
  const int height = seen.of_pixel.height();
  const bool color_fits = !frame.color || (frame.color->width() == width && frame.color->height() == height);
  if (frame.depth.width() != width || frame.depth.height() != height || !color_fits) {
    return Error{Errc::size_mismatch, "mode filter: the frame is not of the association's size", frame.name};
  }
  ModeFilterReport report;
  store_.resize(std::max(seen.surfels, store_.size()));
  report.has_color = frame.color.has_value();
  if (!report.has_color) return report;
  Stopwatch stopwatch;
  if (config_.enhance_depth) {
    guidance_.resize(frame.depth.size());
    used_.assign(frame.depth.size(), 0);
    mode_of_pixel_.resize(frame.depth.size());
  }
  integrate(frame, seen, executor, report);
  report.integrate_ms = stopwatch.lap_ms();
  if (!config_.enhance_depth) return report;
  enhanced_m_.resize(frame.depth.size());
  guided_.apply(width, height, frame.depth.pixels(), guidance_, used_, executor, enhanced_m_);
  report.guided_filter_ms = stopwatch.lap_ms();
  move_to_enhanced(frame, seen, executor);
  report.move_ms = stopwatch.lap_ms();
  return report;
}

std::vector<SurfelMode> ModeFilter::modes(SurfelId id) const {
  std::vector<SurfelMode> all;
  for (std::size_t i = 0; i < store_.count(id); ++i) all.push_back(store_.mode(id, i));
  return all;
}

std::vector<SurfelMode> ModeFilter::winners(const Executor& executor) const {
  const double bandwidth = config_.choice_sigmas * config_.guided.color_sigma;
  if (bandwidth > 0.0 && config_.sharpening.strength > 0.0) {
    return sharpened_modes(store_, config_.sharpening, bandwidth, executor);
  }
  std::vector<SurfelMode> chosen(store_.size());
  executor.parallel_for(chosen.size(), kWinnersPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<SurfelMode> modes;
    for (std::size_t k = begin; k < end; ++k) {
      const auto id = static_cast<SurfelId>(k);
      modes.clear();
      for (std::size_t i = 0; i < store_.count(id); ++i) modes.push_back(store_.mode(id, i));
      chosen[k] = bandwidth > 0.0 ? densest_mode(modes, bandwidth) : heaviest_mode(modes);
    }
  });
  return chosen;
}

}  // namespace saccade

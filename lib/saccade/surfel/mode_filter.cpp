// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/mode_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "saccade/core/clock.hpp"
#include "saccade/surfel/internal/mode_choice.hpp"
#include "saccade/surfel/internal/mode_merges.hpp"
#include "saccade/surfel/internal/mode_sharpening.hpp"
#include "saccade/surfel/internal/mode_update.hpp"

namespace saccade {
namespace {

constexpr std::size_t kWinnersPerTask{4096};
constexpr int kMostModes{32};

void add_counts(ModeFilterReport& sum, const ModeFilterReport& counts) {
  sum.pixels += counts.pixels;
  sum.guided += counts.guided;
  sum.new_modes += counts.new_modes;
  sum.merged_modes += counts.merged_modes;
  sum.evicted_modes += counts.evicted_modes;
  sum.evicted_weight += counts.evicted_weight;
}

}  // namespace

ModeFilterConfig ModeFilterConfig::as_printed() {
  ModeFilterConfig config;
  config.enhance_depth = true;
  config.max_depth_change_m = std::numeric_limits<double>::infinity();
  config.choice_sigmas = 0.0;
  config.sharpening.strength = 0.0;
  return config;
}

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
  lightest_ = std::min(lightest_, *std::min_element(seen.column_weights.begin(), seen.column_weights.end()) *
                                      *std::min_element(seen.row_weights.begin(), seen.row_weights.end()));
  const ColorLimits limits{config_, lightest_};
  std::vector<ModeFilterReport> counts(seen.groups.size());
  executor.parallel_for(seen.groups.size(), SurfelAssociation::kGroupsPerTask, [&](std::size_t begin, std::size_t end) {
    ModeUpdate update{config_, limits, frame, seen, store_, config_.enhance_depth ? &guidance_ : nullptr};
    for (std::size_t g = begin; g < end; ++g) update.take(seen.groups[g], counts[g]);
  });
  for (const ModeFilterReport& count : counts) add_counts(report, count);
}

void ModeFilter::move_to_enhanced(const Frame& frame, const SurfelAssociation& seen, const Executor& executor) {
  const auto width = static_cast<std::size_t>(seen.camera.width);
  const BackProjection back_project{seen};
  const auto moves = [&](std::size_t i) {
    const float enhanced_m = enhanced_m_[i];
    const float depth_m = frame.depth.data()[i];
    return guidance_.used[i] != 0 && guidance_.mode_of_pixel[i] != ModeGuidance::kNoMode && enhanced_m > 0.0F &&
           enhanced_m != depth_m && std::abs(double{enhanced_m} - double{depth_m}) <= config_.max_depth_change_m;
  };
  struct Move {
    SurfelPixel pixel;
    std::uint8_t mode;
  };
  const auto move_round = [&](std::span<const SurfelPixel> round) {
    std::array<Move, DepthSteps::kMost> moving;
    DepthSteps steps;
    for (std::size_t next = 0; next < round.size();) {
      std::size_t count{0};
      for (; next < round.size() && count < moving.size(); ++next) {
        const SurfelPixel& pixel = round[next];
        const std::size_t i = static_cast<std::size_t>(pixel.v) * width + pixel.u;
        if (!moves(i)) continue;
        moving[count] = {pixel, guidance_.mode_of_pixel[i]};
        store_.fetch_place(pixel.id, moving[count].mode);
        steps.u[count] = static_cast<float>(pixel.u);
        steps.v[count] = static_cast<float>(pixel.v);
        steps.from_m[count] = frame.depth.data()[i];
        steps.to_m[count++] = enhanced_m_[i];
      }
      find_ways(back_project, count, steps);
      for (std::size_t k = 0; k < count; ++k) {
        const auto& [pixel, n] = moving[k];
        const StoredModes modes = store_.modes(pixel.id);
        const Eigen::Vector3f way{steps.x_m[k], steps.y_m[k], steps.z_m[k]};
        modes.set_position(n, modes.position_m(n) + way * (seen.weight(pixel.u, pixel.v) / modes.weight(n)));
      }
    }
  };
  executor.parallel_for(seen.groups.size(), SurfelAssociation::kGroupsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      for (const auto& round : seen.groups[g]) move_round(round);
    }
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
    guidance_.values.resize(frame.depth.size());
    guidance_.used.assign(frame.depth.size(), 0);
    guidance_.mode_of_pixel.resize(frame.depth.size());
  }
  integrate(frame, seen, executor, report);
  report.integrate_ms = stopwatch.lap_ms();
  if (!config_.enhance_depth) return report;
  enhanced_m_.resize(frame.depth.size());
  guided_.apply(width, height, frame.depth.pixels(), guidance_.values, guidance_.used, executor, enhanced_m_);
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

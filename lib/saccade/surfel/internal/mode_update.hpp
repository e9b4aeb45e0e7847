// SPDX-License-Identifier: Apache-2.0
#pragma once
// ModeUpdate: merges the pixels of a frame into the modes of the surfels that they saw. Thesis §4.1.1, Algorithm 6. For
// mode_filter.cpp.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/sensor/camera.hpp"
#include "saccade/surfel/internal/mode_merges.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/mode_store.hpp"
#include "saccade/surfel/surfel_association.hpp"

namespace saccade {

/// Parameters of Algorithm 6, in units of ColorUnits.
struct ColorLimits {
  ColorLimits(const ModeFilterConfig& config, float lightest_pixel);

  double sigma;
  std::int64_t squared_new;  ///< (K · σ_c)²
  float squared_per_octave;  ///< 2σ_c² ln 2: line 22 holds within 2σ_c² ln(w_n / w_i)
  float lightest;            ///< smallest weight of a mode
};

/// Performs lines 1–15 and 20–26 for the surfels of a group, with measured depths. The first pixels of all surfels
/// precede the second ones. Each surfel's pixel is thus processed beside pixels of other surfels: many searches and
/// means at a time.
class ModeUpdate {
 public:
  /// @param guidance  output: guidance of all pixels for the guided filter; may be null.
  ModeUpdate(const ModeFilterConfig& config, const ColorLimits& limits, const Frame& frame,
             const SurfelAssociation& seen, ModeStore& store, ModeGuidance* guidance);

  /// Merges pixels, and adds to `counts`.
  void take(const SeenRounds& rounds, ModeFilterReport& counts);

 private:
  using Pixels = std::span<const SurfelPixel>;
  template <class Visit>
  void for_batches(Pixels round, const Visit& visit);
  void ask(Pixels pixels, Pixels next);
  [[nodiscard]] std::span<const std::uint8_t> near() const { return std::span{near_}.first(near_count_); }
  [[nodiscard]] std::span<const std::uint8_t> far() const { return std::span{far_}.first(far_count_); }
  void guide(Pixels pixels, ModeFilterReport& counts);
  void observe(Pixels pixels, std::size_t round, ModeFilterReport& counts);
  void merge_near(Pixels pixels, std::size_t round, ModeFilterReport& counts);
  [[nodiscard]] std::size_t compress(const SurfelPixel& pixel, std::size_t n, std::size_t round,
                                     ModeFilterReport& counts);
  void add_mode(const SurfelPixel& pixel, const ColorUnits& color, std::size_t round, ModeFilterReport& counts);
  void remove(const SurfelPixel& pixel, std::size_t i, std::uint8_t replacement, std::size_t round);
  [[nodiscard]] std::size_t index(const SurfelPixel& pixel) const {
    return static_cast<std::size_t>(pixel.v) * width_ + pixel.u;
  }

  const ModeFilterConfig& config_;
  const ColorLimits& limits_;
  const Frame& frame_;
  const SurfelAssociation& seen_;
  ModeStore& store_;
  ModeGuidance* guidance_;
  std::size_t width_;
  BackProjection back_project_;
  std::vector<ColorQuery> queries_;                     ///< queries of a batch, with answers
  std::array<std::uint8_t, ModeMerges::kMost> near_{};  ///< pixels of the batch with a mode near enough
  std::array<std::uint8_t, ModeMerges::kMost> far_{};   ///< pixels without
  std::size_t near_count_{0};
  std::size_t far_count_{0};
  std::vector<NearbyQuery> nearby_;
  ModeMerges merges_;
};

}  // namespace saccade

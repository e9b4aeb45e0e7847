// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/internal/mode_update.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace saccade {
namespace {

constexpr std::size_t kBatch{ModeMerges::kMost};

std::int64_t whole(double squared) {
  constexpr std::int64_t kFarthest{std::int64_t{1} << 46};  // beyond the distance of any two colours
  return squared < static_cast<double>(kFarthest) ? static_cast<std::int64_t>(squared) : kFarthest;
}

void merge(const StoredModes& modes, std::size_t n, std::size_t i) {
  const float weight = modes.weight(i);
  const float sum = modes.weight(n) + weight;
  modes.colors[n] =
      mean_color(ColorUnits::unpacked(modes.colors[n]), ColorUnits::unpacked(modes.colors[i]), weight / sum).packed();
  modes.set_position(n, weighted_mean(modes.position_m(n), modes.weight(n), modes.position_m(i), weight));
  modes.weight(n) = sum;
}

/// Tests line 22: p_N(c_i, c_n, σ_c) · w_n > p_N(c_i, c_i, σ_c) · w_i, without the densities' common factor.
bool absorbs(const StoredModes& modes, std::size_t n, std::size_t i, double sigma) {
  const auto squared = static_cast<double>(
      squared_distance(ColorUnits::unpacked(modes.colors[n]), ColorUnits::unpacked(modes.colors[i])));
  return std::exp(-squared / (2.0 * sigma * sigma)) * double{modes.weight(n)} > double{modes.weight(i)};
}

/// Returns the first of the lightest modes. Free of branches, since they would be unpredictable.
std::size_t lightest_mode(const StoredModes& modes) {
  constexpr unsigned kIndexBits{8};
  std::uint64_t least{std::numeric_limits<std::uint64_t>::max()};
  for (std::size_t i = 0; i < modes.count(); ++i) {  // positive weights sort as their bits do
    least = std::min(least, std::uint64_t{std::bit_cast<std::uint32_t>(modes.weight(i))} << kIndexBits | i);
  }
  return least & ((std::uint64_t{1} << kIndexBits) - 1);
}

/// Returns ⌊log₂ weight⌋ plus a constant.
float octave(float weight) { return static_cast<float>(std::bit_cast<std::int32_t>(weight) >> 23); }

}  // namespace

ColorLimits::ColorLimits(const ModeFilterConfig& config, float lightest_pixel)
    : sigma{config.guided.color_sigma * 255.0 * ColorUnits::kPerLevel},
      squared_new{whole(std::pow(config.color_sigmas * sigma, 2.0))},
      squared_per_octave{static_cast<float>(2.0 * sigma * sigma * std::numbers::ln2 * 1.0001)},
      lightest{lightest_pixel} {}

ModeUpdate::ModeUpdate(const ModeFilterConfig& config, const ColorLimits& limits, const Frame& frame,
                       const SurfelAssociation& seen, ModeStore& store, ModeGuidance* guidance)
    : config_{config},
      limits_{limits},
      frame_{frame},
      seen_{seen},
      store_{store},
      guidance_{guidance},
      width_{static_cast<std::size_t>(seen.camera.width)},
      back_project_{seen} {}

void ModeUpdate::take(const SeenRounds& rounds, ModeFilterReport& counts) {
  // Guidance is that of the frame's beginning, so all pixels of a surfel get it before the first is merged.
  for (std::size_t k = 1; guidance_ != nullptr && k < rounds.size(); ++k) {
    for_batches(rounds[k], [&](Pixels pixels) { guide(pixels, counts); });
  }
  for (std::size_t k = 0; k < rounds.size(); ++k) {
    for_batches(rounds[k], [&](Pixels pixels) {
      if (guidance_ != nullptr && k == 0) guide(pixels, counts);
      observe(pixels, k, counts);
    });
  }
}

/// Calls visit for batches of pixels whose nearest modes are known, while prefetching the next batch.
template <class Visit>
void ModeUpdate::for_batches(Pixels round, const Visit& visit) {
  for (const SurfelPixel& pixel : round.first(std::min(kBatch, round.size()))) store_.fetch_count(pixel.id);
  for (std::size_t first = 0; first < round.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, round.size() - first);
    ask(round.subspan(first, count), round.subspan(first + count));
    visit(round.subspan(first, count));
  }
}

/// Performs lines 6 and 8 for each pixel.
void ModeUpdate::ask(Pixels pixels, Pixels next) {
  queries_.resize(pixels.size());
  const Rgb8* colors = frame_.color->data();
  ColorQuery* query = queries_.data();
  const SurfelPixel* ahead = next.data();
  const SurfelPixel* const end = ahead + std::min(next.size(), pixels.size());
  for (const SurfelPixel& pixel : pixels) {
    if (ahead != end) store_.fetch_count((ahead++)->id);
    if (query - queries_.data() < static_cast<std::ptrdiff_t>(kQueriesAhead)) store_.fetch_colors(pixel.id);
    const StoredModes modes = store_.modes(pixel.id);
    query->packed = modes.colors;  // assigned member by member, since copying a partly stored struct is slow
    query->count = modes.count();
    query->color = color_units(colors[index(pixel)]);
    ++query;
  }
  find_nearest(queries_, static_cast<std::size_t>(config_.max_modes));
  near_count_ = 0;
  far_count_ = 0;
  for (std::size_t k = 0; k < pixels.size(); ++k) {  // unpredictable, hence without branches
    const ColorQuery& answered = queries_[k];
    const bool is_near = answered.count != 0 && answered.nearest.squared_units <= limits_.squared_new;
    near_[near_count_] = static_cast<std::uint8_t>(k);
    far_[far_count_] = static_cast<std::uint8_t>(k);
    near_count_ += is_near ? 1U : 0U;
    far_count_ += is_near ? 0U : 1U;
  }
  for (const std::uint8_t k : near()) store_.fetch_place(pixels[k].id, queries_[k].nearest.index);
  for (const std::uint8_t k : far()) store_.fetch_places(pixels[k].id);
}

void ModeUpdate::guide(Pixels pixels, ModeFilterReport& counts) {
  const Eigen::Vector3f forward = back_project_.R_world_camera.col(2);
  for (const std::uint8_t k : near()) {
    const std::size_t n = queries_[k].nearest.index;
    const StoredModes modes = store_.modes(pixels[k].id);
    const Eigen::Vector3f color = unit_color(ColorUnits::unpacked(modes.colors[n]));
    const std::size_t i = index(pixels[k]);
    guidance_->values[i] = {color.x(), color.y(), color.z(),
                            forward.dot(modes.position_m(n) - back_project_.center_world)};
    guidance_->used[i] = 1;
  }
  counts.guided += near_count_;
}

/// Performs lines 7–15 and 20–26 for each pixel.
void ModeUpdate::observe(Pixels pixels, std::size_t round, ModeFilterReport& counts) {
  for (const std::uint8_t k : far()) add_mode(pixels[k], queries_[k].color, round, counts);
  merge_near(pixels, round, counts);
  counts.pixels += pixels.size();
}

/// Performs lines 20–26 for the near pixels, each with its nearest mode.
void ModeUpdate::merge_near(Pixels pixels, std::size_t round, ModeFilterReport& counts) {
  const std::span<const std::uint8_t> which = near();
  auto& mode = merges_.mode;
  auto& of_pixel = merges_.pixel;
  for (std::size_t j = 0; j < which.size(); ++j) {
    const SurfelPixel& pixel = pixels[which[j]];
    const ColorQuery& query = queries_[which[j]];
    const std::size_t n = query.nearest.index;
    const StoredModes modes = store_.modes(pixel.id);
    const ColorUnits color = ColorUnits::unpacked(query.packed[n]);
    mode.r[j] = color.r;
    mode.g[j] = color.g;
    mode.b[j] = color.b;
    mode.places[j] = modes.places[n];
    of_pixel.r[j] = query.color.r;
    of_pixel.g[j] = query.color.g;
    of_pixel.b[j] = query.color.b;
    of_pixel.u[j] = static_cast<float>(pixel.u);
    of_pixel.v[j] = static_cast<float>(pixel.v);
    of_pixel.depth_m[j] = frame_.depth.data()[index(pixel)];
    of_pixel.weight[j] = seen_.weight(pixel.u, pixel.v);
  }
  merge_pixels(back_project_, which.size(), merges_);
  nearby_.resize(which.size());
  for (std::size_t j = 0; j < which.size(); ++j) {
    const SurfelPixel& pixel = pixels[which[j]];
    const std::size_t n = queries_[which[j]].nearest.index;
    const StoredModes modes = store_.modes(pixel.id);
    const ColorUnits color{mode.r[j], mode.g[j], mode.b[j]};
    modes.colors[n] = color.packed();
    modes.places[n] = mode.places[j];
    // Modes that n could absorb if they were as light as one pixel: almost always none.
    const float most_octaves = octave(mode.places[j].weight) - octave(limits_.lightest) + 1.0F;
    NearbyQuery& query = nearby_[j];
    query.packed = modes.colors;
    query.count = modes.count();
    query.color = color;
    query.squared_units = static_cast<std::int64_t>(most_octaves * limits_.squared_per_octave) + 1;
  }
  find_nearby(nearby_);
  for (std::size_t j = 0; j < which.size(); ++j) {
    const SurfelPixel& pixel = pixels[which[j]];
    std::size_t n = queries_[which[j]].nearest.index;
    const auto remember = [&] {
      if (guidance_ != nullptr) guidance_->mode_of_pixel[index(pixel)] = static_cast<std::uint8_t>(n);
    };
    remember();
    if ((nearby_[j].nearby & ~(1U << n)) == 0) continue;
    n = compress(pixel, n, round, counts);
    remember();
  }
}

/// Performs lines 21–26; returns the index of mode n afterwards.
std::size_t ModeUpdate::compress(const SurfelPixel& pixel, std::size_t n, std::size_t round, ModeFilterReport& counts) {
  const StoredModes modes = store_.modes(pixel.id);
  for (std::size_t i = 0; i < modes.count();) {
    if (i == n || !absorbs(modes, n, i, limits_.sigma)) {
      ++i;
      continue;
    }
    merge(modes, n, i);
    ++counts.merged_modes;
    remove(pixel, i, static_cast<std::uint8_t>(n), round);
    if (i < n) --n;
  }
  return n;
}

/// Performs lines 9–13.
void ModeUpdate::add_mode(const SurfelPixel& pixel, const ColorUnits& color, std::size_t round,
                          ModeFilterReport& counts) {
  const StoredModes modes = store_.modes(pixel.id);
  const std::size_t i = index(pixel);
  if (guidance_ != nullptr) guidance_->mode_of_pixel[i] = ModeGuidance::kNoMode;
  if (modes.count() >= static_cast<std::size_t>(config_.max_modes)) {
    const std::size_t lightest = lightest_mode(modes);
    counts.evicted_weight += double{modes.weight(lightest)};
    ++counts.evicted_modes;
    remove(pixel, lightest, ModeGuidance::kNoMode, round);
  }
  modes.add(color, back_project_(pixel.u, pixel.v, frame_.depth.data()[i]), seen_.weight(pixel.u, pixel.v));
  ++counts.new_modes;
}

/// Removes mode i, also from the record of earlier pixels of the surfel, which are at most two pixels away.
void ModeUpdate::remove(const SurfelPixel& pixel, std::size_t i, std::uint8_t replacement, std::size_t round) {
  store_.modes(pixel.id).remove(i);
  if (guidance_ == nullptr || round == 0) return;
  constexpr int kApart{2 * SurfelAssociation::kReach_px};
  const int last_u = std::min(pixel.u + kApart, seen_.camera.width - 1);
  const int last_v = std::min(pixel.v + kApart, seen_.camera.height - 1);
  for (int v = std::max(pixel.v - kApart, 0); v <= last_v; ++v) {
    for (int u = std::max(pixel.u - kApart, 0); u <= last_u; ++u) {
      if (seen_.of_pixel(u, v) != pixel.id) continue;
      std::uint8_t& mode = guidance_->mode_of_pixel[static_cast<std::size_t>(v) * width_ + static_cast<std::size_t>(u)];
      if (mode == i) mode = replacement;
      if (mode != ModeGuidance::kNoMode && mode > i) --mode;
    }
  }
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/internal/splat_depth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace saccade {

namespace {

constexpr std::size_t kMostLayers{8};
constexpr std::size_t kPointsPerPixelOfALayer{4};
constexpr std::size_t kSplatsAtOnce{64};
constexpr std::size_t kRowGrain{16};
constexpr std::size_t kColumnGrain{64};

}  // namespace

SplatDepth::SplatDepth(const PixelWindow& window, int point_size_px, std::size_t points, const Executor& executor)
    : size_px_{point_size_px},
      left_{window.left - (point_size_px - 1)},
      top_{window.top - (point_size_px - 1)},
      width_{window.right - left_},
      height_{window.bottom - top_} {
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  const std::size_t worth_it = kPointsPerPixelOfALayer * points / pixels;
  layers_.resize(std::clamp<std::size_t>(worth_it, 1, std::min(executor.threads(), kMostLayers)));
  executor.parallel_for(layers_.size(), 1, [&](std::size_t layer, std::size_t) {
    layers_[layer].assign(pixels + 1, std::numeric_limits<float>::infinity());
  });
}

void SplatDepth::add(std::size_t layer, std::span<const ScreenPosition> positions) {
  const double before = 0.5 - 0.5 * size_px_;
  float* const depths_m = layers_[layer].data();
  const std::size_t outside = layers_[layer].size() - 1;
  std::array<std::size_t, kSplatsAtOnce> places;
  while (!positions.empty()) {  // prefetches all memory before waiting for any
    const auto block = positions.first(std::min(kSplatsAtOnce, positions.size()));
    positions = positions.subspan(block.size());
    for (std::size_t i = 0; i < block.size(); ++i) {
      const int u = static_cast<int>(std::floor(block[i].u_px + before));
      const int v = static_cast<int>(std::floor(block[i].v_px + before));
      const bool reaches = static_cast<unsigned>(u - left_) < static_cast<unsigned>(width_) &&
                           static_cast<unsigned>(v - top_) < static_cast<unsigned>(height_);
      places[i] = reaches ? offset(u, v) : outside;
      __builtin_prefetch(depths_m + places[i], 1);
    }
    for (std::size_t i = 0; i < block.size(); ++i) {
      float& nearest_m = depths_m[places[i]];
      nearest_m = std::min(nearest_m, block[i].depth_m);
    }
  }
}

void SplatDepth::finish(const Executor& executor) {
  // A pixel shows the nearest of the squares that begin up to size − 1 pixels to the left and above. Spans are combined
  // from two shorter ones, backwards, so that the shorter ones are still available.
  const auto width = static_cast<std::size_t>(width_);
  const auto height = static_cast<std::size_t>(height_);
  const auto widen = [&](const auto& shift) {
    for (int span = 1; span < size_px_;) {
      const int by = std::min(span, size_px_ - span);
      shift(static_cast<std::size_t>(by));
      span += by;
    }
  };
  executor.parallel_for(height, kRowGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      float* const row = layers_[0].data() + v * width;
      for (std::size_t layer = 1; layer < layers_.size(); ++layer) {
        const float* const other = layers_[layer].data() + v * width;
        for (std::size_t u = 0; u < width; ++u) row[u] = std::min(row[u], other[u]);
      }
      widen([&](std::size_t by) {
        for (std::size_t u = width; u-- > by;) row[u] = std::min(row[u], row[u - by]);
      });
    }
  });
  executor.parallel_for(width, kColumnGrain, [&](std::size_t begin, std::size_t end) {
    widen([&](std::size_t by) {
      for (std::size_t v = height; v-- > by;) {
        float* const row = layers_[0].data() + v * width;
        const float* const above = row - by * width;
        for (std::size_t u = begin; u < end; ++u) row[u] = std::min(row[u], above[u]);
      }
    });
  });
}

}  // namespace saccade

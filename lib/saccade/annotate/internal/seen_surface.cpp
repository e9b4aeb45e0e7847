// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/internal/seen_surface.hpp"

#include <algorithm>
#include <limits>

namespace saccade {

namespace {

constexpr int kRowsAtOnce{32};
constexpr float kEmpty_m{-std::numeric_limits<float>::infinity()};

/// Distance from a pixel to the farthest pixels that the square of one of its points covers.
int reach_px(const SelectionView& view) { return view.point_size_px / 2; }

/// Calls shift(by) with ever longer spans, until every element is combined with the `count` − 1 after it.
template <class Shift>
void combine_spans(std::size_t count, const Shift& shift) {
  for (std::size_t span = 1; span < count;) {
    const std::size_t by = std::min(span, count - span);
    shift(by);
    span += by;
  }
}

/// Writes the elementwise greater ones of two rows, which may be one, or overlap if `to` is not after either.
void take_farther(const float* a, const float* b, std::size_t count, float* to) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) to[i] = a[i] < b[i] ? b[i] : a[i];
}

}  // namespace

PixelWindow SeenSurface::surroundings(const PixelWindow& window, const SelectionView& view) {
  const int reach = reach_px(view);
  return {std::max(0, window.left - reach), std::max(0, window.top - reach), std::min(view.width, window.right + reach),
          std::min(view.height, window.bottom + reach)};
}

SeenSurface::SeenSurface(const SplatDepth& drawn, const PixelWindow& window, const SelectionView& view,
                         const ScreenProjection& project, double below_m, const Executor& executor)
    : window_{window} {
  const PixelWindow around = surroundings(window, view);
  const int reach = reach_px(view);
  const auto square = static_cast<std::size_t>(2 * reach) + 1;
  const auto width = static_cast<std::size_t>(window.width());
  const std::size_t padded = width + square - 1;
  const auto before = static_cast<std::size_t>(around.left - (window.left - reach));  // outside the image
  const float below{static_cast<float>(below_m)};
  const float thickness_px{static_cast<float>(seen_thickness_px(view.point_size_px))};
  const float deepest_px{static_cast<float>(seen_depth_px(view.point_size_px))};
  limits_m_.resize(width * static_cast<std::size_t>(window.height()));

  const int rows_at_once = std::max(kRowsAtOnce, 2 * reach);  // each block begins with rows of the one before
  const auto blocks = static_cast<std::size_t>((window.height() + rows_at_once - 1) / rows_at_once);
  executor.parallel_for(blocks, 1, [&](std::size_t block, std::size_t) {
    const int top = window.top + static_cast<int>(block) * rows_at_once;
    const int bottom = std::min(window.bottom, top + rows_at_once);
    const auto rows = static_cast<std::size_t>(bottom - top) + square - 1;
    std::vector<float> shown_m(padded);
    std::vector<float> farthest_m(width * rows, kEmpty_m);  // shown around each pixel, along rows
    for (std::size_t row = 0; row < rows; ++row) {
      const int v = top - reach + static_cast<int>(row);
      if (v < around.top || v >= around.bottom) continue;
      const float* const depths_m = drawn.row(around.left, v);
      std::fill(shown_m.begin(), shown_m.end(), kEmpty_m);
      for (std::size_t u = 0; u < static_cast<std::size_t>(around.width()); ++u) {
        shown_m[before + u] = depths_m[u] < -kEmpty_m ? depths_m[u] : kEmpty_m;
      }
      combine_spans(square, [&](std::size_t by) {
        take_farther(shown_m.data(), shown_m.data() + by, padded - by, shown_m.data());
      });
      std::copy_n(shown_m.begin(), width, farthest_m.begin() + static_cast<std::ptrdiff_t>(row * width));
    }
    combine_spans(square, [&](std::size_t by) {  // then along columns
      take_farther(farthest_m.data(), farthest_m.data() + by * width, (rows - by) * width, farthest_m.data());
    });
    for (int v = top; v < bottom; ++v) {
      const float* const nearest_m = drawn.row(window.left, v);
      const float* const seen_m = farthest_m.data() + static_cast<std::size_t>(v - top) * width;
      float* const limits_m = limits_m_.data() + static_cast<std::size_t>(v - window.top) * width;
      for (std::size_t u = 0; u < width; ++u) {
        const float pixel_m = project.pixel_m(nearest_m[u]);
        const float deep_m = std::min(seen_m[u] - nearest_m[u] + thickness_px * pixel_m, deepest_px * pixel_m);
        limits_m[u] = nearest_m[u] + std::max(below, deep_m);
      }
    }
  });
}

}  // namespace saccade

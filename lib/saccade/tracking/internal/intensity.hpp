// SPDX-License-Identifier: Apache-2.0
#pragma once
// Grey images for the alignment of colours: of a colour image, halved, and with their slopes. 0 stands for unknown.

#include "saccade/core/executor.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

/// Returns (r + 2g + b) / 4, from 0 to 255. Black (0, 0, 0) stands for no colour, as where images are registered to
/// depth. O(pixels).
[[nodiscard]] Image<float> to_grey(const ColorImage& colors, const Executor& executor);

/// Returns every second pixel of every second row, smoothed before by the binomial filter of five pixels (Burt and
/// Adelson, IEEE Trans. Communications 1983), so that pixel (u, v) stays at (2u, 2v). The mean is over what is known;
/// unknown where that is less than half of the filter. O(pixels).
[[nodiscard]] Image<float> halved(const Image<float>& grey, const Executor& executor);

/// Returns grey over the mean around it, times 128: vignetting and exposure change it little. The mean is that of the
/// image halved until it is at most kFlatWidth wide. O(pixels).
[[nodiscard]] Image<float> flattened(const Image<float>& grey, const Executor& executor);
constexpr int kFlatWidth{40};

/// Differences of grey per pixel of this image.
struct Slopes {
  Image<float> along_u;
  Image<float> along_v;
  Image<float> known;  ///< 1 where the pixel and its four neighbours are known, else 0
};

/// Returns the central differences. O(pixels).
[[nodiscard]] Slopes slopes(const Image<float>& grey, const Executor& executor);

}  // namespace saccade

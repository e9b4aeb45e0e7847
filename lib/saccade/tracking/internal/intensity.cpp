// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/internal/intensity.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace saccade {
namespace {

constexpr std::size_t kGreyRows{16};
constexpr std::array<float, 5> kBinomial{1.0F / 16, 4.0F / 16, 6.0F / 16, 4.0F / 16, 1.0F / 16};

/// A row smoothed along u at every second pixel, and how much of the filter was known there.
struct SmoothRow {
  std::vector<float> grey;
  std::vector<float> known;
};

void smooth_row(const float* row, int width, SmoothRow& out) {
  for (std::size_t u = 0; u < out.grey.size(); ++u) {
    float sum{0.0F};
    float known{0.0F};
    for (int k = 0; k < 5; ++k) {
      const int at = std::clamp(2 * static_cast<int>(u) + k - 2, 0, width - 1);
      const float weight = row[at] > 0.0F ? kBinomial[static_cast<std::size_t>(k)] : 0.0F;
      sum += weight * row[at];
      known += weight;
    }
    out.grey[u] = sum;
    out.known[u] = known;
  }
}

}  // namespace

Image<float> to_grey(const ColorImage& colors, const Executor& executor) {
  Image<float> grey{colors.width(), colors.height()};
  executor.parallel_for(static_cast<std::size_t>(colors.height()), kGreyRows, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      const Rgb8* from = colors.row(v);
      float* to = grey.row(v);
      for (int u = 0; u < colors.width(); ++u) {
        to[u] = 0.25F * static_cast<float>(from[u][0] + 2 * from[u][1] + from[u][2]);
      }
    }
  });
  return grey;
}

Image<float> halved(const Image<float>& grey, const Executor& executor) {
  const int width = (grey.width() + 1) / 2;
  const int height = (grey.height() + 1) / 2;
  Image<float> half{width, height};
  executor.parallel_for(static_cast<std::size_t>(height), kGreyRows, [&](std::size_t begin, std::size_t end) {
    std::array<SmoothRow, 5> rows;
    for (SmoothRow& row : rows)
      row = {std::vector<float>(static_cast<std::size_t>(width)), std::vector<float>(static_cast<std::size_t>(width))};
    const auto slot = [&](int v) -> SmoothRow& { return rows[static_cast<std::size_t>((v + 5) % 5)]; };
    const auto fill = [&](int v) { smooth_row(grey.row(std::clamp(v, 0, grey.height() - 1)), grey.width(), slot(v)); };
    const int first = 2 * static_cast<int>(begin);
    for (int v = first - 2; v < first + 1; ++v) fill(v);
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
      fill(2 * row + 1);
      fill(2 * row + 2);
      float* out = half.row(row);
      for (int u = 0; u < width; ++u) {
        float sum{0.0F};
        float known{0.0F};
        for (int k = 0; k < 5; ++k) {
          const SmoothRow& smooth = slot(2 * row + k - 2);
          sum += kBinomial[static_cast<std::size_t>(k)] * smooth.grey[static_cast<std::size_t>(u)];
          known += kBinomial[static_cast<std::size_t>(k)] * smooth.known[static_cast<std::size_t>(u)];
        }
        out[u] = known >= 0.5F ? sum / known : 0.0F;
      }
    }
  });
  return half;
}

Image<float> flattened(const Image<float>& grey, const Executor& executor) {
  constexpr float kMiddle{128.0F};
  constexpr float kDark{8.0F};  // noise must not grow without end in the dark
  Image<float> mean = grey;
  float scale{1.0F};
  for (; mean.width() > kFlatWidth; scale *= 0.5F) mean = halved(mean, executor);
  Image<float> flat{grey.width(), grey.height()};
  executor.parallel_for(static_cast<std::size_t>(grey.height()), kGreyRows, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      const float y = static_cast<float>(v) * scale;
      const int row = std::min(static_cast<int>(y), mean.height() - 1);
      const float below = y - static_cast<float>(row);
      const float* upper = mean.row(row);
      const float* lower = mean.row(std::min(row + 1, mean.height() - 1));
      for (int u = 0; u < grey.width(); ++u) {
        const float x = static_cast<float>(u) * scale;
        const int column = std::min(static_cast<int>(x), mean.width() - 1);
        const int next = std::min(column + 1, mean.width() - 1);
        const float aside = x - static_cast<float>(column);
        if (!(grey(u, v) > 0.0F)) continue;
        if (!(upper[column] > 0.0F && upper[next] > 0.0F && lower[column] > 0.0F && lower[next] > 0.0F)) continue;
        const float above_mean = upper[column] + aside * (upper[next] - upper[column]);
        const float below_mean = lower[column] + aside * (lower[next] - lower[column]);
        flat(u, v) = kMiddle * grey(u, v) / (above_mean + below * (below_mean - above_mean) + kDark);
      }
    }
  });
  return flat;
}

Slopes slopes(const Image<float>& grey, const Executor& executor) {
  const int width = grey.width();
  const int height = grey.height();
  Slopes out{Image<float>{width, height}, Image<float>{width, height}, Image<float>{width, height}};
  executor.parallel_for(static_cast<std::size_t>(height), kGreyRows, [&](std::size_t begin, std::size_t end) {
    for (int v = std::max(1, static_cast<int>(begin)); v < std::min(height - 1, static_cast<int>(end)); ++v) {
      const float* above = grey.row(v - 1);
      const float* here = grey.row(v);
      const float* below = grey.row(v + 1);
      for (int u = 1; u + 1 < width; ++u) {
        const float least =
            std::min(std::min(std::min(here[u - 1], here[u + 1]), std::min(above[u], below[u])), here[u]);
        out.along_u(u, v) = 0.5F * (here[u + 1] - here[u - 1]);
        out.along_v(u, v) = 0.5F * (below[u] - above[u]);
        out.known(u, v) = least > 0.0F ? 1.0F : 0.0F;
      }
    }
  });
  return out;
}

}  // namespace saccade

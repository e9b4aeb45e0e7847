// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/png_filter.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace saccade {
namespace {

std::uint8_t paeth(int left, int up, int up_left) {
  const int to_left = std::abs(up - up_left);
  const int to_up = std::abs(left - up_left);
  const int to_up_left = std::abs(left + up - 2 * up_left);
  if (to_left <= to_up && to_left <= to_up_left) return static_cast<std::uint8_t>(left);
  return static_cast<std::uint8_t>(to_up <= to_up_left ? up : up_left);
}

std::uint8_t predict(int filter, int left, int up, int up_left) {
  switch (filter) {
    case 1: return static_cast<std::uint8_t>(left);
    case 2: return static_cast<std::uint8_t>(up);
    case 3: return static_cast<std::uint8_t>((left + up) / 2);
    case 4: return paeth(left, up, up_left);
    default: return 0;
  }
}

/// One row; `up` is the row above (zeros for the first). Both loops run once per byte of a pixel's stride, which is a
/// compile-time constant so that the compiler keeps the left pixel in registers.
template <int kFilter, std::size_t kStride>
void undo_row(const std::uint8_t* in, const std::uint8_t* up, std::uint8_t* out, std::size_t count) {
  std::uint8_t left[kStride]{};
  std::uint8_t up_left[kStride]{};
  for (std::size_t i = 0; i + kStride <= count; i += kStride) {
    for (std::size_t k = 0; k < kStride; ++k) {
      const std::uint8_t value =
          static_cast<std::uint8_t>(in[i + k] + predict(kFilter, left[k], up[i + k], up_left[k]));
      up_left[k] = up[i + k];
      left[k] = value;
      out[i + k] = value;
    }
  }
}

template <std::size_t kStride>
bool undo_row_of(int filter, const std::uint8_t* in, const std::uint8_t* up, std::uint8_t* out, std::size_t count) {
  switch (filter) {
    case 0: std::memcpy(out, in, count); return true;
    case 1: undo_row<1, kStride>(in, up, out, count); return true;
    case 2: undo_row<2, kStride>(in, up, out, count); return true;
    case 3: undo_row<3, kStride>(in, up, out, count); return true;
    case 4: undo_row<4, kStride>(in, up, out, count); return true;
    default: return false;
  }
}

bool undo_row_any(std::size_t stride, int filter, const std::uint8_t* in, const std::uint8_t* up, std::uint8_t* out,
                  std::size_t count) {
  switch (stride) {
    case 1: return undo_row_of<1>(filter, in, up, out, count);
    case 2: return undo_row_of<2>(filter, in, up, out, count);
    case 3: return undo_row_of<3>(filter, in, up, out, count);
    case 4: return undo_row_of<4>(filter, in, up, out, count);
    case 6: return undo_row_of<6>(filter, in, up, out, count);
    case 8: return undo_row_of<8>(filter, in, up, out, count);
    default: return false;
  }
}

std::uint8_t at_or_zero(const std::uint8_t* row, std::size_t i, std::size_t back) {
  return i >= back ? row[i - back] : 0;
}

}  // namespace

std::vector<std::uint8_t> undo_png_filters(const std::vector<std::uint8_t>& raw, std::size_t row_bytes,
                                           std::size_t pixel_bytes) {
  const std::size_t height = raw.size() / (row_bytes + 1);
  std::vector<std::uint8_t> rows(height * row_bytes);
  const std::vector<std::uint8_t> zeros(row_bytes);
  for (std::size_t v = 0; v < height; ++v) {
    const std::uint8_t* in = &raw[v * (row_bytes + 1)];
    const std::uint8_t* up = v > 0 ? &rows[(v - 1) * row_bytes] : zeros.data();
    if (!undo_row_any(pixel_bytes, in[0], in + 1, up, &rows[v * row_bytes], row_bytes)) return {};
  }
  return rows;
}

std::vector<std::uint8_t> apply_png_filters(const std::vector<std::uint8_t>& rows, std::size_t row_bytes,
                                            std::size_t pixel_bytes) {
  const std::size_t height = rows.size() / row_bytes;
  std::vector<std::uint8_t> raw;
  raw.reserve(height * (row_bytes + 1));
  const std::vector<std::uint8_t> zeros(row_bytes);
  std::vector<std::uint8_t> trial(row_bytes);
  std::vector<std::uint8_t> best(row_bytes);
  for (std::size_t v = 0; v < height; ++v) {
    const std::uint8_t* in = &rows[v * row_bytes];
    const std::uint8_t* up = v > 0 ? in - row_bytes : zeros.data();
    std::uint64_t best_cost = std::numeric_limits<std::uint64_t>::max();
    std::uint8_t best_filter = 0;
    for (std::uint8_t filter = 0; filter < 5; ++filter) {
      std::uint64_t cost = 0;
      for (std::size_t i = 0; i < row_bytes; ++i) {
        const std::uint8_t guess =
            predict(filter, at_or_zero(in, i, pixel_bytes), up[i], at_or_zero(up, i, pixel_bytes));
        trial[i] = static_cast<std::uint8_t>(in[i] - guess);
        cost += static_cast<std::uint64_t>(std::min<int>(trial[i], 256 - trial[i]));
      }
      if (cost < best_cost) {
        best_cost = cost;
        best_filter = filter;
        std::swap(trial, best);
      }
    }
    raw.push_back(best_filter);
    raw.insert(raw.end(), best.begin(), best.end());
  }
  return raw;
}

}  // namespace saccade

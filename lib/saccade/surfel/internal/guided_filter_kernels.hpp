// SPDX-License-Identifier: Apache-2.0
#pragma once
// The rows of the guided filter in vectors of pixels: loading, fits of depth to guidance, enhanced depth. For
// guided_filter.cpp.

#include <array>
#include <cstddef>
#include <cstdint>

namespace saccade::guided {

constexpr int kMaxRadius_px{16};
constexpr int kMargin{16};   ///< columns of zeros on either side of a row: the largest radius, and whole vectors
constexpr int kBlock{8};     ///< rows are padded with zeros to a multiple of it; the most lanes of a vector
constexpr int kStrip{64};    ///< columns that are summed at a time, so that the sums stay in the nearest cache
constexpr int kChannels{6};  ///< of a loaded row: 1 if used, r, g, b, d, d′; all 0 where a pixel is not used
constexpr int kMoments{20};  ///< products of two channels, (d′, d′) left out
constexpr int kFits{6};      ///< of a fitted row: a_r, a_g, a_b, a_d, b, 1 / pixels in the window; 0 where not used
constexpr int kSumColumns{kStrip + 2 * kMargin};

/// The window: column δu has rows −h … h. Columns of the same height share one sum, a level; those of height 0, the
/// first and the last, need none.
struct Disc {
  int radius_px{0};
  int levels{0};
  std::array<int, kMaxRadius_px + 1> level_of_column{};  ///< of |δu|
  std::array<int, kMaxRadius_px + 1> level_of_height{};  ///< −1: no column is so high
};
[[nodiscard]] Disc make_disc(int radius_px);

/// Doubles that the sums of a strip of two rows take: fit_rows' and enhance_rows' `sums`.
[[nodiscard]] constexpr std::size_t sums_of(const Disc& disc) {
  return std::size_t{2} * static_cast<std::size_t>(disc.levels) * kMoments * kSumColumns;
}

/// A row's planes are `stride` apart, multiples of 8. Column 0 is at `kMargin`.
struct RowShape {
  int width{0};         ///< pixels of the image
  int padded_width{0};  ///< and up to a multiple of kBlock
  std::size_t stride{0};
};

/// Diagonal of Σ_E.
struct Variances {
  double color{0.0};
  double depth_m2{0.0};
};

/// Depth, guidance (four floats to a pixel) and mask of one row into the planes of `row`, but for the margins.
void load_row(const RowShape& shape, const float* depth_m, const float* guidance, const std::uint8_t* used, float* row);

/// Fits of the pixels of rows[R] and rows[R + 1], the middle ones of 2R + 2 loaded rows.
void fit_rows(const RowShape& shape, const Disc& disc, const Variances& variances, const float* const* rows,
              double* sums, double* const* fits);

/// F_m(a)ᵀγ + F_m(b) of the pixels of two rows, whose fits are in the middle ones of 2R + 2 rows of fits; of whole
/// vectors of pixels, and anything where a pixel is not used.
void enhance_rows(const RowShape& shape, const Disc& disc, const float* const* rows, const double* const* fits,
                  double* sums, float* const* enhanced_m);

}  // namespace saccade::guided

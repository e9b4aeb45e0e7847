// SPDX-License-Identifier: Apache-2.0
#pragma once
// Rows of the guided filter in vectors of pixels: loading, fits of depth to guidance, enhanced depth. For
// guided_filter.cpp.

#include <array>
#include <cstddef>
#include <cstdint>

namespace saccade::guided {

constexpr int kMaxRadius_px{16};
constexpr int kMargin{16};   ///< columns of zeros on either side of a row: the largest radius, in whole vectors
constexpr int kBlock{8};     ///< rows are zero-padded to a multiple of this, the most lanes of a vector
constexpr int kStrip{64};    ///< columns summed at a time, so that the sums stay in the nearest cache
constexpr int kChannels{6};  ///< channels of a loaded row: 1 if used, r, g, b, d, d′; all 0 where a pixel is not used
constexpr int kMoments{20};  ///< products of two channels, without (d′, d′)
constexpr int kFits{6};      ///< values of a fitted row: a_r, a_g, a_b, a_d, b, 1 / pixels in the window; 0 where not
                             ///< used
constexpr int kSumColumns{kStrip + 2 * kMargin};

/// The window: column δu has rows −h … h. Columns of equal height share one sum, a level. The first and last columns
/// have height 0 and need none.
struct Disc {
  int radius_px{0};
  int levels{0};
  std::array<int, kMaxRadius_px + 1> level_of_column{};  ///< by |δu|
  std::array<int, kMaxRadius_px + 1> level_of_height{};  ///< −1 where no column has this height
};
[[nodiscard]] Disc make_disc(int radius_px);

/// Returns the doubles needed for the sums of a strip of two rows: fit_rows' and enhance_rows' `sums`.
[[nodiscard]] constexpr std::size_t sums_of(const Disc& disc) {
  return std::size_t{2} * static_cast<std::size_t>(disc.levels) * kMoments * kSumColumns;
}

/// Shape of a row. Its planes are `stride` apart, a multiple of 8. Column 0 is at `kMargin`.
struct RowShape {
  int width{0};         ///< pixels of the image
  int padded_width{0};  ///< width rounded up to a multiple of kBlock
  std::size_t stride{0};
};

/// Diagonal of Σ_E.
struct Variances {
  double color{0.0};
  double depth_m2{0.0};
};

/// Loads depth, guidance (four floats per pixel) and mask of one row into the planes of `row`, except the margins.
void load_row(const RowShape& shape, const float* depth_m, const float* guidance, const std::uint8_t* used, float* row);

/// Fits the pixels of rows[R] and rows[R + 1], the middle ones of 2R + 2 loaded rows.
void fit_rows(const RowShape& shape, const Disc& disc, const Variances& variances, const float* const* rows,
              double* sums, double* const* fits);

/// Computes F_m(a)ᵀγ + F_m(b) for the pixels of two rows, whose fits are in the middle of 2R + 2 rows of fits. Works on
/// whole vectors of pixels; the result is arbitrary where a pixel is not used.
void enhance_rows(const RowShape& shape, const Disc& disc, const float* const* rows, const double* const* fits,
                  double* sums, float* const* enhanced_m);

}  // namespace saccade::guided

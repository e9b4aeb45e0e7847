// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/obstacle_field.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "saccade/arm/internal/obstacle_kernels.hpp"

namespace saccade {
namespace {

constexpr std::size_t kRowsPerChunk{32};

std::size_t size_from(std::int32_t i) { return static_cast<std::size_t>(i); }

/// Returns the first cell from x on that is, or is not, an obstacle; `length` when there is none.
std::size_t next_cell(const std::uint64_t* row, std::size_t x, std::size_t length, bool obstacle) {
  for (std::size_t word = x / 64; word * 64 < length; ++word, x = word * 64) {
    const std::uint64_t bits = (obstacle ? row[word] : ~row[word]) & (~std::uint64_t{0} << (x % 64));
    if (bits != 0) return std::min(word * 64 + static_cast<std::size_t>(std::countr_zero(bits)), length);
  }
  return length;
}

/// Rows of a layered grid along one axis.
struct RowAxis {
  std::size_t length;
  std::size_t step;  ///< from one row to its neighbour
  std::size_t lines;
  std::size_t line_step;
};

/// Returns the rows within `reach` of a marked one along the axis, in order of lines.
std::vector<std::size_t> rows_within_reach(std::span<const std::uint8_t> marked, const RowAxis& axis,
                                           std::size_t reach) {
  std::vector<std::size_t> rows;
  for (std::size_t line = 0; line < axis.lines; ++line) {
    std::size_t done{0};
    for (std::size_t i = 0; i < axis.length; ++i) {
      if (marked[line * axis.line_step + i * axis.step] == 0) continue;
      const std::size_t end = std::min(i + reach + 1, axis.length);
      for (std::size_t k = std::max(done, i < reach ? 0 : i - reach); k < end; ++k) {
        rows.push_back(line * axis.line_step + k * axis.step);
      }
      done = end;
    }
  }
  return rows;
}

template <class Body>
void for_each_row(std::span<const std::size_t> rows, const Executor& executor, const Body& body) {
  executor.parallel_for(rows.size(), kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(rows[i]);
  });
}

/// Returns the window of rows up to `reach` before and after one along an axis.
obstacle::RowWindow window_around(const std::vector<std::uint16_t>& values, std::size_t row, std::size_t stride,
                                  const RowAxis& axis, std::size_t reach, const std::uint16_t* costs) {
  const std::size_t at = row / axis.step % axis.length;
  return {values.data() + row * stride, static_cast<std::ptrdiff_t>(axis.step * stride),
          static_cast<int>(std::min(at, reach)), static_cast<int>(std::min(axis.length - 1 - at, reach)), costs};
}

}  // namespace

ObstacleField::ObstacleField(const ObstacleCells& cells, int reach_cells, std::span<const Box> fixtures,
                             const Executor& executor)
    : reach_cells_{reach_cells}, size_{cells.size()} {
  SACCADE_EXPECTS(reach_cells >= 1 && reach_cells <= kMostReach_cells);
  const std::size_t length = size_from(size_.x);
  stride_ = (length + obstacle::kRowStep - 1) / obstacle::kRowStep * obstacle::kRowStep;
  const int limit = 4 * reach_cells * reach_cells;
  for (int k = 0; k <= reach_cells; ++k)
    costs_.push_back(static_cast<std::uint16_t>(k == 0 ? 0 : (2 * k - 1) * (2 * k - 1)));
  rising_.assign(length + 1, static_cast<std::uint16_t>(limit));
  std::copy_n(costs_.begin(), std::min(costs_.size(), rising_.size()), rising_.begin());
  falling_.assign(rising_.rbegin(), rising_.rend());
  const std::size_t padded = cells.row_count() * stride_;
  far_away_.assign(stride_, static_cast<std::uint16_t>(limit));
  if (!fixtures.empty()) fixtures_.assign(padded, static_cast<std::uint16_t>(limit));
  along_x_.assign(padded, static_cast<std::uint16_t>(limit));
  along_xy_.assign(padded, static_cast<std::uint16_t>(limit));
  distances_.assign(padded, reach());
  if (!fixtures.empty()) measure_fixtures(fixtures, cells, executor);
}

/// Measures distances from fixtures in half cells, rounded down.
void ObstacleField::measure_fixtures(std::span<const Box> fixtures, const ObstacleCells& cells,
                                     const Executor& executor) {
  constexpr double kRounding{1e-9};
  const Eigen::Vector3d origin = cells.bounds_of(cells.box().lo).min;
  const double scale = 2.0 / cells.cell_edge_m();
  std::vector<Box> boxes;
  for (const Box& box : fixtures) boxes.push_back({(box.min - origin) * scale, (box.max - origin) * scale});
  const double most = far_away_.front();
  const auto squared_gap = [](const Box& box, Eigen::Index axis, std::size_t cell) {
    const double centre = 2.0 * static_cast<double>(cell) + 1.0;
    const double gap = std::max({box.min[axis] - centre, centre - box.max[axis], 0.0});
    return gap * gap;
  };
  executor.parallel_for(cells.row_count(), kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      for (const Box& box : boxes) {
        const double aside =
            squared_gap(box, 1, row % size_from(size_.y)) + squared_gap(box, 2, row / size_from(size_.y));
        if (aside >= most) continue;
        for (std::size_t x = 0; x < size_from(size_.x); ++x) {
          std::uint16_t& least = fixtures_[row * stride_ + x];
          const double squared = std::floor((aside + squared_gap(box, 0, x)) * (1.0 - kRounding));
          least = static_cast<std::uint16_t>(std::min<double>(least, squared));
        }
      }
      for (std::size_t i = row * stride_; i < (row + 1) * stride_; ++i) {
        distances_[i] = std::sqrt(static_cast<float>(fixtures_[i]));
      }
    }
  });
}

/// Computes the squared distances of a row's cells from the obstacles of that row. Between two obstacles they rise to
/// the middle and fall again.
void ObstacleField::distances_along(const std::uint64_t* row, std::uint16_t* out) const {
  const std::size_t length = size_from(size_.x);
  for (std::size_t begin = 0; begin < length;) {
    const std::size_t gap = next_cell(row, begin, length, false);
    std::fill(out + begin, out + gap, std::uint16_t{0});
    const std::size_t end = next_cell(row, gap, length, true);
    const bool from_left = gap > 0;
    const bool to_right = end < length;
    if (!from_left && !to_right) {
      std::copy_n(far_away_.begin(), length, out);
      return;
    }
    const std::size_t middle = !from_left ? gap : !to_right ? end : gap + (end - gap + 1) / 2;
    std::copy_n(rising_.data() + 1, middle - gap, out + gap);                            // 1, 2 … from the left
    std::copy_n(falling_.data() + length - (end - middle), end - middle, out + middle);  // … 2, 1 to the right
    begin = end;
  }
}

void ObstacleField::update(const ObstacleCells& cells, const Executor& executor) {
  const auto layers = size_from(size_.z);
  const auto rows_per_layer = size_from(size_.y);
  const auto reach = size_from(reach_cells_);
  const std::size_t steps = stride_ / obstacle::kRowStep;
  const RowAxis along_y{rows_per_layer, 1, layers, rows_per_layer};
  const RowAxis along_z{layers, rows_per_layer, rows_per_layer, 1};

  for_each_row(rows_within_reach(cells.row_changed(), along_y, 0), executor,
               [&](std::size_t row) { distances_along(cells.row(row), along_x_.data() + row * stride_); });

  std::vector<std::uint8_t> changed(cells.row_count(), 0);
  for_each_row(rows_within_reach(cells.row_changed(), along_y, reach), executor, [&](std::size_t row) {
    const auto window = window_around(along_x_, row, stride_, along_y, reach, costs_.data());
    changed[row] = obstacle::min_across_rows(window, far_away_.data(), steps, along_xy_.data() + row * stride_) ? 1 : 0;
  });
  for_each_row(rows_within_reach(changed, along_z, reach), executor, [&](std::size_t row) {
    const auto window = window_around(along_xy_, row, stride_, along_z, reach, costs_.data());
    const std::uint16_t* limit = fixtures_.empty() ? far_away_.data() : fixtures_.data() + row * stride_;
    obstacle::root_of_min_across_rows(window, limit, steps, distances_.data() + row * stride_);
  });
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/internal/least_assignment.hpp"

#include <limits>

#include "saccade/core/result.hpp"

namespace saccade {

std::vector<std::size_t> least_assignment(const Eigen::MatrixXd& costs) {
  const Eigen::Index rows = costs.rows();
  const Eigen::Index columns = costs.cols();
  SACCADE_EXPECTS(rows <= columns);
  constexpr Eigen::Index kFree{-1};
  Eigen::VectorXd row_price = Eigen::VectorXd::Zero(rows);
  Eigen::VectorXd column_price = Eigen::VectorXd::Zero(columns);
  std::vector<Eigen::Index> row_of(static_cast<std::size_t>(columns), kFree);
  for (Eigen::Index start = 0; start < rows; ++start) {
    // Cheapest path from the row to a free column, through columns that other rows give up.
    Eigen::VectorXd cost = Eigen::VectorXd::Constant(columns, std::numeric_limits<double>::infinity());
    std::vector<Eigen::Index> from(static_cast<std::size_t>(columns), kFree);  // the column before; kFree: the start
    std::vector<bool> is_settled(static_cast<std::size_t>(columns), false);
    Eigen::Index row = start;
    Eigen::Index column = kFree;
    double so_far{0.0};
    while (true) {
      Eigen::Index best = kFree;
      for (Eigen::Index next = 0; next < columns; ++next) {
        const auto at = static_cast<std::size_t>(next);
        if (is_settled[at]) continue;
        const double by_row = so_far + costs(row, next) - row_price[row] - column_price[next];
        if (by_row < cost[next]) {
          cost[next] = by_row;
          from[at] = column;
        }
        if (best == kFree || cost[next] < cost[best]) best = next;
      }
      column = best;
      so_far = cost[best];
      if (row_of[static_cast<std::size_t>(best)] == kFree) break;
      is_settled[static_cast<std::size_t>(best)] = true;
      row = row_of[static_cast<std::size_t>(best)];
    }
    row_price[start] += so_far;
    for (Eigen::Index next = 0; next < columns; ++next) {
      const auto at = static_cast<std::size_t>(next);
      if (!is_settled[at]) continue;
      row_price[row_of[at]] += so_far - cost[next];
      column_price[next] -= so_far - cost[next];
    }
    while (column != kFree) {
      const auto at = static_cast<std::size_t>(column);
      row_of[at] = from[at] == kFree ? start : row_of[static_cast<std::size_t>(from[at])];
      column = from[at];
    }
  }
  std::vector<std::size_t> column_of(static_cast<std::size_t>(rows));
  for (std::size_t column = 0; column < row_of.size(); ++column) {
    if (row_of[column] != kFree) column_of[static_cast<std::size_t>(row_of[column])] = column;
  }
  return column_of;
}

}  // namespace saccade

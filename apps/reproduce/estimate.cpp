// SPDX-License-Identifier: Apache-2.0
#include "estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>

#include "saccade/map/tsdf_map.hpp"

namespace saccade::reproduce {
namespace {

constexpr double kReference_ms{5.0};  // measured_ms on the machine of TableEntry::cost

/// Milliseconds in which a wall is fused into a map, the least of a few.
double measured_ms(const Executor& executor) {
  constexpr int kRuns{4};
  PinholeCamera camera{320, 240, 262.5, 262.5, 159.5, 119.5, 0.5, 3.0};
  DepthImage depth{camera.width, camera.height, 1.5F};
  auto map = TsdfMap::create(TsdfConfig{});
  if (!map) return kReference_ms;
  double least_ms = std::numeric_limits<double>::infinity();
  for (int run = 0; run < kRuns; ++run) {
    const Stopwatch clock;
    const auto fused = map->integrate(camera, depth, Pose::Identity(), executor);
    if (!fused) return kReference_ms;
    if (run > 0) least_ms = std::min(least_ms, clock.elapsed_ms());  // the first one makes the bricks
  }
  return least_ms;
}

}  // namespace

double machine_factor(const Executor& executor) { return measured_ms(executor) / kReference_ms; }

std::string duration_text(double seconds) {
  const auto rounded = static_cast<long>(std::ceil(seconds));
  if (rounded < 90) return std::to_string(std::max(1L, rounded)) + " s";
  const long minutes = (rounded + 30) / 60;
  if (minutes < 90) return std::to_string(minutes) + " min";
  return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

Estimate::Estimate(const std::vector<const TableEntry*>& tables, bool quick, double factor) {
  std::vector<std::string_view> carried_out;
  for (const TableEntry* table : tables) {
    const bool is_done = !table->experiment.empty() &&
                         std::find(carried_out.begin(), carried_out.end(), table->experiment) != carried_out.end();
    carried_out.push_back(table->experiment);
    const double alone_s = quick ? table->cost.quick_s : table->cost.full_s;
    expected_s_.push_back(is_done ? 0.0 : factor * alone_s);
  }
}

double Estimate::total_s() const { return std::accumulate(expected_s_.begin(), expected_s_.end(), 0.0); }

void Estimate::done(std::size_t table, double took_s) {
  took_s_ += took_s;
  next_ = table + 1;
}

double Estimate::left_s(double running_s) const {
  double expected_so_far_s = 0.0;
  for (std::size_t i = 0; i < next_; ++i) expected_so_far_s += expected_s_[i];
  // Tables that took next to no time say nothing about the machine.
  constexpr double kEnough_s{10.0};
  const double pace = expected_so_far_s > kEnough_s ? took_s_ / expected_so_far_s : 1.0;
  double left_s = 0.0;
  for (std::size_t i = next_; i < expected_s_.size(); ++i) left_s += pace * expected_s_[i];
  const double of_this_s = next_ < expected_s_.size() ? pace * expected_s_[next_] : 0.0;
  return left_s - std::min(running_s, of_this_s);
}

}  // namespace saccade::reproduce

// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/segmented_points.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "saccade/attention/internal/isolation.hpp"
#include "saccade/cloud/point_cloud.hpp"

namespace saccade {

namespace {

constexpr std::size_t kPointGrain{8192};
constexpr std::size_t kSegmentGrain{64};

/// Calls body(segment, begin, end, sums) for each run of one segment's points in a chunk of all points, and adds up the
/// results in the order of the points by `to += from`.
template <class Sums, class Body>
std::vector<Sums> sum_by_segment(const SegmentedPoints& points, const Executor& executor, const Body& body) {
  const std::size_t count = points.start_of(points.segments());  // those in no segment come last
  std::vector<std::vector<std::pair<std::size_t, Sums>>> chunks((count + kPointGrain - 1) / kPointGrain);
  executor.parallel_for(count, kPointGrain, [&](std::size_t begin, std::size_t end) {
    while (begin < end) {
      const std::size_t segment = points.segment_of()[begin];
      const std::size_t last = std::min(end, points.start_of(segment + 1));
      auto& made = chunks[begin / kPointGrain].emplace_back(segment, Sums{});
      body(segment, begin, last, made.second);
      begin = last;
    }
  });
  std::vector<Sums> sums(points.segments());
  for (const auto& chunk : chunks) {
    for (const auto& [segment, part] : chunk) sums[segment] += part;
  }
  return sums;
}

/// Moments relative to a segment's first point, so that precision is kept far from the origin.
struct Moments {
  Eigen::Vector3d sum{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d squares{Eigen::Matrix3d::Zero()};

  void operator+=(const Moments& other) {
    sum += other.sum;
    squares += other.squares;
  }
};

/// Extents along the three principal axes, and along x, y, z.
struct Extents {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  Vector6 least{Vector6::Constant(std::numeric_limits<double>::infinity())};
  Vector6 most{Vector6::Constant(-std::numeric_limits<double>::infinity())};

  void operator+=(const Extents& other) {
    least = least.cwiseMin(other.least);
    most = most.cwiseMax(other.most);
  }
};

std::vector<Moments> moments_of(const SegmentedPoints& points, const Executor& executor) {
  return sum_by_segment<Moments>(points, executor,
                                 [&](std::size_t segment, std::size_t begin, std::size_t end, Moments& moments) {
                                   const Eigen::Vector3d origin = points.points_of(segment).front().cast<double>();
                                   for (std::size_t i = begin; i < end; ++i) {
                                     const Eigen::Vector3d p = points.positions_m()[i].cast<double>() - origin;
                                     moments.sum += p;
                                     moments.squares.noalias() += p * p.transpose();
                                   }
                                 });
}

void find_axes(const SegmentedPoints& points, const std::vector<Moments>& moments, const Executor& executor,
               std::vector<SegmentMeasures>& measures) {
  executor.parallel_for(measures.size(), kSegmentGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const std::span<const Eigen::Vector3f> of_segment = points.points_of(s);
      if (of_segment.empty()) continue;
      const auto count = static_cast<double>(of_segment.size());
      const Eigen::Vector3d mean = moments[s].sum / count;
      const Eigen::Matrix3d covariance = moments[s].squares / count - mean * mean.transpose();
      measures[s].points = of_segment.size();
      measures[s].mean_m = of_segment.front().cast<double>() + mean;
      measures[s].axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{covariance}.eigenvectors();
    }
  });
}

void find_sizes(const SegmentedPoints& points, const Executor& executor, std::vector<SegmentMeasures>& measures) {
  const std::vector<Extents> extents = sum_by_segment<Extents>(
      points, executor, [&](std::size_t segment, std::size_t begin, std::size_t end, Extents& found) {
        const Eigen::Vector3d origin = points.points_of(segment).front().cast<double>();
        const Eigen::Matrix3d to_box = measures[segment].axes.transpose();
        for (std::size_t i = begin; i < end; ++i) {
          const Eigen::Vector3d p = points.positions_m()[i].cast<double>();
          Extents::Vector6 at;
          at << to_box * (p - origin), p;
          found.least = found.least.cwiseMin(at);
          found.most = found.most.cwiseMax(at);
        }
      });
  for (std::size_t s = 0; s < measures.size(); ++s) {
    if (measures[s].points == 0) continue;
    measures[s].sizes_m = extents[s].most.head<3>() - extents[s].least.head<3>();
    measures[s].lowest_m = extents[s].least.tail<3>();
    measures[s].highest_m = extents[s].most.tail<3>();
    const double longest_m = measures[s].sizes_m.maxCoeff();
    if (longest_m > 0.0) measures[s].roundness = measures[s].sizes_m.minCoeff() / longest_m;
  }
}

}  // namespace

Result<SegmentedPoints> SegmentedPoints::create(std::span<const Eigen::Vector3f> positions_m,
                                                std::span<const std::uint32_t> labels, std::size_t segments) {
  if (positions_m.size() != labels.size()) {
    return Error{Errc::size_mismatch, "as many labels as points are needed", "segments"};
  }
  SegmentedPoints made;
  made.starts_.assign(segments + 2, 0);
  const auto group_of = [&](std::size_t i) -> std::size_t {
    return labels[i] == kUnlabelled ? segments : std::size_t{labels[i]};
  };
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!positions_m[i].allFinite()) continue;
    if (group_of(i) > segments || (labels[i] != kUnlabelled && group_of(i) == segments)) {
      return Error{Errc::invalid_argument, "there is no segment " + std::to_string(labels[i]),
                   "point " + std::to_string(i)};
    }
    made.starts_[group_of(i) + 1] += 1;
  }
  for (std::size_t s = 0; s <= segments; ++s) made.starts_[s + 1] += made.starts_[s];
  made.positions_m_.resize(made.starts_.back());
  made.segment_of_.resize(made.starts_.back());
  std::vector<std::size_t> next{made.starts_};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!positions_m[i].allFinite()) continue;
    const std::size_t at = next[group_of(i)]++;
    made.positions_m_[at] = positions_m[i];
    made.segment_of_[at] = static_cast<std::uint32_t>(group_of(i));
  }
  return made;
}

Status MeasureConfig::validate() const {
  if (std::isfinite(isolation_distance_m) && isolation_distance_m > 0.0) return {};
  return Error{Errc::invalid_argument, "isolation_distance_m must be positive", "segments"};
}

Result<std::vector<SegmentMeasures>> measure_segments(const SegmentedPoints& points, const MeasureConfig& config,
                                                      const Executor& executor) {
  SACCADE_CHECK(config.validate());
  std::vector<SegmentMeasures> measures(points.segments());
  find_axes(points, moments_of(points, executor), executor, measures);
  find_sizes(points, executor, measures);
  const std::vector<std::uint8_t> isolated = isolated_points(points, config.isolation_distance_m, executor);
  for (std::size_t s = 0; s < measures.size(); ++s) {
    if (measures[s].points == 0) continue;
    const auto first = isolated.begin() + static_cast<std::ptrdiff_t>(points.start_of(s));
    const auto count = std::count(first, first + static_cast<std::ptrdiff_t>(measures[s].points), std::uint8_t{1});
    measures[s].isolation = static_cast<double>(count) / static_cast<double>(measures[s].points);
  }
  return measures;
}

}  // namespace saccade

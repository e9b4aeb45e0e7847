// SPDX-License-Identifier: Apache-2.0
// Oriented boxes and isolation of segments, beside going through all points, and of segments with nothing to measure.
#include "saccade/attention/segmented_points.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <random>

#include "saccade/attention/internal/isolation.hpp"
#include "saccade/cloud/point_cloud.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr float kNoNumber{std::numeric_limits<float>::quiet_NaN()};

struct LabelledPoints {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<std::uint32_t> labels;
  std::size_t segments{0};

  void add(const Eigen::Vector3f& p, std::uint32_t label) {
    positions_m.push_back(p);
    labels.push_back(label);
    if (label != kUnlabelled) segments = std::max<std::size_t>(segments, label + 1);
  }
  [[nodiscard]] SegmentedPoints grouped() const {
    return SegmentedPoints::create(positions_m, labels, segments).value();
  }
  [[nodiscard]] std::vector<SegmentMeasures> measured(const MeasureConfig& config = {}) const {
    return measure_segments(grouped(), config, Executor{}).value();
  }
};

/// Eq. 3.11 as it is written.
double naive_isolation(const LabelledPoints& points, std::uint32_t segment, double distance_m) {
  std::size_t size{0}, isolated{0};
  for (std::size_t i = 0; i < points.labels.size(); ++i) {
    if (points.labels[i] != segment || !points.positions_m[i].allFinite()) continue;
    bool alone{true};
    for (std::size_t k = 0; k < points.labels.size() && alone; ++k) {
      if (points.labels[k] == segment || !points.positions_m[k].allFinite()) continue;
      const Eigen::Vector3d between = (points.positions_m[i] - points.positions_m[k]).cast<double>();
      alone = between.squaredNorm() > distance_m * distance_m;
    }
    size += 1;
    isolated += alone ? 1 : 0;
  }
  return size == 0 ? 0.0 : static_cast<double>(isolated) / static_cast<double>(size);
}

/// Balls, sheets and dots in a cube of 0.4 m, on a lattice of 2^-10 m so that many distances are equal; some points
/// twice, some in no segment, some no points at all.
LabelledPoints random_segments(std::mt19937& random) {
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution{low, high}(random); };
  const auto on_lattice = [](double x) { return static_cast<float>(std::round(x * 1024.0) / 1024.0); };
  LabelledPoints points;
  const int segments = std::uniform_int_distribution{1, 7}(random);
  for (int s = 0; s < segments; ++s) {
    const Eigen::Vector3d middle{uniform(-0.2, 0.2), uniform(-0.2, 0.2), uniform(-0.2, 0.2)};
    const Eigen::Vector3d half{uniform(0.0, 0.15), uniform(0.0, 0.15), uniform(0.0, 0.05)};
    const int count = std::uniform_int_distribution{1, 200}(random);
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d p =
          middle + half.cwiseProduct(Eigen::Vector3d{uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.0, 1.0)});
      const double kind = uniform(0.0, 1.0);
      const Eigen::Vector3f rounded{on_lattice(p.x()), on_lattice(p.y()), on_lattice(p.z())};
      points.add(kind < 0.02 ? Eigen::Vector3f{rounded.x(), kNoNumber, 0.0F} : rounded,
                 kind > 0.97 ? kUnlabelled : static_cast<std::uint32_t>(s));
      if (kind > 0.4 && kind < 0.5) points.add(rounded, static_cast<std::uint32_t>(s));
    }
  }
  return points;
}

TEST(Isolation, IsThatOfGoingThroughAllPoints) {
  std::mt19937 random{7};
  int compared{0}, between{0};
  for (int run = 0; run < test::scaled_cases(120); ++run) {
    const LabelledPoints points = random_segments(random);
    for (const double distance_m : {1.0 / 1024.0, 5.0 / 1024.0, 0.02, 0.1, 1.0}) {
      const auto measures = points.measured({distance_m});
      const auto parallel = measure_segments(points.grouped(), {distance_m}, Executor::with_threads(3)).value();
      for (std::uint32_t s = 0; s < measures.size(); ++s) {
        const double expected = naive_isolation(points, s, distance_m);
        ASSERT_EQ(measures[s].isolation, expected) << "run " << run << ", segment " << s << ", " << distance_m << " m";
        ASSERT_EQ(parallel[s].isolation, expected);
        compared += 1;
        between += expected > 0.0 && expected < 1.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GE(compared, test::scaled_cases(120) * 5);
  EXPECT_GT(between, compared / 10);
}

TEST(Isolation, CountsPointsBeyondTheDistanceOnly) {
  LabelledPoints points;
  points.add({0.0F, 0.0F, 0.0F}, 0);
  points.add({0.25F, 0.0F, 0.0F}, 1);
  EXPECT_EQ(points.measured({0.25})[0].isolation, 0.0);  // "> B_th", not "≥"
  EXPECT_EQ(points.measured({0.2499})[0].isolation, 1.0);
  points.labels[1] = kUnlabelled;  // a point in no segment is not in S either
  EXPECT_EQ(points.measured({0.25})[0].isolation, 0.0);
  LabelledPoints alone;
  alone.add({0.0F, 0.0F, 0.0F}, 0);
  EXPECT_EQ(alone.measured()[0].isolation, 1.0);
}

/// A cloud that would take hours if points were compared one by one.
TEST(Isolation, TakesAMillionDuplicatesAndHugeDistances) {
  const int count = test::scaled_cases(500000);
  LabelledPoints points;
  for (int i = 0; i < count; ++i) {
    points.add({0.0F, 0.0F, 0.0F}, 0);
    points.add({0.021F, 0.0F, 0.0F}, 1);
  }
  EXPECT_EQ(points.measured({0.02})[0].isolation, 1.0);
  EXPECT_EQ(points.measured({0.022})[0].isolation, 0.0);
  EXPECT_EQ(points.measured({1e6})[1].isolation, 0.0);
  EXPECT_EQ(points.measured({1e-9})[1].isolation, 1.0);  // beyond what cells can be numbered
}

TEST(SegmentMeasures, AreThoseOfATurnedBox) {
  const Eigen::Matrix3f turn{Eigen::AngleAxisf{0.7F, Eigen::Vector3f{1.0F, 2.0F, -1.0F}.normalized()}};
  const Eigen::Vector3f at{3.0F, -2.0F, 40.0F};
  LabelledPoints points;
  for (int x = -10; x <= 10; ++x) {
    for (int y = -6; y <= 6; ++y) {
      for (int z = -3; z <= 3; ++z) {
        const Eigen::Vector3i i{x, y, z};
        points.add(at + turn * (0.01F * i.cast<float>()), 1);
      }
    }
  }
  points.add({kNoNumber, 0.0F, 0.0F}, 1);
  const auto measures = points.measured();
  ASSERT_EQ(measures.size(), 2U);
  EXPECT_EQ(measures[0].points, 0U);  // a segment without points
  EXPECT_EQ(measures[0].roundness, 0.0);
  const SegmentMeasures& box = measures[1];
  EXPECT_EQ(box.points, 21U * 13U * 7U);
  EXPECT_TRUE(box.mean_m.isApprox(at.cast<double>(), 1e-5));
  EXPECT_TRUE(box.sizes_m.isApprox(Eigen::Vector3d{0.06, 0.12, 0.20}, 1e-3)) << box.sizes_m.transpose();
  EXPECT_NEAR(box.roundness, 0.06 / 0.20, 1e-3);
  EXPECT_NEAR(std::abs(box.axes.col(0).dot(turn.col(2).cast<double>())), 1.0, 1e-6);
  for (std::size_t i = 0; i + 1 < points.positions_m.size(); ++i) {
    const Eigen::Vector3d p = points.positions_m[i].cast<double>();
    EXPECT_TRUE((p.array() >= box.lowest_m.array()).all() && (p.array() <= box.highest_m.array()).all());
  }
}

/// Eq. 3.8–3.10 as they are written, by other means.
TEST(SegmentMeasures, AreThoseOfADirectComputation) {
  std::mt19937 random{5};
  std::normal_distribution<double> normal;
  int compared{0};
  for (int run = 0; run < test::scaled_cases(200); ++run) {
    const int count = std::uniform_int_distribution{4, 60}(random);
    LabelledPoints points;
    Eigen::MatrixX3d rows{count, 3};
    const Eigen::Matrix3d turn = Eigen::Quaterniond{normal(random), normal(random), normal(random), normal(random)}
                                     .normalized()
                                     .toRotationMatrix();
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d p =
          turn * Eigen::Vector3d{0.4 * normal(random), 0.2 * normal(random), 0.1 * normal(random)};
      points.add(p.cast<float>(), 0);
      rows.row(i) = points.positions_m.back().cast<double>();
    }
    const Eigen::MatrixX3d centred = rows.rowwise() - rows.colwise().mean();
    const Eigen::JacobiSVD<Eigen::MatrixX3d> svd{centred, Eigen::ComputeFullV};
    const Eigen::Vector3d spread = svd.singularValues();
    if (spread[1] > 0.95 * spread[0] || spread[2] > 0.95 * spread[1]) continue;  // axes that are not determined well
    const Eigen::MatrixX3d along = centred * svd.matrixV();
    const Eigen::Vector3d sizes_m = along.colwise().maxCoeff() - along.colwise().minCoeff();
    const SegmentMeasures measures = points.measured()[0];
    EXPECT_TRUE(measures.sizes_m.isApprox(sizes_m.reverse(), 1e-6)) << run;
    EXPECT_NEAR(measures.roundness, sizes_m.minCoeff() / sizes_m.maxCoeff(), 1e-6);
    ++compared;
  }
  EXPECT_GT(compared, test::scaled_cases(200) / 2);
}

TEST(SegmentMeasures, OfABallAreRoundAndNotOfALeaf) {
  std::mt19937 random{3};
  std::normal_distribution<float> normal;
  LabelledPoints points;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3f direction = Eigen::Vector3f{normal(random), normal(random), normal(random)}.normalized();
    points.add(0.1F * direction, 0);
    points.add(Eigen::Vector3f{1.0F, 0.0F, 0.0F} + Eigen::Vector3f{0.3F, 0.2F, 0.0F}.cwiseProduct(direction), 1);
  }
  const auto measures = points.measured();
  EXPECT_GT(measures[0].roundness, 0.98);
  EXPECT_EQ(measures[1].roundness, 0.0);
}

TEST(SegmentMeasures, OfPointsLinesAndPlanesAreNotRound) {
  LabelledPoints points;
  points.add({0.3F, 0.1F, -7.0F}, 0);                             // one point
  for (int i = 0; i < 9; ++i) points.add({0.1F, 0.7F, 0.3F}, 1);  // one place
  for (int i = 0; i < 9; ++i) points.add(static_cast<float>(i) * Eigen::Vector3f{0.01F, 0.02F, 0.0F}, 2);
  for (int i = 0; i < 81; ++i)
    points.add({0.01F * static_cast<float>(i / 9), 0.0F, 0.01F * static_cast<float>(i % 9)}, 3);
  points.add({1.0F, 0.0F, 0.0F}, 4);  // two points
  points.add({1.0F, 0.5F, 0.0F}, 4);
  for (const SegmentMeasures& segment : points.measured()) {
    EXPECT_GT(segment.points, 0U);
    EXPECT_NEAR(segment.roundness, 0.0, 1e-6);
    EXPECT_TRUE(segment.axes.allFinite());
    EXPECT_TRUE((segment.axes.transpose() * segment.axes).isIdentity(1e-9));
    EXPECT_TRUE((segment.sizes_m.array() >= 0.0).all());
  }
}

TEST(SegmentMeasures, AreTheSameForEveryThreadCount) {
  std::mt19937 random{11};
  std::uniform_real_distribution<float> uniform{-1.0F, 1.0F};
  LabelledPoints points;
  for (int i = 0; i < 60000; ++i) {
    const Eigen::Vector3f p{uniform(random), uniform(random), 0.2F * uniform(random)};
    points.add(p, p.x() > 0.5F ? 0U : (p.y() > 0.0F ? 1U : 2U));
  }
  const SegmentedPoints grouped = points.grouped();
  const auto one = measure_segments(grouped, {}, Executor{}).value();
  const auto four = measure_segments(grouped, {}, Executor::with_threads(4)).value();
  ASSERT_EQ(one.size(), 3U);
  for (std::size_t s = 0; s < one.size(); ++s) {
    EXPECT_EQ(one[s].axes, four[s].axes);
    EXPECT_EQ(one[s].sizes_m, four[s].sizes_m);
    EXPECT_EQ(one[s].mean_m, four[s].mean_m);
    EXPECT_EQ(one[s].isolation, four[s].isolation);
  }
}

TEST(SegmentedPoints, RefusesWhatDoesNotFit) {
  const std::vector<Eigen::Vector3f> two(2, Eigen::Vector3f::Zero());
  EXPECT_EQ(SegmentedPoints::create(two, std::vector<std::uint32_t>{0}, 1).error().code, Errc::size_mismatch);
  EXPECT_EQ(SegmentedPoints::create(two, std::vector<std::uint32_t>{0, 1}, 1).error().code, Errc::invalid_argument);
  const SegmentedPoints none = SegmentedPoints::create({}, {}, 0).value();
  EXPECT_TRUE(measure_segments(none, {}, Executor{}).value().empty());
  EXPECT_FALSE(measure_segments(none, {0.0}, Executor{}));
  EXPECT_FALSE(measure_segments(none, {std::nan("")}, Executor{}));
}

}  // namespace
}  // namespace saccade

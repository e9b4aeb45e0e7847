// SPDX-License-Identifier: Apache-2.0
// The vector kernels of camera tracking equal plain loops to the bit: random images, sizes, strides and poses; every
// instruction set that the kernels were compiled for and that this machine has.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "saccade/core/simd.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/tracking/icp.hpp"
#include "saccade/tracking/internal/icp_kernels.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr std::uint32_t kIcpSeed{4211};

using Point = std::array<float, 3>;

float dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// One pixel of linearize_rows, without vectors.
void reference_pixel(const PairingTask& task, int row, int column, PairSums& sums) {
  const auto& R = task.R;
  const auto at = static_cast<std::ptrdiff_t>(row) * task.measured.width + column;
  const float z = task.measured.z[at];
  if (!(z > 0.0F)) return;
  const int stride = task.measured.stride;
  const Point camera{(static_cast<float>(column * stride) - task.cx) * task.inverse_fx * z,
                     (static_cast<float>(row * stride) - task.cy) * task.inverse_fy * z, z};
  const Point p{dot({R[0], R[1], R[2]}, camera) + task.t[0], dot({R[3], R[4], R[5]}, camera) + task.t[1],
                dot({R[6], R[7], R[8]}, camera) + task.t[2]};
  if (!(p[2] > kMinModelDepth_m)) return;
  const float inverse_z = 1.0F / p[2];
  const float u = p[0] * inverse_z * task.fx + (task.cx + 0.5F);
  const float v = p[1] * inverse_z * task.fy + (task.cy + 0.5F);
  if (!(u >= 0.0F && u < static_cast<float>(task.model.width))) return;
  if (!(v >= 0.0F && v < static_cast<float>(task.model.height))) return;
  const auto pixel = static_cast<std::ptrdiff_t>(v) * task.model.width + static_cast<std::ptrdiff_t>(u);
  const float model_z = task.model.z[pixel];
  if (!(model_z > 0.0F)) return;
  const Point q{(std::trunc(u) - task.cx) * task.inverse_fx * model_z,
                (std::trunc(v) - task.cy) * task.inverse_fy * model_z, model_z};
  const Point difference = minus(p, q);
  if (!(dot(difference, difference) <= task.max_squared_distance_m2)) return;
  const Point n{task.model.nx[pixel], task.model.ny[pixel], task.model.nz[pixel]};
  const Point n_camera{dot({R[0], R[3], R[6]}, n), dot({R[1], R[4], R[7]}, n), dot({R[2], R[5], R[8]}, n)};
  if (!(dot(n_camera, {task.measured.nx[at], task.measured.ny[at], task.measured.nz[at]}) > task.min_normal_cosine)) {
    return;
  }
  const float residual = dot(n, difference);
  const float beyond = std::max(z - DepthSigma::kFrom_m, 0.0F);
  const float sigma = DepthSigma::kNearest_m + DepthSigma::kGrowth_per_m * (beyond * beyond);
  const float weight = 1e-6F / (sigma * std::max(sigma, std::fabs(residual) * (1.0F / kHuberSigmas)));
  const Point turn = cross(p, n);
  const std::array<float, 7> J{turn[0], turn[1], turn[2], n[0], n[1], n[2], residual};
  const auto lane = static_cast<std::size_t>(column % kPairLanes);
  std::size_t product{0};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = i; j < 7; ++j) sums.products[product++][lane] += weight * J[i] * J[j];
  }
  sums.squared_residuals[lane] += residual * residual;
  ++sums.pairs;
}

LevelPoints level_of(const PointImage& image, int stride) {
  return {image.z.data(), image.nx.data(), image.ny.data(), image.nz.data(), image.z.width(), image.z.height(), stride};
}

class RandomIcpStep {
 public:
  explicit RandomIcpStep(std::uint32_t seed) : random_{seed} {
    const int width = 1 + whole(90);
    const int height = 1 + whole(24);
    const int stride = 1 << whole(3);
    model = image(width, height);
    measured = image((width + stride - 1) / stride, (height + stride - 1) / stride);
    task.measured = level_of(measured, stride);
    task.model = level_of(model, 1);
    task.fx = real(20.0F, 80.0F);
    task.fy = real(20.0F, 80.0F);
    task.cx = 0.5F * static_cast<float>(width);
    task.cy = 0.5F * static_cast<float>(height);
    task.inverse_fx = 1.0F / task.fx;
    task.inverse_fy = 1.0F / task.fy;
    task.max_squared_distance_m2 = whole(2) == 0 ? 0.01F : 0.0025F;
    task.min_normal_cosine = 0.8F;
    const float reach = whole(4) == 0 ? 2.0F : 0.05F;  // some far off, with points behind the camera
    const Eigen::Vector3f axis = Eigen::Vector3f{real(-1.0F, 1.0F), real(-1.0F, 1.0F), 1.5F}.normalized();
    Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>{task.R.data()} =
        Eigen::AngleAxisf{real(-reach, reach), axis}.toRotationMatrix();
    task.t = {real(-reach, reach), real(-reach, reach), real(-reach, reach)};
  }

  PointImage model;
  PointImage measured;
  PairingTask task;

 private:
  float real(float lo, float hi) { return std::uniform_real_distribution<float>{lo, hi}(random_); }
  int whole(int below) { return static_cast<int>(random_() % static_cast<unsigned>(below)); }

  PointImage image(int width, int height) {
    PointImage made{Image<float>{width, height}, Image<float>{width, height}, Image<float>{width, height},
                    Image<float>{width, height}};
    const int holes = 2 + whole(20);  // one hole in this number of pixels
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        if (whole(holes) == 0) continue;
        made.z(u, v) = real(0.98F, 1.02F) * (whole(30) == 0 ? 2.5F : 0.9F);
        if (whole(holes) == 0) continue;  // no normal
        const Eigen::Vector3f n = Eigen::Vector3f{real(-0.6F, 0.6F), real(-0.6F, 0.6F), -1.0F}.normalized();
        made.nx(u, v) = n.x();
        made.ny(u, v) = n.y();
        made.nz(u, v) = n.z();
      }
    }
    return made;
  }

  std::mt19937 random_;
};

TEST(IcpParity, SumsOverPairsEqualPlainLoopsToTheBit) {
  std::cout << "seed " << kIcpSeed << "\n";
  const int cases = test::scaled_cases(400);
  std::size_t pairs{0};
  std::size_t compared{0};
  for (int i = 0; i < cases; ++i) {
    const RandomIcpStep c{kIcpSeed + static_cast<std::uint32_t>(i)};
    PairSums expected;
    for (int row = 0; row < c.task.measured.height; ++row) {
      for (int column = 0; column < c.task.measured.width; ++column) reference_pixel(c.task, row, column, expected);
    }
    for (const std::string& target : simd_targets()) {
      ASSERT_TRUE(use_simd_target(target).ok());
      PairSums sums;
      const int half = c.task.measured.height / 2;
      linearize_rows(c.task, 0, half, sums);
      linearize_rows(c.task, half, c.task.measured.height, sums);
      ASSERT_EQ(sums.pairs, expected.pairs) << "case " << i << " on " << target;
      ASSERT_EQ(sums.products, expected.products) << "case " << i << " on " << target;
      ASSERT_EQ(sums.squared_residuals, expected.squared_residuals) << "case " << i << " on " << target;
      pairs += sums.pairs;
      ++compared;
    }
    ASSERT_TRUE(use_simd_target("").ok());
  }
  EXPECT_EQ(compared, static_cast<std::size_t>(cases) * simd_targets().size());
  EXPECT_GT(pairs, compared * 20);
}

/// to_points for one pixel, without vectors.
std::array<float, 4> reference_point(const DepthImage& depth, const PinholeCamera& camera, int u, int v) {
  const auto z_at = [&](int column, int row) {
    if (column < 0 || row < 0 || column >= depth.width() || row >= depth.height()) return 0.0F;
    const float d = depth(column, row);
    return d >= static_cast<float>(camera.min_range_m) && d <= static_cast<float>(camera.max_range_m) ? d : 0.0F;
  };
  const auto point = [&](int column, int row) {
    const auto ray_x = (static_cast<float>(column) - static_cast<float>(camera.cx)) * static_cast<float>(1 / camera.fx);
    const auto ray_y = (static_cast<float>(row) - static_cast<float>(camera.cy)) * static_cast<float>(1 / camera.fy);
    return Point{ray_x, ray_y, z_at(column, row)};
  };
  const Point here = point(u, v);
  const auto near_or_here = [&](int column, int row) {
    const Point there = point(column, row);
    return there[2] > 0.0F && std::fabs(there[2] - here[2]) < 0.03F * here[2] ? there : here;
  };
  const Point above = near_or_here(u, v - 3);
  const Point below = near_or_here(u, v + 3);
  const Point left = near_or_here(u - 3, v);
  const Point right = near_or_here(u + 3, v);
  const float down_z = below[2] - above[2];
  const float right_z = right[2] - left[2];
  const Point n = cross({here[0] * down_z, below[1] * below[2] - above[1] * above[2], down_z},
                        {right[0] * right[2] - left[0] * left[2], here[1] * right_z, right_z});
  const float norm = std::sqrt(dot(n, n));
  const float scale = norm > 0.0F ? 1.0F / norm : 0.0F;
  return {here[2], n[0] * scale, n[1] * scale, n[2] * scale};
}

TEST(IcpParity, PointsAndNormalsEqualPlainLoopsToTheBit) {
  std::cout << "seed " << kIcpSeed << "\n";
  const int cases = test::scaled_cases(60);
  std::mt19937 random{kIcpSeed};
  const auto whole = [&](int below) { return static_cast<int>(random() % static_cast<unsigned>(below)); };
  std::size_t normals{0};
  for (int i = 0; i < cases; ++i) {
    const int width = 1 + whole(60);
    const int height = 1 + whole(40);
    const PinholeCamera camera{width, height, 40.0, 44.0, 0.5 * width, 0.45 * height, 0.3, 2.0};
    DepthImage depth{width, height};
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const std::array<float, 5> odd{0.0F, -1.0F, NAN, 7.0F, 1.3F};
        depth(u, v) = whole(8) == 0
                          ? odd[static_cast<std::size_t>(whole(5))]
                          : 0.9F + 0.001F * static_cast<float>(u - v) + 0.00001F * static_cast<float>(whole(900));
      }
    }
    for (const std::string& target : simd_targets()) {
      ASSERT_TRUE(use_simd_target(target).ok());
      const PointImage image = to_points(depth, camera, Executor::with_threads(2));
      for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
          const std::array<float, 4> pixel{image.z(u, v), image.nx(u, v), image.ny(u, v), image.nz(u, v)};
          ASSERT_EQ(pixel, reference_point(depth, camera, u, v))
              << u << ", " << v << " of case " << i << " on " << target;
          normals += pixel[3] < 0.0F ? 1 : 0;
        }
      }
    }
    ASSERT_TRUE(use_simd_target("").ok());
  }
  EXPECT_GT(normals, static_cast<std::size_t>(cases) * 200);
}

TEST(IcpParity, AViewOfTheMapKeepsItsPixels) {
  const int width{37};
  const int height{21};
  SurfaceView view{DepthImage{width, height}, Image<Eigen::Vector3f>{width, height, Eigen::Vector3f::Zero()}, {}};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      view.depth(u, v) = static_cast<float>(u + v);
      view.normals(u, v) = Eigen::Vector3f{static_cast<float>(u), static_cast<float>(v), static_cast<float>(u * v)};
    }
  }
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(use_simd_target(target).ok());
    const PointImage image = to_points(view, Executor::with_threads(2));
    EXPECT_EQ(image.z, view.depth) << target;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        ASSERT_EQ((Eigen::Vector3f{image.nx(u, v), image.ny(u, v), image.nz(u, v)}), view.normals(u, v)) << target;
      }
    }
  }
  ASSERT_TRUE(use_simd_target("").ok());
}

TEST(IcpParity, AlignmentNeitherDependsOnTheInstructionSetNorOnThreads) {
  const PinholeCamera camera{203, 150, 170.0, 170.0, 101.0, 74.5, 0.2, 3.0};
  const Executor executor = Executor::with_threads(2);
  const std::vector<Pose> poses = sample_trajectory(120);
  const auto before = render(sample_tabletop(), camera, poses[0], executor);
  const auto after = render(sample_tabletop(), camera, poses[1], executor);
  ASSERT_TRUE(before.ok() && after.ok());
  const Pose expected = poses[0].inverse() * poses[1];
  std::optional<IcpResult> first;
  int runs{0};
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(use_simd_target(target).ok());
    for (const std::size_t threads : {1U, 2U, 7U}) {
      const Executor these = Executor::with_threads(threads);
      const PointImage model = to_points(before->depth, camera, these);
      const PointImage measured = to_points(after->depth, camera, these);
      const IcpResult result = align(measured, model, camera, Pose::Identity(), these);
      if (!first) first = result;
      EXPECT_TRUE(result.T_model_camera.matrix() == first->T_model_camera.matrix()) << target << ", " << threads;
      EXPECT_EQ(result.rmse_m, first->rmse_m);
      EXPECT_EQ(result.inlier_share, first->inlier_share);
      EXPECT_EQ(result.iterations, first->iterations);
      ++runs;
    }
  }
  ASSERT_TRUE(use_simd_target("").ok());
  EXPECT_EQ(runs, static_cast<int>(3 * simd_targets().size()));
  EXPECT_TRUE(first->converged) << first->why;
  EXPECT_LT((first->T_model_camera.translation() - expected.translation()).norm(), 0.002);
  EXPECT_GT(first->inlier_share, 0.5);
}

}  // namespace
}  // namespace saccade

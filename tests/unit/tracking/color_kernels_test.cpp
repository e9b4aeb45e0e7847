// SPDX-License-Identifier: Apache-2.0
// The vector kernel of aligning colours equals plain loops to the bit: random images, sizes, strides and poses, on
// every instruction set that this machine has. Its derivatives are those of its differences.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "saccade/core/simd.hpp"
#include "saccade/tracking/internal/alignment.hpp"
#include "saccade/tracking/internal/color_alignment.hpp"
#include "saccade/tracking/internal/color_kernels.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr std::uint32_t kColorSeed{733};

/// One pixel of linearize_color_rows, without vectors.
void reference_grey(const ColorTask& task, int row, int column, ColorSums& sums) {
  const auto& R = task.R;
  const auto dot = [](float ax, float ay, float az, float bx, float by, float bz) {
    return (ax * bx + ay * by) + az * bz;
  };
  const auto at = static_cast<std::ptrdiff_t>(row) * task.measured.width + column;
  const float z = task.measured.z[at];
  const float grey = task.measured_grey[at];
  if (!(z > 0.0F) || !(grey > 0.0F)) return;
  const int stride = task.measured.stride;
  const float x = (static_cast<float>(column * stride) - task.cx) * task.inverse_fx * z;
  const float y = (static_cast<float>(row * stride) - task.cy) * task.inverse_fy * z;
  const float px = dot(R[0], R[1], R[2], x, y, z) + task.t[0];
  const float py = dot(R[3], R[4], R[5], x, y, z) + task.t[1];
  const float pz = dot(R[6], R[7], R[8], x, y, z) + task.t[2];
  if (!(pz > kMinModelDepth_m)) return;
  const float level = 1.0F / static_cast<float>(stride);
  const float inverse_z = 1.0F / pz;
  const float u = (px * inverse_z * task.fx + task.cx) * level;
  const float v = (py * inverse_z * task.fy + task.cy) * level;
  if (!(u + 0.5F >= 0.0F && u + 0.5F < static_cast<float>(task.reference.width))) return;
  if (!(v + 0.5F >= 0.0F && v + 0.5F < static_cast<float>(task.reference.height))) return;
  const int model_u = static_cast<int>(u + 0.5F);
  const int model_v = static_cast<int>(v + 0.5F);
  const int pixel = model_v * task.reference.width + model_u;
  const float model_z = task.reference.z[pixel];
  if (!(model_z > 0.0F) || !(std::fabs(pz - model_z) <= kSameSurface_m + kSameSurfaceGrowth * model_z)) return;
  const float slope_u = task.reference.slope_u[pixel];
  const float slope_v = task.reference.slope_v[pixel];
  const float aside = slope_u * (u - static_cast<float>(model_u));
  const float below = slope_v * (v - static_cast<float>(model_v));
  const float reference = task.reference.grey[pixel] + (aside + below);
  const float r = reference - task.gain * grey;
  const float gx = slope_u * (task.fx * level) * inverse_z;
  const float gy = slope_v * (task.fy * level) * inverse_z;
  const float gz = (0.0F - (gx * px + gy * py)) * inverse_z;
  const float w = 1e-6F / (task.sigma * std::max(task.sigma, std::fabs(r) * (1.0F / kColorHuberSigmas)));
  const std::array<float, 7> J{py * gz - pz * gy, pz * gx - px * gz, px * gy - py * gx, gx, gy, gz, r};
  const auto lane = static_cast<std::size_t>(column % kPairLanes);
  std::size_t product{0};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = i; j < 7; ++j) sums.products[product++][lane] += w * J[i] * J[j];
  }
  sums.reference[lane] += reference;
  sums.measured[lane] += grey;
  ++sums.pairs;
  if (std::fabs(r) < kAgreeingSigmas * task.sigma) ++sums.agreeing;
}

/// Random images of one level; some values are missing.
class RandomColorStep {
 public:
  explicit RandomColorStep(std::uint32_t seed) : random_{seed} {
    const int width = 1 + whole(90);
    const int height = 1 + whole(24);
    const int stride = 1 << whole(3);
    fill(z_, width * height, 0.98F, 1.02F);
    fill(grey_, width * height, 1.0F, 255.0F);
    fill(model_z_, width * height, 0.96F, 1.04F);
    fill(model_grey_, width * height, 1.0F, 255.0F);
    fill(slope_u_, width * height, -40.0F, 40.0F);
    fill(slope_v_, width * height, -40.0F, 40.0F);
    task.measured = {z_.data(), nullptr, nullptr, nullptr, width, height, stride};
    task.measured_grey = grey_.data();
    task.reference = {model_z_.data(), model_grey_.data(), slope_u_.data(), slope_v_.data(), width, height};
    task.fx = real(20.0F, 80.0F) * static_cast<float>(stride);
    task.fy = real(20.0F, 80.0F) * static_cast<float>(stride);
    task.cx = 0.5F * static_cast<float>(width * stride);
    task.cy = 0.5F * static_cast<float>(height * stride);
    task.inverse_fx = 1.0F / task.fx;
    task.inverse_fy = 1.0F / task.fy;
    task.gain = real(0.8F, 1.25F);
    task.sigma = real(2.0F, 20.0F);
    const float reach = whole(4) == 0 ? 2.0F : 0.03F;  // some far off, with points behind the camera
    const Eigen::Vector3f axis = Eigen::Vector3f{real(-1.0F, 1.0F), real(-1.0F, 1.0F), 1.5F}.normalized();
    Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>{task.R.data()} =
        Eigen::AngleAxisf{real(-reach, reach), axis}.toRotationMatrix();
    task.t = {real(-reach, reach), real(-reach, reach), real(-reach, reach)};
  }

  ColorTask task;

 private:
  float real(float lo, float hi) { return std::uniform_real_distribution<float>{lo, hi}(random_); }
  int whole(int below) { return static_cast<int>(random_() % static_cast<unsigned>(below)); }
  void fill(std::vector<float>& values, int count, float lo, float hi) {
    for (int i = 0; i < count; ++i) values.push_back(whole(12) == 0 ? 0.0F : real(lo, hi));
  }

  std::mt19937 random_;
  std::vector<float> z_, grey_, model_z_, model_grey_, slope_u_, slope_v_;
};

TEST(ColorKernels, SumsEqualPlainLoopsToTheBit) {
  std::cout << "seed " << kColorSeed << "\n";
  const int cases = test::scaled_cases(400);
  std::size_t pairs{0};
  for (int i = 0; i < cases; ++i) {
    const RandomColorStep c{kColorSeed + static_cast<std::uint32_t>(i)};
    ColorSums expected;
    for (int row = 0; row < c.task.measured.height; ++row) {
      for (int column = 0; column < c.task.measured.width; ++column) reference_grey(c.task, row, column, expected);
    }
    for (const std::string& target : simd_targets()) {
      ASSERT_TRUE(use_simd_target(target).ok());
      ColorSums sums;
      const int half = c.task.measured.height / 2;
      linearize_color_rows(c.task, 0, half, sums);
      linearize_color_rows(c.task, half, c.task.measured.height, sums);
      ASSERT_EQ(sums.pairs, expected.pairs) << "case " << i << " on " << target;
      ASSERT_EQ(sums.agreeing, expected.agreeing) << "case " << i << " on " << target;
      ASSERT_EQ(sums.products, expected.products) << "case " << i << " on " << target;
      ASSERT_EQ(sums.reference, expected.reference) << "case " << i << " on " << target;
      ASSERT_EQ(sums.measured, expected.measured) << "case " << i << " on " << target;
    }
    pairs += expected.pairs;
  }
  ASSERT_TRUE(use_simd_target("").ok());
  EXPECT_GT(pairs, 20U * static_cast<std::size_t>(cases));
}

/// A wall with a smooth pattern, seen twice.
struct PaintedWall {
  PinholeCamera camera{64, 48, 60.0, 60.0, 31.5, 23.5, 0.1, 3.0};
  PointImage points{Image<float>{64, 48, 1.0F}, Image<float>{64, 48}, Image<float>{64, 48},
                    Image<float>{64, 48, -1.0F}};

  [[nodiscard]] Image<float> grey_from(double right_m) const {
    Image<float> grey{64, 48};
    for (int v = 0; v < 48; ++v) {
      for (int u = 0; u < 64; ++u) {
        const Eigen::Vector3d p = camera.ray(u, v);
        grey(u, v) =
            static_cast<float>(120.0 + 50.0 * std::sin(14.0 * (p.x() + right_m)) + 40.0 * std::cos(11.0 * p.y()));
      }
    }
    return grey;
  }
};

TEST(ColorKernels, ASmallShiftIsFoundByOneStep) {
  const PaintedWall wall;
  const Image<float> measured = wall.grey_from(0.004);
  const Image<float> model = wall.grey_from(0.0);
  const Level level{wall.points, 1};
  const ColorLevel colors{level.points(), measured, wall.points.z, model, wall.camera, Executor{}};
  const ColorEquations sums = colors.linearize(Pose::Identity(), 1.0, 10.0, Executor{});
  EXPECT_EQ(sums.pairs, 62U * 46U);  // none at the border, which has no slope
  // Along x alone: the derivative of the wall's pattern tells 4 mm.
  EXPECT_NEAR(-sums.sums.Jtr(3) / sums.sums.JtJ(3, 3), 0.004, 0.0004);
  const Executor seven = Executor::with_threads(7);
  EXPECT_TRUE(colors.linearize(Pose::Identity(), 1.0, 10.0, seven).sums.JtJ == sums.sums.JtJ);
}

TEST(GreyImages, HalvingKeepsPlacesAndSkipsTheUnknown) {
  Image<float> ramp{33, 17};
  for (int v = 0; v < 17; ++v) {
    for (int u = 0; u < 33; ++u) ramp(u, v) = static_cast<float>(20 + 3 * u + 2 * v);
  }
  const Image<float> half = halved(ramp, Executor{});
  ASSERT_EQ(half.width(), 17);
  ASSERT_EQ(half.height(), 9);
  EXPECT_FLOAT_EQ(half(5, 4), ramp(10, 8));
  ramp(10, 8) = 0.0F;
  EXPECT_NEAR(halved(ramp, Executor{})(5, 4), 20.0F + 30.0F + 16.0F, 1e-3F);  // the mean of what is around
  const Slopes slope = slopes(ramp, Executor{});
  EXPECT_FLOAT_EQ(slope.along_u(5, 5), 3.0F);
  EXPECT_FLOAT_EQ(slope.along_v(5, 5), 2.0F);
  EXPECT_EQ(slope.known(5, 5), 1.0F);
  EXPECT_EQ(slope.known(10, 7), 0.0F);
  EXPECT_EQ(slope.known(0, 5), 0.0F);
  EXPECT_TRUE(halved(ramp, Executor::with_threads(3)) == halved(ramp, Executor{}));
}

}  // namespace
}  // namespace saccade

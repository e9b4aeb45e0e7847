// SPDX-License-Identifier: Apache-2.0
// The mode filter against Algorithm 6 as it is printed, on random frames: equal modes in the same order.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr std::uint64_t kModeSeed{29};
constexpr PinholeCamera kNaiveCamera{32, 24, 26.25, 26.25, 15.5, 11.5, 0.3, 6.0};

/// Colours in 8-bit levels, so that those that are equally far apart are so here too; weights as the filter adds them.
struct NaiveMode {
  Eigen::Vector3d c;
  float w;
  Eigen::Vector3d p;
};

NaiveMode merged(const NaiveMode& a, const NaiveMode& b) {
  const double wa = double{a.w};
  const double wb = double{b.w};
  return {(a.c * wa + b.c * wb) / (wa + wb), a.w + b.w, (a.p * wa + b.p * wb) / (wa + wb)};
}

double density(const Eigen::Vector3d& c, const Eigen::Vector3d& mean, double sigma) {
  return std::exp(-(c - mean).squaredNorm() / (2.0 * sigma * sigma));
}

Eigen::Vector3d levels(const Rgb8& color) { return {double(color[0]), double(color[1]), double(color[2])}; }

/// Lines 1–26, with the enhanced depth given.
void algorithm_6(std::vector<NaiveMode>& M, const NaiveMode& measured, const Eigen::Vector3d& p_enhanced,
                 const ModeFilterConfig& config) {
  if (M.empty()) {
    M.push_back(measured);
    return;
  }
  const double sigma = config.guided.color_sigma * 255.0;
  std::size_t n{0};
  for (std::size_t i = 1; i < M.size(); ++i) {
    if ((M[i].c - measured.c).norm() < (M[n].c - measured.c).norm()) n = i;
  }
  if ((M[n].c - measured.c).norm() > config.color_sigmas * sigma) {
    if (static_cast<int>(M.size()) > config.max_modes - 1) {
      std::size_t r{0};
      for (std::size_t i = 1; i < M.size(); ++i) {
        if (M[i].w < M[r].w) r = i;
      }
      M.erase(M.begin() + static_cast<std::ptrdiff_t>(r));
    }
    M.push_back(measured);
    return;
  }
  M[n] = merged(M[n], {measured.c, measured.w, p_enhanced});
  std::vector<bool> gone(M.size());
  for (std::size_t i = 0; i < M.size(); ++i) {
    if (i == n) continue;
    if (density(M[i].c, M[n].c, sigma) * static_cast<double>(M[n].w) >
        density(M[i].c, M[i].c, sigma) * static_cast<double>(M[i].w)) {
      M[n] = merged(M[n], M[i]);
      gone[i] = true;
    }
  }
  std::vector<NaiveMode> kept;
  for (std::size_t i = 0; i < M.size(); ++i) {
    if (!gone[i]) kept.push_back(M[i]);
  }
  M = kept;
}

/// One frame: guidance from the modes at its beginning, then pixel by pixel in row-major order.
void naive_frame(std::map<SurfelId, std::vector<NaiveMode>>& modes, const Frame& frame, const SurfelAssociation& seen,
                 const ModeFilterConfig& config) {
  const std::size_t pixels = frame.depth.size();
  std::vector<Eigen::Vector4f> guidance(pixels, Eigen::Vector4f::Zero());
  std::vector<std::uint8_t> used(pixels);
  std::vector<float> enhanced(frame.depth.pixels());
  for (std::size_t i = 0; i < pixels; ++i) {
    const SurfelId id = seen.of_pixel.data()[i];
    if (id == kNoSurfel || modes[id].empty()) continue;
    const Eigen::Vector3d c = levels(frame.color->data()[i]);
    const NaiveMode* nearest = &modes[id].front();
    for (const NaiveMode& mode : modes[id]) {
      if ((mode.c - c).norm() < (nearest->c - c).norm()) nearest = &mode;
    }
    if ((nearest->c - c).norm() > config.color_sigmas * config.guided.color_sigma * 255.0) continue;
    guidance[i] << (nearest->c / 255.0).cast<float>(),
        static_cast<float>((seen.T_world_camera.inverse() * nearest->p).z());
    used[i] = 1;
  }
  if (config.enhance_depth) {
    GuidedFilter filter{config.guided};
    filter.apply(frame.depth.width(), frame.depth.height(), frame.depth.pixels(), guidance, used, {}, enhanced);
  }
  for (int v = 0; v < frame.depth.height(); ++v) {
    for (int u = 0; u < frame.depth.width(); ++u) {
      const SurfelId id = seen.of_pixel(u, v);
      if (id == kNoSurfel) continue;
      const float d_e = enhanced[static_cast<std::size_t>(v * frame.depth.width() + u)];
      const auto point = [&](float depth_m) -> Eigen::Vector3d {
        return seen.T_world_camera * (seen.camera.ray(u, v) * double{depth_m});
      };
      algorithm_6(modes[id], {levels((*frame.color)(u, v)), seen.weight(u, v), point(frame.depth(u, v))}, point(d_e),
                  config);
    }
  }
}

TEST(ModeFilterProperty, EqualsAlgorithm6AsItIsPrinted) {
  const int cases = test::scaled_cases(24);
  std::printf("seed %llu, %d cases\n", static_cast<unsigned long long>(kModeSeed), cases);
  std::mt19937_64 random{kModeSeed};
  std::size_t compared{0};
  std::size_t several{0};
  std::size_t guided{0};
  std::size_t merged_modes{0};
  std::size_t evicted{0};
  for (int i = 0; i < cases; ++i) {
    ModeFilterConfig config;
    config.max_modes = i % 2 == 0 ? 4 : 1 + static_cast<int>(random() % 10);
    config.color_sigmas = i % 2 == 0 ? 1.0 : static_cast<double>(1 + random() % 6);
    config.enhance_depth = random() % 4 != 0;
    SurfelFusion fusion = SurfelFusion::create().value();
    ModeFilter filter = ModeFilter::create(config).value();
    std::map<SurfelId, std::vector<NaiveMode>> naive;
    const Executor executor = Executor::with_threads(1 + random() % 3);
    for (int f = 0; f < 12; ++f) {
      Frame frame;
      frame.depth = DepthImage{kNaiveCamera.width, kNaiveCamera.height, 0.8F};
      frame.color = ColorImage{kNaiveCamera.width, kNaiveCamera.height};
      for (std::size_t k = 0; k < frame.depth.size(); ++k) {
        frame.depth.data()[k] += 0.006F * (static_cast<float>(random() % 1000) / 1000.0F);
        if (random() % 50 == 0) frame.depth.data()[k] = 0.0F;
        const auto base = static_cast<std::uint8_t>(random() % 3 * 60);
        // Near levels, the middle ones more often: modes that grow together.
        const std::uint64_t off = random() % 3 + random() % 3 + random() % 3;
        frame.color->data()[k] = {static_cast<std::uint8_t>(base + off), base, 90};
      }
      const double step = static_cast<double>(random() % 100) / 1000.0;
      frame.T_world_camera = Pose{Eigen::Translation3d{step, 0.3 * step, 2.0 * step}};
      ASSERT_TRUE(fusion.add_frame(frame, kNaiveCamera, executor));
      const auto report = filter.add_frame(frame, fusion.association(), executor);
      ASSERT_TRUE(report);
      guided += report->guided;
      merged_modes += report->merged_modes;
      evicted += report->evicted_modes;
      naive_frame(naive, frame, fusion.association(), config);
    }
    for (SurfelId id = 0; id < filter.size(); ++id) {
      const std::vector<SurfelMode> ours = filter.modes(id);
      const std::vector<NaiveMode>& theirs = naive[id];
      ASSERT_EQ(ours.size(), theirs.size()) << "case " << i << ", surfel " << id;
      several += ours.size() > 1 ? 1U : 0U;
      for (std::size_t k = 0; k < ours.size(); ++k, ++compared) {
        ASSERT_LE((ours[k].color.cast<double>() - theirs[k].c / 255.0).norm(), 2e-6);
        ASSERT_LE((ours[k].position_m.cast<double>() - theirs[k].p).norm(), 2e-6);
        ASSERT_EQ(ours[k].weight, theirs[k].w);
      }
    }
  }
  EXPECT_GT(compared, static_cast<std::size_t>(cases) * 700U);
  EXPECT_GT(several, static_cast<std::size_t>(cases) * 200U);
  EXPECT_GT(guided, static_cast<std::size_t>(cases) * 500U);
  EXPECT_GT(merged_modes, static_cast<std::size_t>(cases));
  EXPECT_GT(evicted, static_cast<std::size_t>(cases) * 100U);
  std::printf("compared %zu modes; %zu pixels guided, %zu modes merged, %zu evicted\n", compared, guided, merged_modes,
              evicted);
}

/// Two colours farther apart than Kσ_c, in any order: the heavier wins.
TEST(ModeFilterProperty, TheOrderOfFarColoursDoesNotMatter) {
  const int cases = test::scaled_cases(60);
  std::mt19937_64 random{kModeSeed};
  std::size_t decided{0};
  for (int i = 0; i < cases; ++i) {
    ModeFilterConfig config;
    config.max_modes = 2 + static_cast<int>(random() % 9);
    const std::array<Rgb8, 2> colors{Rgb8{std::uint8_t(random() % 100), 20, 30}, Rgb8{200, std::uint8_t(random()), 90}};
    std::vector<std::size_t> order(3 + random() % 12);
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = random() % 2;
    const std::array<long, 2> times{std::count(order.begin(), order.end(), 0U),
                                    std::count(order.begin(), order.end(), 1U)};
    if (times[0] == times[1]) continue;
    const Rgb8& heavier = colors[times[1] > times[0] ? 1 : 0];
    for (int again = 0; again < 3; ++again) {
      std::shuffle(order.begin(), order.end(), random);
      SurfelFusion fusion = SurfelFusion::create().value();
      ModeFilter filter = ModeFilter::create(config).value();
      for (const std::size_t which : order) {
        Frame frame;
        frame.depth = DepthImage{kNaiveCamera.width, kNaiveCamera.height, 0.8F};
        frame.color = ColorImage{kNaiveCamera.width, kNaiveCamera.height, colors[which]};
        frame.T_world_camera = Pose::Identity();
        ASSERT_TRUE(fusion.add_frame(frame, kNaiveCamera, {}));
        ASSERT_EQ(filter.add_frame(frame, fusion.association(), {}).value().evicted_modes, 0U);
      }
      for (const SurfelMode& winner : filter.winners({})) {
        ASSERT_LE((winner.color - unit_color(heavier)).norm(), 1e-6F) << "case " << i;
        ++decided;
      }
    }
  }
  EXPECT_GT(decided, static_cast<std::size_t>(cases) * 1000U);
}

}  // namespace
}  // namespace saccade

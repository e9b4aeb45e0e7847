// SPDX-License-Identifier: Apache-2.0
// Final colours of surfels when neighbours' modes count: narrow things reappear, and nothing else changes.
#include "saccade/surfel/internal/mode_sharpening.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "saccade/surfel/internal/mode_choice.hpp"

namespace saccade {
namespace {

constexpr double kPageBandwidth{0.02};
constexpr double kSpacing_m{0.002};
const Eigen::Vector3f kPaper{0.9F, 0.9F, 0.85F};
const Eigen::Vector3f kInk{0.2F, 0.1F, 0.4F};

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// Surfels of a plane, 2 mm apart, of paper and a share of ink; noise has made three modes of each colour.
class Page {
 public:
  using Share = std::function<double(double x_m, double y_m)>;

  Page(double from_m, double to_m, const Share& ink) {
    std::mt19937_64 random{11};
    std::uniform_real_distribution<double> jitter_m{-0.3 * kSpacing_m, 0.3 * kSpacing_m};
    std::normal_distribution<double> noise{0.0, 0.008};
    for (double y = -0.03; y < 0.03; y += kSpacing_m) {
      for (double x = from_m; x < to_m; x += kSpacing_m) {
        const Eigen::Vector3d at{x + jitter_m(random), y + jitter_m(random), 1.0 + 0.5 * jitter_m(random)};
        places_m.push_back(at);
        store.resize(places_m.size());
        const StoredModes modes = store.modes(static_cast<SurfelId>(places_m.size() - 1));
        const double share = ink(at.x(), at.y());
        for (const auto& [color, weight] : {std::pair{kPaper, 1.0 - share}, std::pair{kInk, share}}) {
          if (weight < 0.01) continue;
          for (int i = 0; i < 3; ++i) {
            const auto units = [&](float channel) {
              return static_cast<std::int32_t>((channel + noise(random)) * 255.0 * ColorUnits::kPerLevel);
            };
            modes.add({units(color.x()), units(color.y()), units(color.z())}, at.cast<float>(),
                      static_cast<float>(20.0 * weight));
          }
        }
      }
    }
  }

  [[nodiscard]] std::vector<SurfelMode> sharpened(std::size_t threads = 1) const {
    return sharpened_modes(store, {}, kPageBandwidth, Executor::with_threads(threads));
  }
  [[nodiscard]] SurfelMode densest(std::size_t k) const {
    const auto id = static_cast<SurfelId>(k);
    std::vector<SurfelMode> modes;
    for (std::size_t i = 0; i < store.count(id); ++i) modes.push_back(store.mode(id, i));
    return densest_mode(modes, kPageBandwidth);
  }

  ModeStore store{10};
  std::vector<Eigen::Vector3d> places_m;
};

bool is_ink(const SurfelMode& mode) { return (mode.color - kInk).norm() < (mode.color - kPaper).norm(); }

/// A stroke of 6 mm that poses wrong by 6 mm spread over 2 cm: nowhere has it most of the weight.
TEST(ModeSharpening, ABlurredStrokeComesBack) {
  const Page page{-0.05, 0.05,
                  [](double x, double) { return normal_cdf((x + 0.003) / 0.006) - normal_cdf((x - 0.003) / 0.006); }};
  const std::vector<SurfelMode> sharpened = page.sharpened();
  std::size_t in_stroke{0};
  for (std::size_t k = 0; k < sharpened.size(); ++k) {
    ASSERT_FALSE(is_ink(page.densest(k)));
    const double x = std::abs(page.places_m[k].x());
    if (std::abs(page.places_m[k].y()) > 0.02) continue;  // too few neighbours there
    if (x < 0.002) {
      ++in_stroke;
      EXPECT_TRUE(is_ink(sharpened[k])) << k;
    }
    if (x > 0.007) {
      EXPECT_FALSE(is_ink(sharpened[k])) << k;
    }
    EXPECT_LT(std::min((sharpened[k].color - kInk).norm(), (sharpened[k].color - kPaper).norm()), 0.02F)
        << "one of the two and nothing in between";
  }
  EXPECT_GT(in_stroke, 30U);
}

TEST(ModeSharpening, StraightEdgesStay) {
  const Page page{-0.05, 0.05, [](double x, double) { return normal_cdf(x / 0.006); }};
  const std::vector<SurfelMode> sharpened = page.sharpened();
  for (std::size_t k = 0; k < sharpened.size(); ++k) {
    const double x = page.places_m[k].x();
    if (std::abs(x) > 0.001) {
      EXPECT_EQ(is_ink(sharpened[k]), x > 0.0) << x;
    }
    EXPECT_EQ(sharpened[k].position_m, page.densest(k).position_m);
  }
}

/// Before a step in depth: what is nearer has left its colour on the rim of what is behind.
TEST(ModeSharpening, ARimKeepsItsOwnColour) {
  const Page page{0.0, 0.06, [](double x, double) { return 0.45 * std::exp(-std::max(x, 0.0) / 0.004); }};
  for (const SurfelMode& mode : page.sharpened()) EXPECT_FALSE(is_ink(mode));
}

TEST(ModeSharpening, WhatASingleSurfelSawIsNoThing) {
  std::size_t asked{0};  // 50 in a row: never two side by side
  const Page page{-0.05, 0.05, [&](double, double) { return ++asked % 37 == 0 ? 0.4 : 0.0; }};
  for (const SurfelMode& mode : page.sharpened()) EXPECT_FALSE(is_ink(mode));
}

TEST(ModeSharpening, ThreadsChangeNoBit) {
  const Page page{-0.05, 0.05,
                  [](double x, double y) { return 0.5 + 0.5 * std::sin(700.0 * x) * std::cos(500.0 * y); }};
  const std::vector<SurfelMode> one = page.sharpened();
  for (const std::size_t threads : {2U, 5U}) {
    const std::vector<SurfelMode> other = page.sharpened(threads);
    ASSERT_EQ(other.size(), one.size());
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(SurfelMode)), 0);
  }
}

/// Reference implementation: every surfel compared with every other, in double precision.
class NaiveSharpening {
 public:
  explicit NaiveSharpening(const std::vector<std::vector<SurfelMode>>& surfels) : surfels_{surfels} {}

  struct Answer {
    Eigen::Vector3f color;
    double lead;  ///< lead of the best group over the next
  };
  [[nodiscard]] Answer of(std::size_t k) const {
    const ModeSharpeningConfig config;
    std::vector<std::size_t> order(surfels_[k].size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return share(k, surfels_[k][a].color) > share(k, surfels_[k][b].color);
    });
    std::vector<std::pair<double, Eigen::Vector3f>> groups;
    for (const std::size_t i : order) {
      const Eigen::Vector3f& color = surfels_[k][i].color;
      const bool is_new = std::none_of(groups.begin(), groups.end(), [&](const auto& group) {
        return (group.second - color).norm() <= static_cast<float>(config.color_sigma);
      });
      if (is_new) groups.emplace_back(score(k, color), color);
    }
    if (groups.size() < 2) return {densest_mode(surfels_[k], kPageBandwidth).color, 1.0};
    std::sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    return {densest_mode_like(surfels_[k], kPageBandwidth, groups[0].second, config.color_sigma).color,
            groups[0].first - groups[1].first};
  }

 private:
  static double bump(double squared, double sigma) {
    return std::pow(std::max(0.0, 1.0 - squared / (8.0 * sigma * sigma)), 4.0);
  }
  [[nodiscard]] double share(std::size_t k, const Eigen::Vector3f& color) const {
    double alike{0.0};
    double all{0.0};
    for (const SurfelMode& mode : surfels_[k]) {
      all += mode.weight;
      alike +=
          mode.weight * bump((mode.color - color).cast<double>().squaredNorm(), ModeSharpeningConfig{}.color_sigma);
    }
    return alike / all;
  }
  [[nodiscard]] Eigen::Vector3d place_m(std::size_t k) const {
    Eigen::Vector3d sum{Eigen::Vector3d::Zero()};
    double all{0.0};
    for (const SurfelMode& mode : surfels_[k]) {
      sum += double{mode.weight} * mode.position_m.cast<double>();
      all += double{mode.weight};
    }
    return sum / all;
  }
  [[nodiscard]] double score(std::size_t k, const Eigen::Vector3f& color) const {
    const ModeSharpeningConfig config;
    double near{0.0};
    double near_weight{0.0};
    double around{0.0};
    double around_weight{0.0};
    Eigen::Vector3d middle_m{Eigen::Vector3d::Zero()};
    for (std::size_t other = 0; other < surfels_.size(); ++other) {
      const Eigen::Vector3d offset_m = place_m(other) - place_m(k);
      if (offset_m.norm() > config.reach_m) continue;
      const double there = share(other, color);
      const double w = bump(offset_m.squaredNorm(), config.reach_m / 12.0);
      const double g = bump(offset_m.squaredNorm(), config.reach_m / 2.0);
      near += w * there;
      near_weight += w;
      around += g * there;
      around_weight += g;
      middle_m += g * offset_m;
    }
    const double one_sided = (middle_m / around_weight).norm() / (0.25 * config.reach_m);
    const double strength = config.strength * std::max(0.0, 1.0 - one_sided * one_sided);
    return near / near_weight + strength * (near / near_weight - around / around_weight);
  }

  const std::vector<std::vector<SurfelMode>>& surfels_;
};

/// Random surfels, so few within reach that all of them are asked.
TEST(ModeSharpening, EqualsANaiveOne) {
  std::mt19937_64 random{29};
  const auto between = [&](float low, float high) { return std::uniform_real_distribution<float>{low, high}(random); };
  const std::vector<Eigen::Vector3f> colors{kPaper, kInk, {0.7F, 0.2F, 0.2F}, {0.75F, 0.25F, 0.2F}};
  std::size_t compared{0};
  for (int round = 0; round < 5; ++round) {
    ModeStore store{6};
    store.resize(300);
    std::vector<std::vector<SurfelMode>> surfels(300);
    for (SurfelId id = 0; id < 300; ++id) {
      const Eigen::Vector3f at{between(-0.06F, 0.06F), between(-0.06F, 0.06F), between(0.99F, 1.0F)};
      for (std::size_t i = 1 + random() % 6; i > 0; --i) {
        const Eigen::Vector3f color = colors[random() % 4] + Eigen::Vector3f::Constant(between(-0.02F, 0.02F));
        const Eigen::Vector3f units = color * (255.0F * ColorUnits::kPerLevel);
        store.modes(id).add({static_cast<std::int32_t>(units.x()), static_cast<std::int32_t>(units.y()),
                             static_cast<std::int32_t>(units.z())},
                            at + Eigen::Vector3f::Constant(between(-0.001F, 0.001F)), between(0.5F, 9.0F));
      }
      for (std::size_t i = 0; i < store.count(id); ++i) surfels[id].push_back(store.mode(id, i));
    }
    const std::vector<SurfelMode> sharpened = sharpened_modes(store, {}, kPageBandwidth, {});
    const NaiveSharpening naive{surfels};
    for (SurfelId id = 0; id < 300; ++id) {
      const NaiveSharpening::Answer answer = naive.of(id);
      if (answer.lead < 1e-4) continue;
      ++compared;
      EXPECT_LT((sharpened[id].color - answer.color).norm(), 1e-5F) << round << ", " << id;
    }
  }
  EXPECT_GT(compared, 1400U);
}

/// Without modes, alone, far away from everything.
TEST(ModeSharpening, OfSurfelsThatHaveNoNeighbours) {
  EXPECT_TRUE(sharpened_modes(ModeStore{4}, {}, kPageBandwidth, {}).empty());
  ModeStore store{4};
  store.resize(4);
  store.modes(1).add(color_units({10, 20, 30}), {1.0F, 2.0F, 3.0F}, 2.0F);
  for (const SurfelId id : {2U, 3U}) {
    const Eigen::Vector3f at{id == 2 ? 1e9F : -1e9F, 0.0F, 0.0F};
    store.modes(id).add(color_units({200, 0, 0}), at, 3.0F);
    store.modes(id).add(color_units({0, 200, 0}), at, 2.0F);
  }
  const std::vector<SurfelMode> chosen = sharpened_modes(store, {}, kPageBandwidth, {});
  EXPECT_EQ(chosen[0].weight, 0.0F);
  EXPECT_EQ(chosen[1].weight, 2.0F);
  EXPECT_EQ(chosen[1].position_m, (Eigen::Vector3f{1.0F, 2.0F, 3.0F}));
  EXPECT_EQ(chosen[2].weight, 3.0F);
  EXPECT_EQ(chosen[3].weight, 3.0F);
}

TEST(ModeSharpening, RefusesWhatMakesNoSense) {
  constexpr double kNan{std::numeric_limits<double>::quiet_NaN()};
  constexpr double kInfinity{std::numeric_limits<double>::infinity()};
  EXPECT_TRUE(ModeSharpeningConfig{}.validate().ok());
  for (const double strength : {-1.0, kNan, kInfinity}) {
    EXPECT_FALSE((ModeSharpeningConfig{.strength = strength}.validate().ok()));
  }
  for (const double bad : {0.0, -1.0, kNan, kInfinity}) {
    EXPECT_FALSE((ModeSharpeningConfig{.reach_m = bad}.validate().ok()));
    EXPECT_FALSE((ModeSharpeningConfig{.color_sigma = bad}.validate().ok()));
  }
}

}  // namespace
}  // namespace saccade

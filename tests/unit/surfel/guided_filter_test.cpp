// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/guided_filter.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "saccade/core/simd.hpp"
#include "support/effort.hpp"
#include "support/naive_guided_filter.hpp"

namespace saccade {
namespace {

using test::GuidedImages;

constexpr float kNaN{std::numeric_limits<float>::quiet_NaN()};

/// Parameters of the random images.
struct Making {
  int width{67};
  int height{41};
  double share_used{0.8};
  float nearest_m{0.4F};
  float farthest_m{6.0F};
  float noise{0.02F};  ///< noise of depth, colour and the guidance's depth
  bool smooth{false};  ///< no edges but those of the mask
  bool gray{false};    ///< equal channels, so that Σ alone is singular
};

/// Patches of colour and depth with noise; anything where a pixel is not used.
GuidedImages random_images(std::uint32_t seed, const Making& making) {
  std::mt19937 rng{seed};
  std::uniform_real_distribution<float> share{0.0F, 1.0F};
  std::normal_distribution<float> noise{0.0F, making.noise};
  const auto color = [&](float mean) { return std::clamp(mean + noise(rng), 0.0F, 1.0F); };
  std::array<Eigen::Vector4f, 7> patches;
  for (Eigen::Vector4f& patch : patches) {
    const float depth_m = making.nearest_m + (making.farthest_m - making.nearest_m) * share(rng);
    patch = {share(rng), share(rng), share(rng), depth_m};
  }
  GuidedImages images{making.width, making.height, {}, {}, {}};
  for (int v = 0; v < making.height; ++v) {
    for (int u = 0; u < making.width; ++u) {
      const Eigen::Vector4f& patch = patches[making.smooth ? 0 : static_cast<std::size_t>(u / 9 + v / 11 * 3) % 7];
      const bool used = share(rng) < making.share_used;
      images.used.push_back(used ? static_cast<std::uint8_t>(1 + rng() % 255) : std::uint8_t{0});
      images.depth_m.push_back(used ? patch[3] + noise(rng) : (rng() % 2 == 0 ? kNaN : -3.0F));
      images.guidance.emplace_back(color(patch[0]), color(patch[1]), color(patch[2]), patch[3] + noise(rng));
      if (making.gray) images.guidance.back().head<3>().setConstant(images.guidance.back()[0]);
      if (!used) images.guidance.back().setConstant(rng() % 2 == 0 ? kNaN : 1e30F);
    }
  }
  return images;
}

std::vector<float> filtered(GuidedFilter& filter, const GuidedImages& images, const Executor& executor = {}) {
  std::vector<float> enhanced_m(images.depth_m.size(), -1.0F);
  filter.apply(images.width, images.height, images.depth_m, images.guidance, images.used, executor, enhanced_m);
  return enhanced_m;
}

std::vector<std::uint32_t> bits(const std::vector<float>& values) {
  std::vector<std::uint32_t> all;
  for (const float value : values) all.push_back(std::bit_cast<std::uint32_t>(value));
  return all;
}

struct Comparison {
  std::size_t used{0};
  std::size_t not_used{0};
  double worst_ulps{0.0};
};

void compare(const GuidedFilterConfig& config, const GuidedImages& images, const std::vector<float>& enhanced_m,
             Comparison& total) {
  const std::vector<double> exact_m = test::naive_guided_filter(config, images, {});
  for (std::size_t i = 0; i < exact_m.size(); ++i) {
    if (images.used[i] == 0) {
      ++total.not_used;
      EXPECT_EQ(std::bit_cast<std::uint32_t>(enhanced_m[i]), std::bit_cast<std::uint32_t>(images.depth_m[i]));
      continue;
    }
    ++total.used;
    const double off = test::ulps(enhanced_m[i], exact_m[i]);
    ASSERT_LE(off, 1.0) << "pixel " << i << ": " << enhanced_m[i] << " instead of " << exact_m[i];
    total.worst_ulps = std::max(total.worst_ulps, off);
  }
}

TEST(GuidedFilter, IsWithinOneUnitInTheLastPlaceOfTheDefinition) {
  Comparison total;
  std::uint32_t seed{1};
  std::vector<std::pair<int, int>> sizes{{1, 1}, {1, 9}, {9, 1}, {3, 2}, {8, 8}, {15, 33}};
  if (!test::kSanitized) sizes.insert(sizes.end(), {{67, 41}, {150, 30}});
  for (const int radius_px : {0, 1, 2, 3, 5, 9, 16}) {
    GuidedFilter filter{{.radius_px = radius_px}};  // one for all sizes
    for (const auto& [width, height] : sizes) {
      for (const double share_used : {1.0, 0.8, 0.1}) {
        SCOPED_TRACE(testing::Message() << "radius " << radius_px << ", " << width << "×" << height << ", seed "
                                        << seed);
        const GuidedImages images = random_images(seed++, {.width = width, .height = height, .share_used = share_used});
        ASSERT_NO_FATAL_FAILURE(compare(filter.config(), images, filtered(filter, images), total));
      }
    }
  }
  EXPECT_GT(total.used, test::kSanitized ? 5'000U : 50'000U);
  EXPECT_GT(total.not_used, test::kSanitized ? 1'000U : 10'000U);
  std::printf("compared %zu pixels, at most %.6f units in the last place off\n", total.used, total.worst_ulps);
}

TEST(GuidedFilter, LosesNothingToCancellation) {
  // Variances are differences of products of up to 10⁴ m²; edges are far above the least deviations.
  Comparison total;
  for (const GuidedFilterConfig& config : {GuidedFilterConfig{}, {.color_sigma = 1e-4, .depth_sigma_m = 1e-4}}) {
    GuidedFilter filter{config};
    for (const float noise : {0.0F, 1e-5F, 1e-3F, 0.3F}) {
      for (const bool smooth : {true, false}) {
        for (const bool gray : {true, false}) {
          SCOPED_TRACE(testing::Message() << "σ_c " << config.color_sigma << ", noise " << noise << ", smooth "
                                          << smooth << ", gray " << gray);
          const float farthest_m = smooth ? 100.0F : 1.0F;
          const GuidedImages images = random_images(
              7, {.nearest_m = 99.0F, .farthest_m = farthest_m, .noise = noise, .smooth = smooth, .gray = gray});
          ASSERT_NO_FATAL_FAILURE(compare(config, images, filtered(filter, images), total));
        }
      }
    }
  }
  EXPECT_GT(total.used, 60'000U);
  std::printf("compared %zu pixels, at most %.6f units in the last place off\n", total.used, total.worst_ulps);
}

TEST(GuidedFilter, ThreadsNeverChangeABit) {
  const GuidedImages images = random_images(11, {.width = 131, .height = 203});
  GuidedFilter filter;
  const auto first = bits(filtered(filter, images));
  for (const std::size_t threads : {2U, 3U, 8U}) {
    const Executor executor = Executor::with_threads(threads, Executor::Backend::std_thread);
    for (int again = 0; again < 3; ++again) EXPECT_EQ(bits(filtered(filter, images, executor)), first) << threads;
  }
  const GuidedImages other = random_images(12, {.width = 131, .height = 203});
  EXPECT_NE(bits(filtered(filter, other)), first);
}

struct SimdTargetGuard {
  SimdTargetGuard() = default;
  SimdTargetGuard(const SimdTargetGuard&) = delete;
  SimdTargetGuard& operator=(const SimdTargetGuard&) = delete;
  ~SimdTargetGuard() { static_cast<void>(use_simd_target("")); }
};

TEST(GuidedFilter, InstructionSetsNeverChangeABit) {
  const SimdTargetGuard guard;
  const std::vector<std::string> targets = simd_targets();
  std::size_t compared{0};
  for (const int radius_px : {0, 3, 5, 16}) {
    const GuidedImages images = random_images(13, {.width = test::kSanitized ? 53 : 149, .height = 60});
    std::vector<std::uint32_t> first;
    Comparison total;
    for (const std::string& target : targets) {
      SCOPED_TRACE(testing::Message() << "radius " << radius_px << ", " << target);
      ASSERT_TRUE(use_simd_target(target).ok());
      ASSERT_EQ(simd_target(), target);
      GuidedFilter filter{{.radius_px = radius_px}};
      const std::vector<float> enhanced_m = filtered(filter, images);
      if (first.empty()) {
        ASSERT_NO_FATAL_FAILURE(compare(filter.config(), images, enhanced_m, total));
        first = bits(enhanced_m);
      }
      EXPECT_EQ(bits(enhanced_m), first);
      ++compared;
    }
    EXPECT_GT(total.used, 1000U);
  }
  EXPECT_EQ(compared, 4 * targets.size());
  std::printf("compared %zu images on %zu instruction sets\n", compared, targets.size());
}

TEST(GuidedFilter, KeepsWhatIsTheSameEverywhere) {
  GuidedImages images = random_images(17, {.noise = 0.0F, .smooth = true});
  const float depth_m = 2.34567F;
  for (float& depth : images.depth_m) depth = depth_m;
  GuidedFilter filter;
  for (const float enhanced : filtered(filter, images)) ASSERT_EQ(enhanced, depth_m);
}

TEST(GuidedFilter, KeepsAPixelThatIsAlone) {
  GuidedImages images = random_images(19, {.share_used = 0.0});
  const std::size_t alone{20 * 67 + 30};
  images.used[alone] = 1;
  images.depth_m[alone] = 1.2345F;
  images.guidance[alone] = {0.3F, 0.9F, 0.1F, 1.3F};
  GuidedFilter filter;
  EXPECT_EQ(bits(filtered(filter, images)), bits(images.depth_m));
}

TEST(GuidedFilter, ANanThatIsUsedSpoilsNoMoreThanTwiceTheRadius) {
  GuidedImages images = random_images(23, {.share_used = 1.0});
  GuidedFilter filter;
  const std::vector<float> before = filtered(filter, images);
  const int u = 30;
  const int v = 20;
  images.depth_m[static_cast<std::size_t>(v * images.width + u)] = kNaN;
  const std::vector<float> after = filtered(filter, images);
  std::size_t spoiled{0};
  for (int row = 0; row < images.height; ++row) {
    for (int column = 0; column < images.width; ++column) {
      const auto i = static_cast<std::size_t>(row * images.width + column);
      const bool reached = std::abs(row - v) <= 6 && std::abs(column - u) <= 6;
      spoiled += std::isnan(after[i]) ? 1 : 0;
      if (!reached) {
        ASSERT_EQ(after[i], before[i]);
      }
    }
  }
  EXPECT_GT(spoiled, 29U);
  EXPECT_EQ(bits(filtered(filter, images)), bits(after));
}

/// Two walls with an edge at u = 32; the depth has noise, and the edge is blurred over five pixels.
GuidedImages blurred_edge(bool guided) {
  GuidedImages images{64, 48, {}, {}, {}};
  std::mt19937 rng{29};
  std::normal_distribution<float> noise{0.0F, 0.004F};
  for (int v = 0; v < images.height; ++v) {
    for (int u = 0; u < images.width; ++u) {
      const bool far = u >= 32;
      const float blurred = std::clamp(static_cast<float>(u - 29) / 5.0F, 0.0F, 1.0F);
      images.depth_m.push_back(1.0F + 0.5F * blurred + noise(rng));
      const float color = guided && far ? 0.7F : 0.4F;
      images.guidance.emplace_back(color, color, color, guided && far ? 1.5F : 1.0F);
      images.used.push_back(1);
    }
  }
  return images;
}

TEST(GuidedFilter, EdgesOfTheGuidanceBecomeEdgesOfTheDepthAndNoiseGoes) {
  GuidedFilter filter;
  const auto step_and_noise = [&](const GuidedImages& images) {
    const std::vector<float> enhanced_m = filtered(filter, images);
    double step_m{0.0};
    double squares{0.0};
    for (int v = 0; v < 48; ++v) {
      const float* row = enhanced_m.data() + static_cast<std::ptrdiff_t>(v) * 64;
      step_m += (row[32] - row[31]) / 48.0;
      for (int u = 8; u < 16; ++u) squares += (row[u] - 1.0) * (row[u] - 1.0);
    }
    return std::pair{step_m, std::sqrt(squares / (48 * 8))};
  };
  const auto [step_m, noise_m] = step_and_noise(blurred_edge(true));
  const auto [step_without_m, noise_without_m] = step_and_noise(blurred_edge(false));
  EXPECT_GT(step_m, 0.2);
  EXPECT_LT(step_without_m, 0.1);
  EXPECT_LT(noise_m, 0.0015);
  EXPECT_LT(noise_without_m, 0.0015);
}

TEST(GuidedFilter, ImagesWithoutPixelsAreFine) {
  GuidedFilter filter;
  EXPECT_TRUE(filtered(filter, {}).empty());
  EXPECT_TRUE(filtered(filter, {.width = 5, .height = 0, .depth_m = {}, .guidance = {}, .used = {}}).empty());
}

TEST(GuidedFilter, SizesThatDisagreeBreakTheContract) {
  GuidedFilter filter;
  GuidedImages images = random_images(31, {});
  images.used.pop_back();
  EXPECT_THROW(filtered(filter, images), ContractViolation);
  images = random_images(31, {});
  images.height = -images.height;
  EXPECT_THROW(filtered(filter, images), ContractViolation);
}

TEST(GuidedFilter, ChecksItsConfiguration) {
  EXPECT_TRUE(GuidedFilterConfig{}.validate().ok());
  EXPECT_TRUE((GuidedFilterConfig{.radius_px = 16, .color_sigma = 1e-4, .depth_sigma_m = 1e-4}).validate().ok());
  const double infinity = std::numeric_limits<double>::infinity();
  for (const GuidedFilterConfig& bad : std::vector<GuidedFilterConfig>{{.radius_px = -1},
                                                                       {.radius_px = 17},
                                                                       {.color_sigma = 0.0},
                                                                       {.color_sigma = infinity},
                                                                       {.color_sigma = NAN},
                                                                       {.depth_sigma_m = -1.0},
                                                                       {.depth_sigma_m = infinity},
                                                                       {.depth_sigma_m = NAN}}) {
    ASSERT_FALSE(bad.validate().ok());
    EXPECT_EQ(bad.validate().error().code, Errc::invalid_argument);
    EXPECT_THROW(GuidedFilter{bad}, ContractViolation);
  }
}

}  // namespace
}  // namespace saccade

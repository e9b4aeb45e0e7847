// SPDX-License-Identifier: Apache-2.0
// EM on random tasks and on degenerate samples: against the plain reference, what must never happen, what must not
// matter.
#include "saccade/attention/internal/gmm_em.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "saccade/attention/detector_evaluation.hpp"
#include "saccade/core/seeded_random.hpp"
#include "saccade/core/simd.hpp"
#include "saccade/trial/simulated_task.hpp"
#include "support/effort.hpp"
#include "support/reference_em.hpp"

namespace saccade {
namespace {

using MixtureInput = std::vector<Eigen::Vector4d>;

MixtureInput task_samples(std::uint64_t seed) {
  const SyntheticTask task = synthetic_task(seed, {.actions = 1 + static_cast<int>(seed % 3)});
  return test::augmented_samples(with_noise(task.trajectory, 0.002, seed).value());
}

/// A few clouds of samples of different shapes, in [−2, 2]^4.
MixtureInput cloud_samples(std::uint64_t seed) {
  SeededRandom random{seed};
  MixtureInput samples;
  for (int cloud = 0; cloud < 4; ++cloud) {
    Eigen::Matrix4d shape;
    Eigen::Vector4d center;
    for (double& value : shape.reshaped()) value = 0.3 * random.normal();
    for (double& value : center) value = random.uniform(-2.0, 2.0);
    for (int i = 0; i < 40 + 15 * cloud; ++i) {
      const Eigen::Vector4d normal{random.normal(), random.normal(), random.normal(), random.normal()};
      samples.emplace_back(center + shape * normal);
    }
  }
  return samples;
}

bool is_sound(const GmmFit& fit) {
  double weights{0.0};
  for (const Gaussian4& gaussian : fit.gaussians) {
    if (!gaussian.mean.allFinite() || !gaussian.covariance.allFinite() || !(gaussian.weight >= 0.0)) return false;
    if (!(gaussian.covariance.diagonal().minCoeff() > 0.0)) return false;
    weights += gaussian.weight;
  }
  return std::abs(weights - 1.0) < 1e-9 && std::isfinite(fit.log_likelihood());
}

/// The floor is no part of EM proper: it is so low here that it does not show.
TEST(GmmEm, NeverLowersTheLikelihood) {
  constexpr double kRounding{1e-5};  // some of these Gaussians are flat to the floor
  int checked{0};
  for (int seed = 0; seed < test::scaled_cases(40); ++seed) {
    const MixtureInput samples = cloud_samples(static_cast<std::uint64_t>(seed));
    const GmmEm em = GmmEm::create(samples, {.covariance_floor = 1e-9, .relative_stop = 0.0}).value();
    for (int gaussians = 1; gaussians <= 6; ++gaussians) {
      const GmmFit fit = em.fit(gaussians);
      for (std::size_t i = 1; i < fit.log_likelihoods.size(); ++i, ++checked) {
        ASSERT_GE(fit.log_likelihoods[i], fit.log_likelihoods[i - 1] - kRounding)
            << "seed " << seed << ", iteration " << i;
      }
    }
  }
  EXPECT_GT(checked, test::scaled_cases(4000));
}

TEST(GmmEm, TakesTheStepsOfThePlainReference) {
  constexpr double kFloor{1e-5};
  int compared{0};
  for (int seed = 0; seed < test::scaled_cases(12); ++seed) {
    const MixtureInput samples = task_samples(static_cast<std::uint64_t>(seed));
    for (const int gaussians : {1, 3, 8, 13}) {
      std::vector<Gaussian4> reference;
      for (int iterations = 1; iterations <= 6; ++iterations, ++compared) {
        const GmmFit fit =
            GmmEm::create(samples, {.relative_stop = 0.0, .max_iterations = iterations}).value().fit(gaussians);
        if (!reference.empty()) {
          if (fit.converged) break;
          reference = test::em_step(samples, reference, kFloor);
          ASSERT_NEAR(fit.log_likelihood(), test::log_likelihood(samples, reference), 1e-6) << "seed " << seed;
          for (std::size_t k = 0; k < reference.size(); ++k) {
            ASSERT_NEAR(fit.gaussians[k].weight, reference[k].weight, 1e-9);
            ASSERT_LT((fit.gaussians[k].mean - reference[k].mean).norm(), 1e-7 * (1.0 + reference[k].mean.norm()));
            ASSERT_LT((fit.gaussians[k].covariance - reference[k].covariance).norm(),
                      1e-6 * reference[k].covariance.norm());
          }
        }
        reference = fit.gaussians;
      }
    }
  }
  EXPECT_GE(compared, 18 * test::scaled_cases(12));
}

TEST(GmmEm, MovingAllSamplesMovesTheResult) {
  const Eigen::Vector4d shift{1000.0, -2000.0, 500.0, 1e5};
  for (int seed = 0; seed < test::scaled_cases(12); ++seed) {
    const MixtureInput samples = task_samples(static_cast<std::uint64_t>(seed));
    MixtureInput moved = samples;
    for (Eigen::Vector4d& sample : moved) sample += shift;
    for (const int gaussians : {1, 4, 9}) {
      const GmmFit fit = GmmEm::create(samples).value().fit(gaussians);
      const GmmFit there = GmmEm::create(moved).value().fit(gaussians);
      ASSERT_EQ(fit.log_likelihoods.size(), there.log_likelihoods.size());
      EXPECT_NEAR(fit.log_likelihood(), there.log_likelihood(), 1e-4);
      for (std::size_t k = 0; k < fit.gaussians.size(); ++k) {
        EXPECT_LT((fit.gaussians[k].mean + shift - there.gaussians[k].mean).norm(), 1e-4);
      }
    }
  }
}

TEST(GmmEm, DegenerateSamplesGiveSoundMixtures) {
  const Eigen::Vector4d point{0.3, 0.2, 1.0, 0.0};
  const Eigen::Vector4d direction{0.01, 0.0, -0.005, 1.0};
  MixtureInput line, still, same(20, point), two_places, gap, steep, large;
  for (int i = 0; i < 300; ++i) {
    line.emplace_back(point + i * direction);
    still.emplace_back(0.3, 0.2, 1.0, i);
    two_places.emplace_back(i < 150 ? 0.0 : 1.0, 0.0, 0.0, i);
    gap.emplace_back(0.001 * i, 0.0, 0.0, i < 150 ? i : i + 100000);
    steep.emplace_back(i == 299 ? 1e8 : 0.0, 0.0, 0.0, i);
    large.emplace_back(1e9, -1e9, 1e9, i);
  }
  int fitted{0};
  for (const MixtureInput& samples : {MixtureInput{point}, line, still, same, two_places, gap, steep, large}) {
    const GmmEm em = GmmEm::create(samples).value();
    for (const int gaussians : {1, 2, 3, 7, 30}) {
      EXPECT_TRUE(is_sound(em.fit(gaussians))) << samples.size() << " samples, " << gaussians << " Gaussians";
      ++fitted;
    }
  }
  EXPECT_EQ(fitted, 40);
}

TEST(GmmEm, ManySamplesGiveASoundMixture) {
  MixtureInput samples;
  const SyntheticTask task = synthetic_task(3);
  const double count = test::scaled_cases(100000);
  const HandTrajectory slow = at_speed(task.trajectory, count / static_cast<double>(task.trajectory.size())).value();
  const GmmEm em = GmmEm::create(test::augmented_samples(slow)).value();
  EXPECT_NEAR(static_cast<double>(em.samples()), count, 0.01 * count);
  for (const int gaussians : {1, 10, 30}) EXPECT_TRUE(is_sound(em.fit(gaussians)));
}

TEST(GmmEm, EveryInstructionSetGivesTheSameBits) {
  const MixtureInput samples = task_samples(5);
  const GmmEm em = GmmEm::create(samples).value();
  const GmmFit expected = em.fit(9);
  int targets{0};
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(use_simd_target(target));
    const GmmFit fit = em.fit(9);
    EXPECT_EQ(fit.log_likelihoods, expected.log_likelihoods) << target;
    for (std::size_t k = 0; k < fit.gaussians.size(); ++k) {
      EXPECT_EQ(fit.gaussians[k].mean, expected.gaussians[k].mean) << target;
      EXPECT_EQ(fit.gaussians[k].covariance, expected.gaussians[k].covariance) << target;
    }
    ++targets;
  }
  ASSERT_TRUE(use_simd_target({}));
  EXPECT_GE(targets, 2);
}

TEST(GmmEm, BadInputIsRefused) {
  EXPECT_FALSE(GmmEm::create({}));
  for (const double bad : {std::nan(""), HUGE_VAL, 1e10}) {
    const MixtureInput samples{Eigen::Vector4d::Zero(), Eigen::Vector4d{0.0, bad, 0.0, 1.0}};
    const auto em = GmmEm::create(samples);
    ASSERT_FALSE(em);
    EXPECT_EQ(em.error().context, "sample 1");
  }
  const MixtureInput one{Eigen::Vector4d::Zero()};
  EXPECT_FALSE(GmmEm::create(one, {.covariance_floor = 0.0}));
  EXPECT_FALSE(GmmEm::create(one, {.relative_stop = -1.0}));
  EXPECT_FALSE(GmmEm::create(one, {.max_iterations = 0}));
}

}  // namespace
}  // namespace saccade

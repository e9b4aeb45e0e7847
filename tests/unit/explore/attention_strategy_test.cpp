// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/attention_strategy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "saccade/explore/contour_strategies.hpp"
#include "saccade/explore/oracle_strategy.hpp"
#include "saccade/explore/strategy_kind.hpp"
#include "support/effort.hpp"
#include "unit/explore/scanned_clutter.hpp"

namespace saccade {
namespace {

using Attention = test::ScannedClutter;

bool falls(const std::vector<Proposal>& views) {
  return std::is_sorted(views.begin(), views.end(),
                        [](const Proposal& a, const Proposal& b) { return a.gain > b.gain; });
}

/// What each segment's best view gains, by its definition; -1: it has no contours.
std::vector<double> best_gains(const ObjectAttention& seen, const TsdfSnapshot& map, const SimulatedRunConfig& config,
                               const GainConfig& gain) {
  std::vector<double> best(seen.measures.size(), -1.0);
  const auto contours_of = seen.contours_of_segments();
  for (std::uint32_t segment = 0; segment < best.size(); ++segment) {
    std::vector<ContourPoint> points;
    for (const std::uint32_t contour : contours_of[segment]) points.push_back(seen.contours[contour]);
    if (points.empty()) continue;
    const std::vector<Pose> poses = contour_views(points, config.contour_views).value();
    const Region around = seen.surroundings(segment, config.attention.reach_m);
    const auto gains = evaluate_views(map, around, poses, gain, Executor{})->gains;
    best[segment] = static_cast<double>(*std::max_element(gains.begin(), gains.end()));
  }
  return best;
}

TEST_F(Attention, ProposesViewsOfTheMostSalientSegmentOrOfARivalThatGainsMore) {
  if (test::kSanitized) GTEST_SKIP() << "takes long under sanitizers; other tests propose views";
  ObjectAttentionConfig wanted = config().attention;
  std::set<std::uint32_t> chosen;
  for (const double min_gain : {10.0, 400.0}) {
    for (const double share : {1.0, 0.5, 0.05}) {
      SCOPED_TRACE("share " + std::to_string(share) + ", least gain " + std::to_string(min_gain));
      wanted.rival_share = share;
      const AttentionStrategy strategy{wanted, config().contour_views, gain()};
      Situation asked = situation(scanned());
      asked.min_gain = min_gain;
      const Proposals proposals = proposed(strategy, asked);
      ASSERT_TRUE(proposals.attention && proposals.segment && proposals.gained);
      const ObjectAttention& seen = *proposals.attention;
      const std::vector<double> best = best_gains(seen, scanned(), config(), gain());
      const auto leader = std::find_if(seen.order.begin(), seen.order.end(),
                                       [&](std::uint32_t segment) { return best[segment] >= min_gain; });
      ASSERT_NE(leader, seen.order.end());
      std::uint32_t expected = *leader;
      for (auto rival = leader; rival != seen.order.end(); ++rival) {
        if (seen.measures[*rival].sizes_m.maxCoeff() <= wanted.scrap_length_m) break;
        if (seen.saliency[*rival].value < share * seen.saliency[*leader].value) break;
        if (best[*rival] > best[expected]) expected = *rival;
      }
      EXPECT_EQ(*proposals.segment, expected);
      chosen.insert(expected);
      EXPECT_FALSE(proposals.complete);
      EXPECT_EQ(proposals.candidates, 40 * seen.contours.size());
      EXPECT_TRUE(falls(proposals.views));
      EXPECT_EQ(proposals.views.front().gain, best[expected]);
      EXPECT_EQ(proposals.views.size(), std::min<std::size_t>(16, 40 * seen.contours_of_segments()[expected].size()));
    }
  }
  EXPECT_GT(chosen.size(), 1U);
}

TEST_F(Attention, GainsAreThoseWithinTheSegmentsSurroundings) {
  const AttentionStrategy strategy = attention();
  const Proposals proposals = proposed(strategy, situation(scanned()));
  const auto& sphere = std::get<Sphere>(*proposals.gained);
  double farthest_m{0.0};
  for (const Eigen::Vector3f& p : proposals.attention->surface.points_of(*proposals.segment)) {
    farthest_m = std::max(farthest_m, (p.cast<double>() - sphere.center).norm());
  }
  EXPECT_NEAR(sphere.radius_m, farthest_m + 0.2, 1e-9);
  std::vector<Pose> poses;
  for (const Proposal& view : proposals.views) poses.push_back(view.T_world_camera);
  const GainResult gains = *evaluate_views(scanned(), sphere, poses, gain(), Executor{});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(proposals.views[i].gain, static_cast<double>(gains.gains[i]));
  }
}

/// As when the robot takes none of them: what is proposed, time after time, until the segment is another.
std::vector<Pose> views_until_the_next_segment(const AttentionStrategy& strategy, Situation asked) {
  std::vector<Pose> views;
  asked.attempted = [&](const Pose& pose) {
    return std::any_of(views.begin(), views.end(), [&](const Pose& view) { return view.matrix() == pose.matrix(); });
  };
  const std::optional<std::uint32_t> first = strategy.propose(asked)->segment;
  for (Proposals next = *strategy.propose(asked); next.segment == first; next = *strategy.propose(asked)) {
    const std::size_t before = views.size();
    for (const Proposal& view : next.views) {
      if (!asked.attempted(view.T_world_camera)) views.push_back(view.T_world_camera);
    }
    if (views.size() == before) break;  // it proposes nothing new
  }
  return views;
}

TEST_F(Attention, GoesOnToTheNextSegmentWhenAllViewsOfOneWereAttempted) {
  if (test::kSanitized) GTEST_SKIP() << "several runs take long under sanitizers; other tests make one";
  ObjectAttentionConfig wanted = config().attention;
  wanted.rival_share = 1.0;  // else a rival may be next before all were attempted
  const AttentionStrategy strategy{wanted, config().contour_views, gain()};
  Situation asked = situation(scanned());
  asked.min_gain = 400.0;
  const Proposals first = proposed(strategy, asked);
  const std::vector<Pose> attempted = views_until_the_next_segment(strategy, asked);
  asked.attempted = [&](const Pose& pose) {
    return std::any_of(attempted.begin(), attempted.end(),
                       [&](const Pose& other) { return other.matrix() == pose.matrix(); });
  };
  const Proposals next = proposed(strategy, asked);
  ASSERT_TRUE(first.segment && next.segment);
  EXPECT_NE(*first.segment, *next.segment);
  EXPECT_GT(attempted.size(), first.views.size());
  const std::vector<std::uint32_t>& order = next.attention->order;
  EXPECT_LT(std::find(order.begin(), order.end(), *first.segment),
            std::find(order.begin(), order.end(), *next.segment));
  const std::vector<std::uint32_t> contours = next.attention->contours_of_segments()[*first.segment];
  std::vector<ContourPoint> points;
  for (const std::uint32_t contour : contours) points.push_back(next.attention->contours[contour]);
  const std::vector<Pose> all = contour_views(points, config().contour_views).value();
  const auto gains = evaluate_views(scanned(), *first.gained, all, gain(), Executor{})->gains;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_worth_it = static_cast<double>(gains[i]) >= asked.min_gain;
    EXPECT_TRUE(!is_worth_it || asked.attempted(all[i]));
  }
}

TEST_F(Attention, WhenNoViewGainsEnoughItSaysWhatItJudged) {
  Situation asked = situation(scanned());
  asked.min_gain = 1e9;
  const AttentionStrategy strategy = attention();
  const Proposals proposals = proposed(strategy, asked);
  EXPECT_TRUE(proposals.complete);
  EXPECT_FALSE(proposals.segment);
  EXPECT_FALSE(proposals.gained);
  EXPECT_TRUE(falls(proposals.views));
  const auto& owners = proposals.attention->segment_of_contour;
  EXPECT_EQ(proposals.evaluated,
            40 * (owners.size() - static_cast<std::size_t>(std::count(owners.begin(), owners.end(), kUnlabelled))));
  // The best view of each segment; those that were attempted are judged too, so that one can say what was out of reach.
  std::set<std::uint32_t> segments{owners.begin(), owners.end()};
  segments.erase(kUnlabelled);
  EXPECT_EQ(proposals.views.size(), segments.size());
  const Pose best = proposals.views.front().T_world_camera;
  asked.attempted = [&](const Pose& pose) { return pose.matrix() == best.matrix(); };
  const Proposals again = proposed(strategy, asked);
  EXPECT_EQ(again.views.size(), proposals.views.size() + 1);
  const auto attempted = std::find_if(again.views.begin(), again.views.end(), [&](const Proposal& view) {
    return view.T_world_camera.matrix() == best.matrix();
  });
  ASSERT_NE(attempted, again.views.end());
  EXPECT_EQ(attempted->gain, proposals.views.front().gain);
}

TEST_F(Attention, ViewsThatTheRobotRefusesAreNotJudged) {
  Situation asked = situation(scanned());
  asked.test = [](std::span<const Pose> poses) {
    return std::vector<std::optional<Refusal>>(poses.size(), Refusal::no_ik);
  };
  const Proposals none = proposed(attention(), asked);
  EXPECT_TRUE(none.complete);
  EXPECT_TRUE(none.views.empty());
  EXPECT_EQ(none.evaluated, 0U);
  EXPECT_GT(none.refused.of(Refusal::no_ik), 0U);
}

TEST_F(Attention, NothingIsProposedForAnEmptyMap) {
  const TsdfSnapshot empty = empty_map().snapshot();
  const AttentionStrategy attentive = attention();
  const StandardStrategy standard{config().attention.contours, config().contour_views, gain()};
  const RandomContourStrategy random{config().attention.contours, config().contour_views, ray_gain(gain()), 1};
  const OracleStrategy oracle{truth(), config().camera, 0.0, config().attention.contours, config().contour_views};
  for (const Strategy* strategy : std::initializer_list<const Strategy*>{&attentive, &standard, &random, &oracle}) {
    const Proposals proposals = proposed(*strategy, situation(empty));
    EXPECT_TRUE(proposals.views.empty());
    EXPECT_TRUE(proposals.complete);
    EXPECT_EQ(proposals.candidates, 0U);
  }
}

TEST_F(Attention, WhatAStrategyKeptChangesNothing) {
  const AttentionStrategy fresh = attention();
  const AttentionStrategy used = attention();
  proposed(used, situation(empty_map().snapshot()));
  TsdfMap changed{scanned()};
  ASSERT_TRUE(changed.forget(Sphere{{0.0, 0.0, 0.1}, 0.15}).ok());
  proposed(used, situation(changed.content()));
  const Proposals a = proposed(fresh, situation(scanned()));
  const Proposals b = proposed(used, situation(scanned()));
  EXPECT_EQ(a.segment, b.segment);
  ASSERT_EQ(a.views.size(), b.views.size());
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    EXPECT_EQ(a.views[i].gain, b.views[i].gain);
    EXPECT_EQ(a.views[i].T_world_camera.matrix(), b.views[i].T_world_camera.matrix());
  }
}

TEST_F(Attention, ScrapsComeLast) {
  ObjectAttentionConfig with_scraps = config().attention;
  with_scraps.scrap_length_m = 0.5;
  const ObjectAttention seen = LiveObjectAttention::create(with_scraps)->look(scanned(), Executor{}).value();
  bool scrap{false};
  for (const std::uint32_t segment : seen.order) {
    const bool is_scrap = seen.measures[segment].sizes_m.maxCoeff() <= 0.5;
    EXPECT_TRUE(is_scrap || !scrap);
    scrap = is_scrap;
  }
  EXPECT_TRUE(scrap);
  EXPECT_EQ(static_cast<std::ptrdiff_t>(seen.scraps),
            std::count_if(seen.measures.begin(), seen.measures.end(),
                          [](const SegmentMeasures& m) { return m.sizes_m.maxCoeff() <= 0.5; }));
}

TEST_F(Attention, AScrapIsNoRival) {
  // One segment is the most salient, though others gain more.
  const ObjectAttention seen = LiveObjectAttention::create(config().attention)->look(scanned(), Executor{}).value();
  const std::vector<double> best = best_gains(seen, scanned(), config(), gain());
  const auto gaining = std::find_if(seen.order.begin(), seen.order.end(), [&](std::uint32_t segment) {
    return best[segment] >= config().exploration.min_gain &&
           best[segment] < *std::max_element(best.begin(), best.end());
  });
  ASSERT_NE(gaining, seen.order.end());
  const auto only = [&](const MeasuredSegments& segments) {
    std::vector<Saliency> all(segments.measures.size(), Saliency{0.9, "all alike"});
    all[*gaining].value = 1.0;
    return all;
  };
  ObjectAttentionConfig scraps = config().attention;
  scraps.saliency = only;
  scraps.rival_share = 0.1;
  const AttentionStrategy among_all{scraps, config().contour_views, gain()};
  EXPECT_NE(proposed(among_all, situation(scanned())).segment, *gaining);
  scraps.scrap_length_m = 10.0;  // all are: then they do not compete
  const AttentionStrategy strategy{scraps, config().contour_views, gain()};
  EXPECT_EQ(proposed(strategy, situation(scanned())).segment, *gaining);
}

TEST_F(Attention, ExploresWithAStrategyThatHasMoreToPropose) {
  // The robot declines everything that the first segment has to offer.
  const AttentionStrategy strategy = attention();
  const Proposals first = proposed(strategy, situation(scanned()));
  const std::vector<Pose> of_first = views_until_the_next_segment(strategy, situation(scanned()));
  const auto is_of_first = [&](const Eigen::Vector3d& p) {
    return std::any_of(of_first.begin(), of_first.end(),
                       [&](const Pose& view) { return (view.translation() - p).norm() < 1e-9; });
  };
  class Declining final : public Robot {
   public:
    explicit Declining(std::function<bool(const Eigen::Vector3d&)> no) : no_{std::move(no)} {}
    Result<PlannedMotion> plan(std::span<const Pose> poses, Way /*way*/) override {
      if (no_(poses[0].translation())) return PlannedMotion{std::nullopt, Refusal::no_path, ""};
      return PlannedMotion{Motion{0, poses[0], {}, 0.0}, std::nullopt, ""};
    }
    Result<std::optional<Arrival>> execute(const Motion& motion, const OnWay& /*on_way*/) override {
      return std::optional{Arrival{motion.T_world_camera, 0.0}};
    }

   private:
    std::function<bool(const Eigen::Vector3d&)> no_;
  };
  Declining robot{is_of_first};
  SimulatedCamera camera = *simulated_camera(rays(), config());
  ExplorationCell cell{config().camera, [&](const Pose& pose) -> Result<Frame> { return camera.capture(pose); }, robot};
  TsdfMap map{scanned()};
  ExplorationConfig exploration = config().exploration;
  exploration.max_views = 1;
  std::optional<std::uint32_t> segment;
  ExplorationHooks hooks;
  hooks.after_view = [&](const ExploredView&, const Proposals& proposals) {
    segment = proposals.segment;
    return true;
  };
  const ExplorationResult result = explore(map, cell, {workspace()}, strategy, exploration, Executor{}, hooks).value();
  ASSERT_EQ(result.views.size(), 1U);
  ASSERT_TRUE(segment);
  EXPECT_NE(segment, first.segment);
  EXPECT_GT(result.views[0].refused.of(Refusal::no_path), 0U);
  EXPECT_FALSE(is_of_first(result.views[0].T_world_camera.translation()));
}

TEST_F(Attention, CoversTheObjectsOfAClutter) {
  if (test::kSanitized) GTEST_SKIP() << "several runs take long under sanitizers; other tests make one";
  SimulatedRunConfig run = config();
  run.exploration.max_views = 6;
  const SimulatedRun attentive = *run_simulated(truth(), run, Executor::with_threads(2));
  EXPECT_GT(attentive.final().metrics.coverage, attentive.initial.metrics.coverage + 0.2);
  EXPECT_GT(attentive.final().metrics.coverage, 0.85);
  std::size_t at_objects{0};
  for (const MeasuredView& view : attentive.views) {
    at_objects += looks_at_object(truth(), view.view.T_world_camera) ? 1 : 0;
  }
  EXPECT_GE(at_objects, 2U);
}

TEST(StrategyKinds, AreKnownByTheirNames) {
  for (const StrategyKind kind : kStrategies) EXPECT_EQ(*strategy_kind(to_string(kind)), kind);
  EXPECT_NE(strategy_kind("saliency").error().message.find("attention, standard, sphere"), std::string::npos);
}

TEST(ObjectAttentionConfig, RefusesWhatMakesNoSense) {
  ObjectAttentionConfig config;
  EXPECT_TRUE(config.validate().ok());
  for (const double share : {0.0, 1.01, std::nan("")}) {
    config.rival_share = share;
    EXPECT_FALSE(config.validate().ok());
  }
  config.rival_share = 1.0;
  config.reach_m = 0.0;
  EXPECT_FALSE(config.validate().ok());
  config = {};
  config.scrap_length_m = std::nan("");
  EXPECT_FALSE(config.validate().ok());
  config = {};
  config.saliency = nullptr;
  EXPECT_FALSE(config.validate().ok());
  config = {};
  config.saliency = [](const MeasuredSegments&) { return std::vector<Saliency>(1); };
  EXPECT_TRUE(config.validate().ok());
}

}  // namespace
}  // namespace saccade

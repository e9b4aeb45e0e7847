// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/attention_strategy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "saccade/explore/contour_strategies.hpp"
#include "saccade/explore/oracle_strategy.hpp"
#include "saccade/explore/simulated_run.hpp"
#include "saccade/scene/random_clutter.hpp"
#include "saccade/view/view_order.hpp"

namespace saccade {
namespace {

/// A clutter of four objects after its initial scan by a small camera.
class Attention : public ::testing::Test {
 protected:
  static const RayScene& rays() {
    static const RayScene built = *RayScene::build(random_clutter(5, 4));
    return built;
  }
  static const Truth& truth() {
    static const Truth made = *Truth::build(rays(), 0.008, Executor::with_threads(2));
    return made;
  }
  static SimulatedRunConfig config() {
    SimulatedRunConfig config;
    config.voxel_size_m = 0.012;
    config.camera = PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.4, 3.0};
    config.gain_width_px = 80;
    config.exploration.min_gain = 10.0;
    config.exploration.oscillation_frames = 3;
    return config;
  }
  static GainConfig gain() {
    GainConfig gain;
    gain.sensor = coarser(config().camera, config().gain_width_px);
    gain.tilt_rad = config().exploration.oscillation_rad;
    return gain;
  }
  static TsdfMap empty_map() {
    TsdfConfig map = config().map();
    map.workspace = rays().scene().workspace;
    return *TsdfMap::create(map);
  }
  static const TsdfSnapshot& scanned() {
    static const TsdfSnapshot after_scan = [] {
      TsdfMap map = empty_map();
      SimulatedCamera camera = *simulated_camera(rays(), config());
      FreeRobot robot;
      ExplorationCell cell{config().camera, [&](const Pose& pose) -> Result<Frame> { return camera.capture(pose); },
                           robot};
      EXPECT_TRUE(scan(map, cell, rays().scene().scan, config().exploration, Executor{})->complete);
      return map.snapshot();
    }();
    return after_scan;
  }

  static const Region& workspace() {
    static const Region region = rays().scene().workspace;
    return region;
  }
  static Situation situation(const TsdfSnapshot& map) {
    static const Executor executor;
    Situation situation{map, workspace(), 0, 0, executor};
    situation.min_gain = config().exploration.min_gain;
    return situation;
  }
  static Proposals proposed(const Strategy& strategy, const Situation& situation) {
    auto proposals = strategy.propose(situation);
    EXPECT_TRUE(proposals) << proposals.error().to_string();
    return *proposals;
  }
  static AttentionStrategy attention() { return {config().attention, config().contour_views, ray_gain(gain())}; }
};

bool falls(const std::vector<Proposal>& views) {
  return std::is_sorted(views.begin(), views.end(),
                        [](const Proposal& a, const Proposal& b) { return a.gain > b.gain; });
}

TEST_F(Attention, ProposesViewsOfTheMostSalientSegmentThatHasAGoodOne) {
  const AttentionStrategy strategy = attention();
  const Proposals proposals = proposed(strategy, situation(scanned()));
  ASSERT_TRUE(proposals.attention && proposals.segment && proposals.gained);
  const ObjectAttention& seen = *proposals.attention;
  EXPECT_FALSE(proposals.complete);
  EXPECT_EQ(proposals.candidates, 40 * seen.contours.size());
  ASSERT_FALSE(proposals.views.empty());
  EXPECT_TRUE(falls(proposals.views));
  EXPECT_GE(proposals.views.front().gain, config().exploration.min_gain);
  const auto contours_of = seen.contours_of_segments();
  EXPECT_EQ(proposals.views.size(), 40 * contours_of[*proposals.segment].size());
  // None of those before it had a view that gains enough.
  for (const std::uint32_t segment : seen.order) {
    if (segment == *proposals.segment) break;
    std::vector<ContourPoint> points;
    for (const std::uint32_t contour : contours_of[segment]) points.push_back(seen.contours[contour]);
    const std::vector<Pose> poses = contour_views(points, config().contour_views).value();
    const Region around = seen.surroundings(segment, config().attention.reach_m);
    for (const std::uint64_t rays_gained : evaluate_views(scanned(), around, poses, gain(), Executor{})->gains) {
      EXPECT_LT(static_cast<double>(rays_gained), config().exploration.min_gain);
    }
  }
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

TEST_F(Attention, GoesOnToTheNextSegmentWhenAllViewsOfOneWereAttempted) {
  const AttentionStrategy strategy = attention();
  std::vector<Pose> attempted;
  Situation asked = situation(scanned());
  asked.attempted = [&](const Pose& pose) {
    return std::any_of(attempted.begin(), attempted.end(),
                       [&](const Pose& other) { return other.matrix() == pose.matrix(); });
  };
  std::set<std::uint32_t> segments;
  std::size_t rank{0};
  for (int i = 0; i < 3; ++i) {
    const Proposals proposals = proposed(strategy, asked);
    ASSERT_TRUE(proposals.segment);
    EXPECT_TRUE(segments.insert(*proposals.segment).second);
    const std::vector<std::uint32_t>& order = proposals.attention->order;
    const auto now =
        static_cast<std::size_t>(std::find(order.begin(), order.end(), *proposals.segment) - order.begin());
    EXPECT_TRUE(i == 0 || now > rank);
    rank = now;
    for (const Proposal& view : proposals.views) attempted.push_back(view.T_world_camera);
  }
}

TEST_F(Attention, WhenNoViewGainsEnoughItSaysWhatItJudged) {
  Situation asked = situation(scanned());
  asked.min_gain = 1e9;
  const Proposals proposals = proposed(attention(), asked);
  EXPECT_TRUE(proposals.complete);
  EXPECT_FALSE(proposals.segment);
  EXPECT_FALSE(proposals.gained);
  EXPECT_TRUE(falls(proposals.views));
  EXPECT_EQ(proposals.views.size(), proposals.evaluated);
  const auto& owners = proposals.attention->segment_of_contour;
  EXPECT_EQ(proposals.views.size(),
            40 * (owners.size() - static_cast<std::size_t>(std::count(owners.begin(), owners.end(), kUnlabelled))));
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
}

TEST_F(Attention, StandardFindsTheBestOfAllContourViews) {
  const StandardStrategy strategy{config().attention.contours, config().contour_views, gain()};
  const Proposals proposals = proposed(strategy, situation(scanned()));
  const std::vector<ContourVoxel> voxels = contour_voxels(scanned(), config().attention.contours, Executor{}).value();
  const std::vector<Pose> poses =
      contour_views(contour_points(voxels, config().voxel_size_m, config().attention.contours)).value();
  EXPECT_EQ(proposals.candidates, poses.size());
  const std::vector<RankedView> ranked =
      order_views(evaluate_views(scanned(), workspace(), poses, gain(), Executor{})->gains, poses);
  ASSERT_GE(ranked.size(), proposals.views.size());
  ASSERT_GT(proposals.views.size(), 10U);
  for (std::size_t i = 0; i < proposals.views.size(); ++i) {
    EXPECT_EQ(proposals.views[i].gain, static_cast<double>(ranked[i].gain));
    EXPECT_EQ(proposals.views[i].T_world_camera.matrix(), ranked[i].T_world_camera.matrix());
  }
  // Asked again, it goes on behind those.
  Situation again = situation(scanned());
  again.attempted = [&](const Pose& pose) {
    return std::any_of(proposals.views.begin(), proposals.views.end(),
                       [&](const Proposal& view) { return view.T_world_camera.matrix() == pose.matrix(); });
  };
  EXPECT_EQ(proposed(strategy, again).views.front().gain, static_cast<double>(ranked[proposals.views.size()].gain));
}

TEST_F(Attention, RandomContoursAreAShuffleThatTheSeedDecides) {
  const auto first_of = [](std::uint64_t seed, std::size_t taken) {
    const RandomContourStrategy strategy{config().attention.contours, config().contour_views, ray_gain(gain()), seed};
    Situation asked = situation(scanned());
    asked.views_of_region = taken;
    const Proposals proposals = proposed(strategy, asked);
    EXPECT_FALSE(proposals.by_gain);
    return proposals.views.front().T_world_camera.matrix().eval();
  };
  EXPECT_EQ(first_of(1, 0), first_of(1, 0));
  EXPECT_NE(first_of(1, 0), first_of(2, 0));
  EXPECT_NE(first_of(1, 0), first_of(1, 1));
}

TEST_F(Attention, TheOraclesFirstViewShowsMoreOfTheObjectsThanOthers) {
  const OracleStrategy oracle{truth(), config().camera, config().exploration.oscillation_rad,
                              config().attention.contours, config().contour_views};
  const Proposals proposals = proposed(oracle, situation(scanned()));
  ASSERT_GT(proposals.views.size(), 40U);
  EXPECT_TRUE(falls(proposals.views));
  const auto coverage_after = [](const Pose& pose) {
    TsdfMap map{scanned()};
    SimulatedRunConfig exact = config();
    exact.noise = false;
    SimulatedCamera camera = *simulated_camera(rays(), exact);
    for (int i = 0; i < 3; ++i) {
      const Frame frame = camera.capture(pose, Executor{});
      EXPECT_TRUE(map.integrate(config().camera, frame.depth, pose, Executor{}));
    }
    return measure_map(truth(), map.content(), Executor{}).metrics.coverage;
  };
  const double best = coverage_after(proposals.views.front().T_world_camera);
  const double middle = coverage_after(proposals.views[proposals.views.size() / 2].T_world_camera);
  EXPECT_GT(best, coverage_after(proposals.views.back().T_world_camera));
  EXPECT_GT(best, middle);
}

TEST_F(Attention, ExploresWithAStrategyThatHasMoreToPropose) {
  // The robot declines everything that the first segment has to offer.
  const AttentionStrategy strategy = attention();
  const Proposals first = proposed(strategy, situation(scanned()));
  const auto is_of_first = [&](const Eigen::Vector3d& p) {
    return std::any_of(first.views.begin(), first.views.end(),
                       [&](const Proposal& view) { return (view.T_world_camera.translation() - p).norm() < 1e-9; });
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

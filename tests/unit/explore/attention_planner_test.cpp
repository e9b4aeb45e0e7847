// SPDX-License-Identifier: Apache-2.0
// The planner of chapter 3: salient objects, views of their contours, rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "saccade/attention/salient_objects.hpp"
#include "support/effort.hpp"
#include "unit/explore/scanned_clutter.hpp"

namespace saccade {
namespace {

class Attention : public test::ScannedClutter {
 protected:
  /// Believes every promise, so that gains are those of all rays.
  static ViewPlanner attention(const SimulatedRunConfig& wanted = config()) {
    return ViewPlanner{PlannerParts{std::make_shared<SalientObjects>(wanted.attention),
                                    std::make_shared<ContourViews>(wanted.contour_views, wanted.contours),
                                    std::make_shared<RayGain>(gain(), Trust::blind), wanted.planner}};
  }
};

/// Objects and contours of a map.
struct Seen {
  std::shared_ptr<const SalientSurface> surface;
  ContourSet contours;
};
Seen look_at_map(const TsdfSnapshot& map, const SimulatedRunConfig& config) {
  const Executor executor;
  SalientObjects objects{config.attention};
  std::shared_ptr<const SalientSurface> surface = objects.look({map, executor}).value();
  LiveContours contours = LiveContours::create(config.contours).value();
  contours.update(map, executor);
  ContourSet set = contours_of(contours.points(), *surface, executor);
  return {std::move(surface), std::move(set)};
}

/// Returns the gain of each segment's best view, by definition; -1 without contours.
std::vector<double> best_gains(const Seen& seen, const TsdfSnapshot& map, const SimulatedRunConfig& config,
                               const GainConfig& gain) {
  std::vector<double> best(seen.surface->measures.size(), -1.0);
  const auto contours_of = seen.contours.points_of_segments(best.size());
  for (std::uint32_t segment = 0; segment < best.size(); ++segment) {
    std::vector<ContourPoint> points;
    for (const std::uint32_t contour : contours_of[segment]) points.push_back(seen.contours.points[contour]);
    if (points.empty()) continue;
    const std::vector<Pose> poses = contour_views(points, config.contour_views).value();
    const Region around = seen.surface->surroundings(segment, config.attention.reach_m);
    const auto gains = evaluate_views(map, around, poses, gain, Executor{})->gains;
    best[segment] = static_cast<double>(*std::max_element(gains.begin(), gains.end()));
  }
  return best;
}

TEST_F(Attention, RanksViewsOfTheMostSalientSegmentOrOfARivalThatGainsMore) {
  if (test::kSanitized) GTEST_SKIP() << "takes long under sanitizers; other tests rank views";
  SimulatedRunConfig wanted = config();
  std::set<std::uint32_t> chosen;
  const Seen seen = look_at_map(scanned(), wanted);
  const std::vector<double> best = best_gains(seen, scanned(), wanted, gain());
  const std::vector<std::uint32_t>& order = seen.surface->order;
  for (const double min_gain : {10.0, 400.0}) {
    for (const double share : {1.0, 0.5, 0.05}) {
      SCOPED_TRACE("share " + std::to_string(share) + ", least gain " + std::to_string(min_gain));
      wanted.planner = {.min_gain = min_gain, .rival_share = share};
      const Ranking ranking = ranked(attention(wanted), scene(scanned()));
      ASSERT_FALSE(ranking.empty());
      const auto leader =
          std::find_if(order.begin(), order.end(), [&](std::uint32_t segment) { return best[segment] >= min_gain; });
      ASSERT_NE(leader, order.end());
      std::uint32_t expected = *leader;
      for (auto rival = leader; rival != order.end(); ++rival) {
        if (seen.surface->measures[*rival].sizes_m.maxCoeff() <= wanted.attention.scrap_length_m) break;
        if (seen.surface->saliency[*rival].value < share * seen.surface->saliency[*leader].value) break;
        if (best[*rival] > best[expected]) expected = *rival;
      }
      const ViewChoice choice = *ranking.choice();
      EXPECT_EQ(choice.segment, expected);
      chosen.insert(expected);
      EXPECT_EQ(ranking.candidates(), 40 * seen.contours.points.size());
      EXPECT_TRUE(test::falls(choice.candidates));
      EXPECT_EQ(ranking.best().gain, best[expected]);
      const std::size_t contours = seen.contours.points_of_segments(best.size())[expected].size();
      EXPECT_EQ(choice.candidates.size(), std::min<std::size_t>(16, 40 * contours));
      const ViewAttention attention = ranking.attention().value();
      EXPECT_EQ(attention.segments, best.size());
      EXPECT_EQ(attention.contours_of_segment, contours);
      EXPECT_EQ(order[attention.rank], expected);
    }
  }
  EXPECT_GT(chosen.size(), 1U);
}

TEST_F(Attention, GainsAreThoseWithinTheSegmentsSurroundings) {
  const Ranking ranking = ranked(attention(), scene(scanned()));
  const ViewChoice choice = *ranking.choice();
  const auto& sphere = std::get<Sphere>(choice.region);
  double farthest_m{0.0};
  for (const Eigen::Vector3f& p : choice.surface->points.points_of(*choice.segment)) {
    farthest_m = std::max(farthest_m, (p.cast<double>() - sphere.center).norm());
  }
  EXPECT_NEAR(sphere.radius_m, farthest_m + 0.2, 1e-9);
  std::vector<Pose> poses;
  for (const RankedView& view : choice.candidates) poses.push_back(view.T_world_camera);
  const GainResult gains = *evaluate_views(scanned(), sphere, poses, gain(), Executor{});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(choice.candidates[i].gain, static_cast<double>(gains.gains[i]));
  }
}

/// As when the robot takes none of them: adds what is ranked, time after time, until the segment is another.
Attempts refused_until_the_next_segment(ViewPlanner planner,
                                        const std::function<PlanningScene(const Attempts&)>& scene) {
  Attempts attempts;
  const auto segment_of = [](const Ranking& ranking) {
    return ranking.empty() ? std::nullopt : ranking.choice()->segment;
  };
  Ranking next = planner.rank(scene(attempts)).value();
  const std::optional<std::uint32_t> first = segment_of(next);
  while (segment_of(next) == first) {
    attempts.add_refused(0, next.as_good_as_best(0.0), Refusal::no_path);
    next = planner.rank(scene(attempts)).value();
  }
  return attempts;
}

TEST_F(Attention, GoesOnToTheNextSegmentWhenAllViewsOfOneWereAttempted) {
  if (test::kSanitized) GTEST_SKIP() << "several runs take long under sanitizers; other tests make one";
  SimulatedRunConfig wanted = config();
  wanted.planner = {.min_gain = 400.0, .rival_share = 1.0};  // else a rival may be next before all were attempted
  const Ranking first = ranked(attention(wanted), scene(scanned()));
  const Attempts attempts =
      refused_until_the_next_segment(attention(wanted), [](const Attempts& tried) { return scene(scanned(), &tried); });
  const Ranking next = ranked(attention(wanted), scene(scanned(), &attempts));
  ASSERT_FALSE(first.empty() || next.empty());
  const ViewChoice choice = *next.choice();
  const std::uint32_t left = *first.choice()->segment;
  EXPECT_NE(left, *choice.segment);
  EXPECT_GT(attempts.refusals_of(0).total(), first.choice()->candidates.size());
  const std::vector<std::uint32_t>& order = choice.surface->order;
  EXPECT_LT(std::find(order.begin(), order.end(), left), std::find(order.begin(), order.end(), *choice.segment));
  std::vector<ContourPoint> points;
  const auto contours_of_segments = choice.contours->points_of_segments(order.size());
  for (const std::uint32_t contour : contours_of_segments[left]) points.push_back(choice.contours->points[contour]);
  const std::vector<Pose> all = contour_views(points, config().contour_views).value();
  const auto gains = evaluate_views(scanned(), first.choice()->region, all, gain(), Executor{})->gains;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_TRUE(static_cast<double>(gains[i]) < wanted.planner.min_gain || attempts.contains(0, all[i]));
  }
}

TEST_F(Attention, WhenNoViewGainsEnoughTheRegionIsDoneOrOutOfReach) {
  SimulatedRunConfig wanted = config();
  wanted.planner.min_gain = 1e9;
  const Ranking none = ranked(attention(wanted), scene(scanned()));
  EXPECT_TRUE(none.empty());
  EXPECT_FALSE(none.attention());
  const Seen seen = look_at_map(scanned(), wanted);
  const std::vector<std::uint32_t>& owners = seen.contours.segment_of_point;
  EXPECT_EQ(none.evaluated(),
            40 * (owners.size() - static_cast<std::size_t>(std::count(owners.begin(), owners.end(), kUnlabelled))));
  ASSERT_EQ(none.left().size(), 1U);
  EXPECT_EQ(none.left()[0].second.status, RegionStatus::done);
  const std::vector<double> best = best_gains(seen, scanned(), wanted, gain());
  EXPECT_EQ(none.left()[0].second.gain_left, *std::max_element(best.begin(), best.end()));
  // A view that would gain enough, but that the robot could not take.
  wanted.planner.min_gain = *std::max_element(best.begin(), best.end());
  Attempts attempts;
  for (;;) {
    const Ranking ranking = ranked(attention(wanted), scene(scanned(), &attempts));
    if (ranking.empty()) {
      EXPECT_EQ(ranking.left()[0].second.status, RegionStatus::out_of_reach);
      EXPECT_EQ(ranking.left()[0].second.refused, attempts.refusals_of(0));
      break;
    }
    attempts.add_refused(0, ranking.as_good_as_best(0.0), Refusal::no_path);
  }
  EXPECT_GT(attempts.refusals_of(0).total(), 0U);
}

/// Takes the camera nowhere.
class LameRobot final : public Robot {
 public:
  [[nodiscard]] std::vector<std::optional<Refusal>> test(std::span<const Pose> poses,
                                                         const Executor& /*executor*/) const override {
    return std::vector<std::optional<Refusal>>(poses.size(), Refusal::no_ik);
  }
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> /*poses*/, MotionKind /*way*/) override {
    return PlannedMotion{std::nullopt, Refusal::no_ik, ""};
  }
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& /*motion*/,
                                                       const MotionObserver& /*on_way*/) override {
    return std::optional<Arrival>{};
  }
};

TEST_F(Attention, ViewsThatTheRobotRefusesAreNotEvaluated) {
  const LameRobot robot;
  const Ranking none = ranked(attention(), scene(scanned(), nullptr, &robot));
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.evaluated(), 0U);
  EXPECT_GT(none.refused().of(Refusal::no_ik), 0U);
  EXPECT_EQ(none.left()[0].second.status, RegionStatus::out_of_reach);
}

TEST_F(Attention, NothingIsRankedForAnEmptyMap) {
  const TsdfSnapshot empty = empty_map().snapshot();
  for (const char* name : {"attention", "standard", "random-contours", "oracle"}) {
    const Ranking ranking = ranked(planner(name), scene(empty));
    EXPECT_TRUE(ranking.empty()) << name;
    EXPECT_EQ(ranking.candidates(), 0U) << name;
  }
}

TEST_F(Attention, WhatAPlannerKeptChangesNothing) {
  ViewPlanner used = attention();
  EXPECT_TRUE(used.rank(scene(empty_map().snapshot())));
  TsdfMap changed{scanned()};
  ASSERT_TRUE(changed.forget(Sphere{{0.0, 0.0, 0.1}, 0.15}).ok());
  EXPECT_TRUE(used.rank(scene(changed.content())));
  const ViewChoice a = *ranked(attention(), scene(scanned())).choice();
  const ViewChoice b = *used.rank(scene(scanned()))->choice();
  EXPECT_EQ(a.segment, b.segment);
  ASSERT_EQ(a.candidates.size(), b.candidates.size());
  for (std::size_t i = 0; i < a.candidates.size(); ++i) {
    EXPECT_EQ(a.candidates[i].gain, b.candidates[i].gain);
    EXPECT_EQ(a.candidates[i].T_world_camera.matrix(), b.candidates[i].T_world_camera.matrix());
  }
}

TEST_F(Attention, ScrapsComeLast) {
  SimulatedRunConfig with_scraps = config();
  with_scraps.attention.scrap_length_m = 0.5;
  const Seen scraps = look_at_map(scanned(), with_scraps);
  const SalientSurface& seen = *scraps.surface;
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
  const Seen seen = look_at_map(scanned(), config());
  const std::vector<double> best = best_gains(seen, scanned(), config(), gain());
  const std::vector<std::uint32_t>& order = seen.surface->order;
  const auto gaining = std::find_if(order.begin(), order.end(), [&](std::uint32_t segment) {
    return best[segment] >= config().planner.min_gain && best[segment] < *std::max_element(best.begin(), best.end());
  });
  ASSERT_NE(gaining, order.end());
  SimulatedRunConfig scraps = config();
  scraps.attention.saliency = [&](const MeasuredSegments& segments) {
    std::vector<Saliency> all(segments.measures.size(), Saliency{0.9, "all alike"});
    all[*gaining].value = 1.0;
    return all;
  };
  scraps.planner.rival_share = 0.1;
  EXPECT_NE(ranked(attention(scraps), scene(scanned())).choice()->segment, *gaining);
  scraps.attention.scrap_length_m = 10.0;  // all are: then they do not compete
  EXPECT_EQ(ranked(attention(scraps), scene(scanned())).choice()->segment, *gaining);
}

TEST_F(Attention, ExploresWhenTheFirstSegmentCannotBeReached) {
  const ViewPlanner strategy = attention();
  const std::optional<std::uint32_t> first = ranked(strategy, scene(scanned())).choice()->segment;
  const Attempts of_first =
      refused_until_the_next_segment(strategy, [](const Attempts& tried) { return scene(scanned(), &tried); });
  class Declining final : public Robot {
   public:
    explicit Declining(std::function<bool(const Pose&)> no) : no_{std::move(no)} {}
    Result<PlannedMotion> plan(std::span<const Pose> poses, MotionKind /*way*/) override {
      if (no_(poses[0])) return PlannedMotion{std::nullopt, Refusal::no_path, ""};
      return PlannedMotion{Motion{0, poses[0], {}, 0.0}, std::nullopt, ""};
    }
    Result<std::optional<Arrival>> execute(const Motion& motion, const MotionObserver& /*on_way*/) override {
      return std::optional{Arrival{motion.T_world_camera, 0.0}};
    }

   private:
    std::function<bool(const Pose&)> no_;
  };
  // The robot declines everything that the first segment has to offer.
  Declining robot{[&](const Pose& pose) { return of_first.contains(0, pose); }};
  SimulatedCamera camera = *simulated_camera(rays(), config());
  FunctionCamera sensor{config().camera, [&](const Pose& pose) -> Result<Frame> { return camera.capture(pose); }};
  TsdfMap map{scanned()};
  ExplorerConfig exploration = config().exploration;
  exploration.max_views = 1;
  const Executor executor;
  Explorer explorer{{map, sensor, robot, executor}, exploration};
  ViewPlanner planner = strategy;
  const RunRecord result = explorer.explore(planner).value();
  ASSERT_EQ(result.views.size(), 1U);
  ASSERT_TRUE(result.views[0].attention);
  EXPECT_NE(result.views[0].choice->segment, first);
  EXPECT_GT(result.views[0].refused.of(Refusal::no_path), 0U);
  EXPECT_FALSE(of_first.contains(0, result.views[0].T_world_camera));
}

TEST_F(Attention, CoversTheObjectsOfAClutter) {
  if (test::kSanitized) GTEST_SKIP() << "several runs take long under sanitizers; other tests make one";
  SimulatedRunConfig run = config();
  run.exploration.max_views = 6;
  const RunRecord attentive = *run_simulated(truth(), run, Executor::with_threads(2));
  EXPECT_GT(attentive.final().coverage.value(), attentive.scan.measures.coverage.value() + 0.2);
  EXPECT_GT(attentive.final().coverage.value(), 0.85);
  std::size_t at_objects{0};
  for (const ViewRecord& view : attentive.views) {
    at_objects += looks_at_object(truth(), view.T_world_camera) ? 1 : 0;
  }
  EXPECT_GE(at_objects, 2U);
}

}  // namespace
}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/ompl_search.hpp"

#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/est/BiEST.h>
#include <ompl/geometric/planners/est/EST.h>
#include <ompl/geometric/planners/kpiece/BKPIECE1.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/kpiece/LBKPIECE1.h>
#include <ompl/geometric/planners/rrt/BiTRRT.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/sbl/SBL.h>
#include <ompl/geometric/planners/stride/STRIDE.h>
#include <ompl/util/Console.h>

#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>

#include "saccade/core/clock.hpp"

namespace saccade {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

using PlannerMaker = ob::PlannerPtr (*)(const ob::SpaceInformationPtr& information);
template <class Planner>
ob::PlannerPtr make(const ob::SpaceInformationPtr& information) {
  return std::make_shared<Planner>(information);
}
struct NamedPlanner {
  const char* name;
  PlannerMaker make;
};
constexpr NamedPlanner kPlanners[]{{"RRTConnect", make<og::RRTConnect>},
                                   {"RRT", make<og::RRT>},
                                   {"BiTRRT", make<og::BiTRRT>},
                                   {"EST", make<og::EST>},
                                   {"BiEST", make<og::BiEST>},
                                   {"KPIECE1", make<og::KPIECE1>},
                                   {"BKPIECE1", make<og::BKPIECE1>},
                                   {"LBKPIECE1", make<og::LBKPIECE1>},
                                   {"SBL", make<og::SBL>},
                                   {"STRIDE", make<og::STRIDE>}};

/// Silences OMPL's messages to the terminal while an instance lives. Restores the program's own setting afterwards.
class OmplLogSilencer {
 public:
  OmplLogSilencer() {
    const std::lock_guard lock{mutex()};
    if (living()++ > 0) return;
    before() = ompl::msg::getOutputHandler();
    ompl::msg::noOutputHandler();
  }
  ~OmplLogSilencer() {
    const std::lock_guard lock{mutex()};
    if (--living() == 0) ompl::msg::useOutputHandler(before());
  }
  OmplLogSilencer(const OmplLogSilencer&) = delete;
  OmplLogSilencer& operator=(const OmplLogSilencer&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  static int& living() {
    static int count{0};
    return count;
  }
  static ompl::msg::OutputHandler*& before() {
    static ompl::msg::OutputHandler* handler{nullptr};
    return handler;
  }
};

/// Scale of OMPL's states, which hold joints in seconds at full speed.
class Scale {
 public:
  explicit Scale(const ArmModel& arm) : speed_{arm.dof()} {
    for (int i = 0; i < arm.dof(); ++i) speed_[i] = arm.joint(i).limits.speed;
  }
  [[nodiscard]] Configuration configuration(const ob::State* state) const {
    const double* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
    Configuration q{speed_.size()};
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = values[i] * speed_[i];
    return q;
  }
  void write(const Configuration& q, ob::State* state) const {
    double* values = state->as<ob::RealVectorStateSpace::StateType>()->values;
    for (Eigen::Index i = 0; i < q.size(); ++i) values[i] = q[i] / speed_[i];
  }
  /// Returns the limits, widened for a start beyond them by rounding; for continuous joints a turn around start and
  /// goals.
  [[nodiscard]] ob::RealVectorBounds bounds(const ArmModel& arm, const Configuration& start,
                                            std::span<const Configuration> goals) const {
    ob::RealVectorBounds bounds(static_cast<unsigned>(arm.dof()));
    for (int i = 0; i < arm.dof(); ++i) {
      double lower = start[i];
      double upper = start[i];
      for (const Configuration& goal : goals) {
        lower = std::min(lower, goal[i]);
        upper = std::max(upper, goal[i]);
      }
      const JointLimits& limits = arm.joint(i).limits;
      const bool endless = arm.joint(i).kind == JointKind::continuous;
      lower = endless ? lower - 2.0 * std::numbers::pi : std::min(lower, limits.lower);
      upper = endless ? upper + 2.0 * std::numbers::pi : std::max(upper, limits.upper);
      bounds.setLow(static_cast<unsigned>(i), lower / speed_[i]);
      bounds.setHigh(static_cast<unsigned>(i), upper / speed_[i]);
    }
    return bounds;
  }

 private:
  Configuration speed_;
};

class FreeMotions final : public ob::MotionValidator {
 public:
  FreeMotions(const ob::SpaceInformationPtr& information, const MotionSpace& space, const Scale& scale, int& motions)
      : ob::MotionValidator{information}, space_{space}, scale_{scale}, motions_{motions} {}
  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    ++motions_;
    return space_.motion_is_free(scale_.configuration(from), scale_.configuration(to));
  }
  /// For planners that extend as far as possible: halves the motion repeatedly to get close.
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    constexpr int kHalvings{5};
    if (checkMotion(from, to)) return true;
    const Configuration a = scale_.configuration(from);
    const Configuration b = scale_.configuration(to);
    double free = 0.0;
    double share = 0.5;
    for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
      ++motions_;
      if (space_.motion_is_free(a + free * (b - a), a + (free + share) * (b - a))) free += share;
    }
    last_valid.second = free;
    if (last_valid.first != nullptr) scale_.write(a + free * (b - a), last_valid.first);
    return false;
  }

 private:
  const MotionSpace& space_;
  const Scale& scale_;
  int& motions_;
};

/// Rounds of a planner per allowed motion. Most rounds check one motion; the limit also ends planners that seldom check
/// any.
constexpr int kRounds{4};

/// Seeds that OMPL's generators take.
constexpr std::uint64_t kSeeds{1U << 31U};

/// Returns the mutex for OMPL's generators, which draw their seeds from one generator of the process. Hold it while
/// creating any.
std::recursive_mutex& seeds_mutex() {
  static std::recursive_mutex one;
  return one;
}

class SeededSampler final : public ob::RealVectorStateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, std::uint64_t seed) : ob::RealVectorStateSampler{space} {
    rng_.setLocalSeed(static_cast<std::uint_fast32_t>(seed % kSeeds));
  }
};

/// Returns space and planner, both ready. From setting the process's seed until here no other thread creates a
/// generator, so that projections and planner get equal ones every time.
ob::PlannerPtr seeded_planner(const NamedPlanner& named, const ob::SpaceInformationPtr& information,
                              const ob::ProblemDefinitionPtr& problem, std::uint64_t seed) {
  const std::lock_guard lock{seeds_mutex()};
  ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(seed % kSeeds) + 1);
  information->setup();
  ob::PlannerPtr planner = named.make(information);
  planner->setProblemDefinition(problem);
  planner->setup();
  return planner;
}

}  // namespace

std::vector<std::string> ompl_planner_names() {
  std::vector<std::string> names;
  for (const NamedPlanner& planner : kPlanners) names.emplace_back(planner.name);
  return names;
}

SearchResult search_with_ompl(const std::string& planner, const MotionSpace& space, const Configuration& start,
                              std::span<const Configuration> goals, const SearchEffort& effort) {
  const auto* named = std::find_if(std::begin(kPlanners), std::end(kPlanners),
                                   [&](const NamedPlanner& known) { return planner == known.name; });
  SACCADE_EXPECTS(named != std::end(kPlanners) && !goals.empty());
  const OmplLogSilencer silence;
  const Scale scale{space.arm};
  SearchResult result;
  const Stopwatch stopwatch;
  std::int64_t rounds{0};

  const auto joints = std::make_shared<ob::RealVectorStateSpace>(static_cast<unsigned>(space.arm.dof()));
  joints->setBounds(scale.bounds(space.arm, start, goals));
  std::uint64_t next_seed = effort.seed;
  joints->setStateSamplerAllocator([&next_seed](const ob::StateSpace* sampled) {
    const std::lock_guard lock{seeds_mutex()};
    return std::make_shared<SeededSampler>(sampled, next_seed++);
  });
  const auto information = std::make_shared<ob::SpaceInformation>(joints);
  information->setStateValidityChecker(
      [&](const ob::State* state) { return space.is_free(scale.configuration(state)); });
  information->setMotionValidator(std::make_shared<FreeMotions>(information, space, scale, result.motions));

  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  ob::ScopedState<ob::RealVectorStateSpace> state{joints};
  scale.write(start, state.get());
  problem->addStartState(state);
  const auto wanted = std::make_shared<ob::GoalStates>(information);
  for (const Configuration& goal : goals) {
    scale.write(goal, state.get());
    wanted->addState(state.get());
  }
  problem->setGoal(wanted);

  const ob::PlannerPtr searching = seeded_planner(*named, information, problem, effort.seed);
  searching->solve(ob::PlannerTerminationCondition{[&] {
    result.out_of_time = stopwatch.elapsed_ms() > 1e3 * effort.budget_s;
    return result.out_of_time || result.motions >= effort.max_motions || ++rounds / kRounds >= effort.max_motions;
  }});
  if (!problem->hasExactSolution()) return result;
  const auto& found = *problem->getSolutionPath()->as<og::PathGeometric>();
  JointPath path;
  for (std::size_t i = 0; i < found.getStateCount(); ++i) {
    path.push_back(scale.configuration(found.getState(static_cast<unsigned>(i))));
  }
  // Scaling rounds, so the known ends are written back.
  path.front() = start;
  path.back() = *std::min_element(goals.begin(), goals.end(), [&](const Configuration& a, const Configuration& b) {
    return (a - path.back()).squaredNorm() < (b - path.back()).squaredNorm();
  });
  result.path = std::move(path);
  result.out_of_time = false;
  return result;
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/loops/loop_closer.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/loops/internal/closure_check.hpp"
#include "saccade/map/raycast.hpp"

namespace saccade {

namespace {

/// Surfaces are compared in images that are at most so wide.
constexpr int kWidest_px{320};

/// Standard deviations in the pose graph: of a closure, and of a step between keyframes, which grows with its length.
constexpr double kClosureSigma_m{0.001};
constexpr double kClosureSigma_rad{0.0007};
constexpr double kStepSigma_m{0.0003};
constexpr double kStepSigma_rad{0.0002};

PoseEdge closure_edge(const Closure& closure) {
  return {closure.from, closure.to, closure.T_from_to, kClosureSigma_rad, kClosureSigma_m, true};
}

}  // namespace

double DriftModel::sigmas(const Pose& T_predicted, const Pose& T_found, double travel_m) const {
  const Pose off = T_predicted.inverse() * T_found;
  const double shift = off.translation().norm() / std::hypot(floor_m, translation_share * travel_m);
  const double turn = rotation_angle_rad(off) / std::hypot(floor_rad, rotation_rad_per_m * travel_m);
  return std::max(shift, turn);
}

Status LoopConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "loop configuration"}; };
  SACCADE_CHECK(places.validate());
  SACCADE_CHECK(graph.validate());
  if (!(keyframe_distance_m > 0.0) || !(keyframe_turn_rad > 0.0)) return fail("keyframes need a positive distance");
  if (!(min_travel_m > keyframe_distance_m)) return fail("the way of a loop must be longer than between keyframes");
  if (max_candidates < 1 || confirm_within < 1 || model_frames < 0) return fail("numbers must be positive");
  if (!(max_sigmas > 0.0) || !(confirm_m > 0.0) || !(confirm_rad > 0.0)) return fail("limits must be positive");
  if (!(drift.floor_m > 0.0) || !(drift.floor_rad > 0.0) || !(drift.translation_share >= 0.0) ||
      !(drift.rotation_rad_per_m >= 0.0)) {
    return fail("deviations of the drift model must be positive");
  }
  return {};
}

struct LoopCloser::State {
  /// A frame that loops may be closed at.
  struct Keyframe {
    std::size_t frame{0};                 ///< in the trajectory
    double travel_m{0.0};                 ///< length of the way to it
    std::optional<PointImage> surface{};  ///< around it, once it was needed
  };

  PinholeCamera camera;
  TsdfConfig map;
  ReadFrame read;
  LoopConfig config;
  PlaceIndex places;
  PinholeCamera small_camera{};

  std::vector<TrackedFrame> trajectory{};  ///< as tracked
  std::vector<Keyframe> keyframes{};
  std::vector<Pose> T_world_keyframe{};  ///< corrected
  std::vector<PoseEdge> edges{};
  std::vector<Closure> waiting{};  ///< for another that says the same
  LoopCounts counts{};

  [[nodiscard]] const Pose& tracked(std::size_t keyframe) const {
    return trajectory[keyframes[keyframe].frame].T_world_camera;
  }
  [[nodiscard]] Pose tracked_between(std::size_t from, std::size_t to) const {
    return tracked(from).inverse() * tracked(to);
  }
  [[nodiscard]] bool wants_keyframe() const;
  [[nodiscard]] Result<bool> take_keyframe(const Executor& executor);
  [[nodiscard]] Result<PointImage> surface_around(std::size_t frame, const Executor& executor) const;
  [[nodiscard]] Result<std::vector<Closure>> find_closures(const std::vector<PlaceMatch>& alike, std::size_t last,
                                                           const Executor& executor);
  void reject_contradicting(std::vector<Closure>& found);
  [[nodiscard]] bool say_the_same(const Closure& a, const Closure& b) const;
  [[nodiscard]] std::vector<Closure> confirmed(const std::vector<Closure>& found);
  [[nodiscard]] Status solve();
};

bool LoopCloser::State::wants_keyframe() const {
  if (keyframes.empty()) return true;
  const Pose moved = tracked(keyframes.size() - 1).inverse() * trajectory.back().T_world_camera;
  return moved.translation().norm() >= config.keyframe_distance_m ||
         rotation_angle_rad(moved) >= config.keyframe_turn_rad;
}

/// Fuses the frames around one of them, as far as there are any yet, and looks at the result from there: points of the
/// surface with less noise than one image has.
Result<PointImage> LoopCloser::State::surface_around(std::size_t frame, const Executor& executor) const {
  SACCADE_TRY(TsdfMap around, TsdfMap::create(map));
  const auto reach = static_cast<std::size_t>(config.model_frames);
  const std::size_t first = frame - std::min(frame, reach);
  const std::size_t end = std::min(trajectory.size(), frame + reach + 1);
  SACCADE_CHECK(fuse_along(around, camera, std::span{trajectory}.subspan(first, end - first), read, executor));
  SACCADE_TRY(const SurfaceView view,
              raycast(around.content(), small_camera, trajectory[frame].T_world_camera, executor));
  return to_points(view, executor);
}

/// Closures of the last keyframe that surface and drift model allow.
Result<std::vector<Closure>> LoopCloser::State::find_closures(const std::vector<PlaceMatch>& alike, std::size_t last,
                                                              const Executor& executor) {
  std::vector<Closure> found;
  if (alike.empty()) return found;
  SACCADE_TRY(const PointImage measured, surface_around(keyframes[last].frame, executor));
  const std::vector<double> ways = internal::loops::ways_from(last, keyframes.size(), edges);
  for (const PlaceMatch& match : alike) {
    if (match.dissimilarity > config.max_dissimilarity) continue;
    ++counts.candidates;
    const Pose T_old_new = T_world_keyframe[match.place].inverse() * T_world_keyframe[last];
    Keyframe& old = keyframes[match.place];
    if (!old.surface) {
      SACCADE_TRY(old.surface, surface_around(old.frame, executor));
    }
    const std::optional<Pose> T_found =
        internal::loops::verified_closure(*old.surface, measured, small_camera, T_old_new, config, executor);
    if (!T_found) {
      ++counts.rejected_by_surface;
    } else if (config.drift.sigmas(T_old_new, *T_found, ways[match.place]) > config.max_sigmas) {
      ++counts.rejected_by_odometry;
    } else {
      found.push_back({match.place, last, *T_found});
    }
  }
  reject_contradicting(found);
  return found;
}

bool LoopCloser::State::say_the_same(const Closure& a, const Closure& b) const {
  const Pose T_predicted = tracked_between(b.from, a.from) * a.T_from_to * tracked_between(a.to, b.to);
  const Pose off = b.T_from_to.inverse() * T_predicted;
  return off.translation().norm() <= config.confirm_m && rotation_angle_rad(off) <= config.confirm_rad;
}

/// Where the closures of one keyframe say different things, none is believed.
void LoopCloser::State::reject_contradicting(std::vector<Closure>& found) {
  for (std::size_t i = 1; i < found.size(); ++i) {
    const Pose a = T_world_keyframe[found[0].from] * found[0].T_from_to;
    const Pose b = T_world_keyframe[found[i].from] * found[i].T_from_to;
    const double way = DriftModel::travel_m(tracked_between(found[0].from, found[i].from));
    if (config.drift.sigmas(a, b, way) <= config.max_sigmas) continue;
    counts.rejected_alone += found.size();
    found.clear();
  }
}

/// Closures, of before or new, that another one of another keyframe confirms. The others wait, or are given up.
std::vector<Closure> LoopCloser::State::confirmed(const std::vector<Closure>& found) {
  std::vector<Closure> accepted;
  std::vector<Closure> still_waiting;
  std::vector<bool> confirms(found.size(), false);
  for (const Closure& before : waiting) {
    bool same{false};
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!say_the_same(before, found[i])) continue;
      same = true;
      confirms[i] = true;
    }
    if (same) {
      accepted.push_back(before);
    } else if (before.to + config.confirm_within > keyframes.size() - 1) {
      still_waiting.push_back(before);
    } else {
      ++counts.rejected_alone;
    }
  }
  // Closures of the keyframes before confirm as well.
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const PoseEdge& edge : edges) {
      if (!edge.closure || edge.to + config.confirm_within < found[i].to) continue;
      if (say_the_same({edge.from, edge.to, edge.T_from_to}, found[i])) confirms[i] = true;
    }
    (confirms[i] ? accepted : still_waiting).push_back(found[i]);
  }
  waiting = std::move(still_waiting);
  return accepted;
}

Status LoopCloser::State::solve() {
  SACCADE_TRY(PoseGraphResult solved, solve_pose_graph({T_world_keyframe, edges}, config.graph));
  T_world_keyframe = std::move(solved.T_world_node);
  for (auto edge = solved.dropped.rbegin(); edge != solved.dropped.rend(); ++edge) {
    edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(*edge));
  }
  counts.dropped += solved.dropped.size();
  counts.closed -= solved.dropped.size();
  return {};
}

Result<bool> LoopCloser::State::take_keyframe(const Executor& executor) {
  SACCADE_TRY(const Frame frame, read(trajectory.back().index));
  if (frame.depth.width() != camera.width || frame.depth.height() != camera.height) {
    return Error{Errc::size_mismatch, "the depth image and the camera differ in size", frame.name};
  }
  const std::size_t last = keyframes.size();
  Keyframe keyframe{trajectory.size() - 1};
  if (last == 0) {
    T_world_keyframe.push_back(trajectory.back().T_world_camera);
  } else {
    const Pose T_step = tracked(last - 1).inverse() * trajectory.back().T_world_camera;
    const double length = DriftModel::travel_m(T_step);
    keyframe.travel_m = keyframes.back().travel_m + length;
    edges.push_back({last - 1, last, T_step, kStepSigma_rad + config.drift.rotation_rad_per_m * length,
                     kStepSigma_m + config.drift.translation_share * length, false});
    T_world_keyframe.push_back(T_world_keyframe.back() * T_step);
  }
  SACCADE_TRY(PlaceCode code, places.encode(frame.depth, frame.color ? &*frame.color : nullptr));
  std::size_t far_enough{0};
  while (far_enough < last && keyframes[far_enough].travel_m + config.min_travel_m <= keyframe.travel_m) ++far_enough;
  const std::vector<PlaceMatch> alike = places.nearest(code, config.max_candidates, far_enough);
  places.add(std::move(code));
  keyframes.push_back(std::move(keyframe));
  ++counts.keyframes;
  SACCADE_TRY(const std::vector<Closure> found, find_closures(alike, last, executor));
  const std::vector<Closure> accepted = confirmed(found);
  if (accepted.empty()) return false;
  for (const Closure& closure : accepted) edges.push_back(closure_edge(closure));
  counts.closed += accepted.size();
  SACCADE_CHECK(solve());
  return true;
}

LoopCloser::LoopCloser(std::unique_ptr<State> state) : state_{std::move(state)} {}
LoopCloser::LoopCloser(LoopCloser&&) noexcept = default;
LoopCloser& LoopCloser::operator=(LoopCloser&&) noexcept = default;
LoopCloser::~LoopCloser() = default;

Result<LoopCloser> LoopCloser::create(const PinholeCamera& camera, const TsdfConfig& map, ReadFrame read,
                                      const LoopConfig& config) {
  if (pose_graph_solver().empty()) {
    return Error{Errc::unavailable, "this build closes no loops: it lacks libceres-dev", "loops"};
  }
  SACCADE_CHECK(config.validate());
  SACCADE_CHECK(camera.validate());
  SACCADE_TRY(PlaceIndex places, PlaceIndex::create(config.places));
  TsdfConfig surroundings = map;
  surroundings.color = false;
  surroundings.workspace.reset();
  SACCADE_CHECK(surroundings.validate());
  auto state = std::make_unique<State>(State{camera, surroundings, std::move(read), config, std::move(places)});
  state->small_camera = camera.width > kWidest_px ? camera.scaled_to_width(kWidest_px) : camera;
  return LoopCloser{std::move(state)};
}

Result<bool> LoopCloser::add(const TrackedFrame& frame, const Executor& executor) {
  state_->trajectory.push_back(frame);
  if (!state_->wants_keyframe()) return false;
  return state_->take_keyframe(executor);
}

Result<bool> LoopCloser::finish(const Executor& executor) {
  if (state_->trajectory.empty() || state_->keyframes.back().frame + 1 == state_->trajectory.size()) return false;
  return state_->take_keyframe(executor);
}

std::vector<Pose> LoopCloser::poses() const {
  std::vector<Pose> tracked;
  std::vector<std::size_t> corrected;
  for (const TrackedFrame& frame : state_->trajectory) tracked.push_back(frame.T_world_camera);
  for (const State::Keyframe& keyframe : state_->keyframes) corrected.push_back(keyframe.frame);
  if (corrected.empty()) return tracked;
  return carried_along(tracked, corrected, state_->T_world_keyframe);
}

std::size_t LoopCloser::frames() const { return state_->trajectory.size(); }

const LoopCounts& LoopCloser::counts() const { return state_->counts; }

std::vector<Closure> LoopCloser::closures() const {
  std::vector<Closure> closures;
  for (const PoseEdge& edge : state_->edges) {
    if (!edge.closure) continue;
    closures.push_back({state_->keyframes[edge.from].frame, state_->keyframes[edge.to].frame, edge.T_from_to});
  }
  return closures;
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/loops/background_loops.hpp"

#include <array>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>

namespace saccade {
namespace {

/// A map is worth being fused again where a frame moves by more than this, or turns by as many radians.
constexpr double kWorthwhile_m{0.002};
/// Frames whose images are kept, so that the newest are fused without reading them.
constexpr std::size_t kKeptImages{3};

}  // namespace

struct BackgroundLoops::State {
  /// The map that is fused again.
  struct Refusion {
    TsdfMap map;
    std::vector<Pose> T_world_camera;  ///< corrected
    std::size_t done{0};               ///< frames in the map: the first of these
  };

  State(LoopCloser closes, const TsdfConfig& map_config, const PinholeCamera& of_frames, ReadFrame reads)
      : closer{std::move(closes)}, map{map_config}, camera{of_frames}, read{std::move(reads)} {}

  LoopCloser closer;
  TsdfConfig map;
  PinholeCamera camera;
  ReadFrame read;

  std::mutex mutex{};
  std::condition_variable changed{};
  // Guarded by the mutex:
  std::vector<TrackedFrame> frames{};  ///< along the tracked motions, without corrections
  std::deque<std::shared_ptr<const Frame>> newest{};
  std::optional<Refusion> ready{};  ///< waits to be exchanged
  std::optional<TsdfMap> old_map{};
  bool ending{false};
  bool stopped{false};
  std::size_t exchanges{0};
  // For the thread that fuses alone:
  Pose T_world_last{Pose::Identity()};  ///< in the reconstruction's world
  std::vector<Pose> in_map{};           ///< pose of each frame in the reconstruction's map
  // For the other thread alone, until it ends:
  std::size_t added{0};      ///< frames in the closer
  std::vector<Pose> used{};  ///< poses along which the map was fused again last
  std::optional<Refusion> refusion{};
  Status failure{};
  std::thread thread{};

  /// Next work of the other thread.
  struct Task {
    enum class Kind { stop, free_map, fuse, add, finish };
    Kind kind{Kind::stop};
    TrackedFrame frame{};                 ///< to fuse or add
    Pose T_last_frame{Pose::Identity()};  ///< pose of its predecessor, as in `frames`
    std::shared_ptr<const Frame> images{};
    std::optional<TsdfMap> old_map{};
  };
  [[nodiscard]] Task next_task();
  [[nodiscard]] Status carry_out(const Task& task, const Executor& executor);
  [[nodiscard]] Status fuse(const Task& task, const Executor& executor);
  [[nodiscard]] bool worth_fusing_again(const std::vector<Pose>& T_world_camera) const;
  void run();
};

/// Waits until there is something to do. Takes a map that was ready back where frames have come meanwhile.
BackgroundLoops::State::Task BackgroundLoops::State::next_task() {
  std::unique_lock lock{mutex};
  for (;; changed.wait(lock)) {
    if (stopped) return {};
    if (old_map) {
      Task task{Task::Kind::free_map, {}, Pose::Identity(), {}, std::move(old_map)};
      old_map.reset();
      return task;
    }
    if (ending) {  // no map is exchanged any more
      refusion.reset();
      ready.reset();
      if (added == frames.size()) return {Task::Kind::finish};
      return {Task::Kind::add, frames[added]};
    }
    if (refusion && refusion->done == frames.size()) {
      ready = std::move(refusion);
      refusion.reset();
    }
    if (ready && ready->done < frames.size()) {
      refusion = std::move(ready);
      ready.reset();
    }
    if (refusion) {
      const std::size_t i = refusion->done;
      Task task{Task::Kind::fuse, frames[i], i > 0 ? frames[i - 1].T_world_camera : Pose::Identity()};
      for (const auto& frame : newest) {
        if (frame->index == frames[i].index) task.images = frame;
      }
      return task;
    }
    if (!ready && added < frames.size()) return {Task::Kind::add, frames[added]};
  }
}

Status BackgroundLoops::State::fuse(const Task& task, const Executor& executor) {
  Refusion& again = *refusion;
  if (again.done == again.T_world_camera.size()) {  // a frame that has come since: it follows its predecessor
    again.T_world_camera.push_back(again.T_world_camera.back() *
                                   (task.T_last_frame.inverse() * task.frame.T_world_camera));
  }
  const Pose& T_world_camera = again.T_world_camera[again.done];
  ++again.done;
  if (!task.images)
    return fuse_along(again.map, camera, std::array{TrackedFrame{task.frame.index, T_world_camera}}, read, executor);
  const ColorImage* color = task.images->color ? &*task.images->color : nullptr;
  SACCADE_CHECK(again.map.integrate(camera, task.images->depth, T_world_camera, executor, color));
  return {};
}

bool BackgroundLoops::State::worth_fusing_again(const std::vector<Pose>& T_world_camera) const {
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    if (i >= used.size()) return used.empty();
    const Pose off = used[i].inverse() * T_world_camera[i];
    if (off.translation().norm() > kWorthwhile_m || rotation_angle_rad(off) > kWorthwhile_m) return true;
  }
  return false;
}

Status BackgroundLoops::State::carry_out(const Task& task, const Executor& executor) {
  if (task.kind == Task::Kind::fuse) return fuse(task, executor);
  if (task.kind != Task::Kind::add) return {};
  ++added;
  SACCADE_TRY(const bool closed, closer.add(task.frame, executor));
  if (!closed) return {};
  std::vector<Pose> T_world_camera = closer.poses();
  if (!worth_fusing_again(T_world_camera)) return {};
  SACCADE_TRY(TsdfMap again, TsdfMap::create(map));
  used = T_world_camera;
  refusion = Refusion{std::move(again), std::move(T_world_camera), 0};
  return {};
}

void BackgroundLoops::State::run() {
  const Executor executor;  // this thread alone: the one that fuses has the others
  for (;;) {
    const Task task = next_task();
    if (task.kind == Task::Kind::stop) return;
    if (task.kind == Task::Kind::finish) {
      const auto closed = closer.finish(executor);
      if (!closed) failure = closed.error();
      return;
    }
    if (Status status = carry_out(task, executor); !status) {
      failure = std::move(status);
      return;
    }
  }
}

BackgroundLoops::BackgroundLoops(LoopCloser closer, const TsdfConfig& map, const PinholeCamera& camera, ReadFrame read)
    : state_{std::make_unique<State>(std::move(closer), map, camera, std::move(read))} {
  state_->thread = std::thread{[this] { state_->run(); }};
}

BackgroundLoops::~BackgroundLoops() { give_up(); }

void BackgroundLoops::give_up() {
  {
    const std::lock_guard lock{state_->mutex};
    state_->stopped = true;
  }
  state_->changed.notify_all();
  if (state_->thread.joinable()) state_->thread.join();
}

void BackgroundLoops::fused(const Pose& T_world_camera, Frame frame) {
  State& state = *state_;
  const auto kept = std::make_shared<const Frame>(std::move(frame));
  {
    const std::lock_guard lock{state.mutex};
    const Pose T_world_new = state.frames.empty()
                                 ? T_world_camera
                                 : state.frames.back().T_world_camera * (state.T_world_last.inverse() * T_world_camera);
    state.frames.push_back({kept->index, T_world_new});
    state.newest.push_back(kept);
    if (state.newest.size() > kKeptImages) state.newest.pop_front();
  }
  state.T_world_last = T_world_camera;
  state.in_map.push_back(T_world_camera);
  state.changed.notify_all();
}

bool BackgroundLoops::correct(Reconstruction& reconstruction) {
  State& state = *state_;
  const std::unique_lock lock{state.mutex, std::try_to_lock};
  if (!lock.owns_lock() || !state.ready || state.ready->done != state.frames.size()) return false;
  state.T_world_last = state.ready->T_world_camera.back();
  state.old_map = reconstruction.exchange_map(std::move(state.ready->map), state.T_world_last);
  state.in_map = std::move(state.ready->T_world_camera);
  state.ready.reset();
  ++state.exchanges;
  state.changed.notify_all();
  return true;
}

Status BackgroundLoops::finish() {
  State& state = *state_;
  {
    const std::lock_guard lock{state.mutex};
    state.ending = true;
  }
  state.changed.notify_all();
  if (state.thread.joinable()) state.thread.join();
  return state.failure;
}

std::vector<Pose> BackgroundLoops::poses_in_map() const { return state_->in_map; }

std::vector<Pose> BackgroundLoops::poses() const { return state_->closer.poses(); }
const LoopCounts& BackgroundLoops::counts() const { return state_->closer.counts(); }
std::vector<Closure> BackgroundLoops::closures() const { return state_->closer.closures(); }
std::size_t BackgroundLoops::exchanges() const { return state_->exchanges; }

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
// The library called from several threads at once: answers equal those of a call alone to the bit, readers go on while
// a frame is fused, and no more threads run than the executors promise.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <thread>
#include <vector>

#include "saccade/map/raycast.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/tracking/icp.hpp"
#include "saccade/views/internal/best_views.hpp"
#include "saccade/views/view_gain.hpp"
#include "saccade/views/view_sphere.hpp"
#include "support/effort.hpp"
#include "support/parallel_backend.hpp"
#include "support/thread_watch.hpp"

namespace saccade {
namespace {

const PinholeCamera kCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.2, 3.0};

struct View {
  Pose T_world_camera;
  DepthImage depth;
};

/// The table-top from a few sides.
const std::vector<View>& views() {
  static const std::vector<View> made = [] {
    std::vector<View> list;
    for (const Pose& T_world_camera : sample_trajectory(60)) {
      if (list.size() == 4) break;
      auto frame = render(sample_tabletop(), kCamera, T_world_camera);
      EXPECT_TRUE(frame.ok());
      list.push_back({T_world_camera, std::move(frame->depth)});
    }
    return list;
  }();
  return made;
}

TsdfMap empty_map() {
  TsdfConfig config;
  config.voxel_size_m = 0.015;
  auto map = TsdfMap::create(config);
  EXPECT_TRUE(map.ok());
  return std::move(map).value();
}

const Region kRegion{Sphere{{0.0, 0.0, 0.05}, 0.2}};

/// A map's life: nothing known, free space around an unknown ball, then the views.
constexpr std::size_t kSteps{7};
bool take_step(TsdfMap& map, std::size_t step, const Executor& executor) {
  switch (step) {
    case 0: return map.forget(Box{Eigen::Vector3d::Constant(-4.0), Eigen::Vector3d::Constant(4.0)}).ok();
    case 1: return map.free(Box{{-0.9, -0.9, -0.3}, {0.9, 0.9, 0.9}}).ok();
    case 2: return map.forget(kRegion).ok();
    default: break;
  }
  const View& view = views()[step - 3];
  return map.integrate(kCamera, view.depth, view.T_world_camera, executor).ok();
}

std::vector<Pose> candidates() {
  ViewSphereConfig sphere;
  sphere.radii_m = {0.6};
  sphere.longitude_step_rad = 1.0471975511965976;
  sphere.latitude_min_rad = 0.5;
  sphere.latitude_step_rad = 0.5;
  sphere.roll_step_rad = 3.1415926535897932;
  const auto made = view_sphere({0.0, 0.0, 0.05}, sphere);
  EXPECT_TRUE(made.ok());
  return poses_of(*made);
}

GainConfig small_sensor() {
  GainConfig config;
  config.sensor = {96, 72, 78.75, 78.75, 47.5, 35.5, 0.2, 3.0};
  return config;
}

std::vector<std::uint64_t> gains(const TsdfSnapshot& map, const Executor& executor, const Progress& progress = {}) {
  const auto result = evaluate_views(map, kRegion, candidates(), small_sensor(), executor, progress);
  EXPECT_TRUE(result.ok());
  return result.ok() ? result->gains : std::vector<std::uint64_t>{};
}

/// Results of the library for the views: map, gains, best views, ray cast, aligned pose.
struct Answers {
  TsdfGrid grid;
  std::vector<std::uint64_t> gains;
  std::vector<std::size_t> best;
  DepthImage depth;
  std::vector<Eigen::Vector3f> normals;
  Eigen::Matrix4d T_model_camera;

  bool operator==(const Answers&) const = default;
};

Answers answers(const Executor& executor) {
  Answers given;
  TsdfMap map = empty_map();
  for (std::size_t step = 0; step < kSteps; ++step) EXPECT_TRUE(take_step(map, step, executor));
  const TsdfSnapshot snapshot = map.snapshot();
  given.grid = snapshot.grid;
  given.gains = gains(snapshot, executor);
  const auto best = best_views(snapshot, kRegion, candidates(), 3, small_sensor(), executor);
  EXPECT_TRUE(best.ok());
  for (const OrderedView& view : best->views) given.best.push_back(view.index);
  const auto surface = raycast(snapshot, kCamera, views()[1].T_world_camera, executor);
  EXPECT_TRUE(surface.ok());
  given.depth = surface->depth;
  given.normals.assign(surface->normals.pixels().begin(), surface->normals.pixels().end());
  const IcpResult aligned = align(to_points(views()[2].depth, kCamera, executor), to_points(*surface, executor),
                                  kCamera, Pose::Identity(), executor);
  EXPECT_TRUE(aligned.converged) << aligned.why;
  given.T_model_camera = aligned.T_model_camera.matrix();
  return given;
}

const Answers& expected() {
  static const Answers alone = answers(Executor{});
  return alone;
}

TEST(ConcurrentUse, ThreadCountsNeverChangeABit) {
  EXPECT_GT(expected().grid.usage().dense_bricks, 100U);
  EXPECT_GT(*std::max_element(expected().gains.begin(), expected().gains.end()), 100U);
  EXPECT_EQ(expected().best.size(), 3U);
  for (const std::size_t threads : {1U, 2U, 7U}) {
    EXPECT_TRUE(answers(Executor::with_threads(threads)) == expected()) << threads << " threads";
  }
}

/// Answers of several threads that ask at once, `rounds` times each; returns how many were right.
int right_answers(const std::vector<Executor>& callers, int rounds) {
  std::atomic<int> right{0};
  std::vector<std::thread> threads;
  for (const Executor& executor : callers) {
    threads.emplace_back([&right, &executor, rounds] {
      for (int round = 0; round < rounds; ++round) right += answers(executor) == expected() ? 1 : 0;
    });
  }
  for (std::thread& thread : threads) thread.join();
  return right;
}

constexpr int kRounds{test::scaled_cases(12)};
constexpr int kCallers{4};

TEST(ConcurrentUse, CallersWithTheirOwnExecutorsGetWhatTheyGetAlone) {
  ASSERT_FALSE(expected().gains.empty());
  const std::size_t cores = Executor::with_threads(0).threads();
  const std::size_t before = test::count_threads();  // with sleeping workers of earlier tests
  std::vector<Executor> own;
  for (int i = 0; i < kCallers; ++i) own.push_back(Executor::with_threads(0));
  test::ThreadWatch watch;
  EXPECT_EQ(right_answers(own, kRounds), kCallers * kRounds);
  const std::size_t most = watch.stop();
  if (test::kParallelBackend == Executor::Backend::tbb) {
    EXPECT_LE(most, before + kCallers + cores - 1);
  }
  EXPECT_GE(most, before + kCallers) << "the callers were not seen at work";
}

TEST(ConcurrentUse, CallersThatShareAnExecutorGetWhatTheyGetAlone) {
  const std::vector<Executor> shared(kCallers, Executor::with_threads(2, test::kParallelBackend));
  EXPECT_EQ(right_answers(shared, kRounds), kCallers * kRounds);
}

TEST(ConcurrentUse, MixedNumbersOfThreadsGetWhatTheyGetAlone) {
  const std::vector<Executor> mixed{Executor{}, Executor::with_threads(2), Executor::with_threads(7),
                                    Executor::with_threads(3, Executor::Backend::std_thread)};
  EXPECT_EQ(right_answers(mixed, kRounds), kCallers * kRounds);
}

/// The map after each step, and the gains there.
struct States {
  std::vector<TsdfSnapshot> maps;
  std::vector<std::vector<std::uint64_t>> gains;

  States() {
    TsdfMap map = empty_map();
    for (std::size_t step = 0; step < kSteps; ++step) {
      EXPECT_TRUE(take_step(map, step, Executor{}));
      maps.push_back(map.snapshot());
      gains.push_back(saccade::gains(maps.back(), Executor{}));
    }
  }
  /// After which step a map is as this one; kSteps if after none.
  [[nodiscard]] std::size_t find(const TsdfSnapshot& map) const {
    std::size_t step{0};
    while (step < kSteps && !(maps[step].grid == map.grid)) ++step;
    return step;
  }
};

TEST(ConcurrentUse, FramesAreFusedInTheMiddleOfAnEvaluation) {
  const States states;
  TsdfMap map = empty_map();
  for (std::size_t step = 0; step < 4; ++step) ASSERT_TRUE(take_step(map, step, Executor{}));
  const TsdfSnapshot snapshot = map.snapshot();
  // Were fusion to wait for the reader, which waits for it here, neither would go on.
  int reports{0};
  const Progress in_the_middle{[&](std::string_view, std::size_t, std::size_t) {
    if (++reports != 2) return;
    auto fusing = std::async(std::launch::async, [&] {
      const Executor executor = Executor::with_threads(2);
      return take_step(map, 4, executor) && take_step(map, 5, executor);
    });
    ASSERT_EQ(fusing.wait_for(std::chrono::seconds{60}), std::future_status::ready);
    EXPECT_TRUE(fusing.get());
    EXPECT_EQ(states.find(map.snapshot()), 5U);
  }};
  EXPECT_EQ(gains(snapshot, Executor::with_threads(2), in_the_middle), states.gains[3]);
  EXPECT_GE(reports, 10);
  EXPECT_EQ(states.find(snapshot), 3U);
}

/// One thread forgets, frees and fuses without pause; readers take snapshots, and each is one whole state of the map
/// and stays so while it is read.
void read_while_fusing(const Executor& for_writer, const Executor& for_readers) {
  const States states;
  constexpr int kReaders{2};
  constexpr int kReadings{test::scaled_cases(40)};
  constexpr int kMostReadings{2000};
  TsdfMap map = empty_map();
  std::atomic<int> reading{kReaders};
  std::atomic<int> changes{0};
  std::atomic<int> torn{0};
  std::atomic<int> wrong{0};
  std::atomic<int> changed_meanwhile{0};
  std::vector<std::thread> readers;
  for (int i = 0; i < kReaders; ++i) {
    readers.emplace_back([&] {
      for (int k = 0; k < kReadings || (changed_meanwhile == 0 && k < kMostReadings); ++k) {
        const int changes_before = changes;
        const TsdfSnapshot snapshot = map.snapshot();
        const std::size_t state = states.find(snapshot);
        if (state == kSteps) {
          ++torn;
          continue;
        }
        if (gains(snapshot, for_readers) != states.gains[state]) ++wrong;
        if (!(snapshot.grid == states.maps[state].grid)) ++wrong;
        if (changes > changes_before) ++changed_meanwhile;
      }
      --reading;
    });
  }
  int passes{0};
  for (; passes < 2 || reading > 0; ++passes) {
    for (std::size_t step = 0; step < kSteps; ++step) {
      EXPECT_TRUE(take_step(map, step, for_writer));
      ++changes;
    }
    EXPECT_EQ(states.find(map.content()), kSteps - 1);
  }
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(changed_meanwhile, 0) << "the map never changed while a snapshot of it was read";
  std::printf("%d passes over the frames, %d snapshots outlived a change\n", passes, changed_meanwhile.load());
}

TEST(ConcurrentUse, SnapshotsAreWholeAndStayWhileFramesAreFused) {
  read_while_fusing(Executor::with_threads(2), Executor::with_threads(2));
}

TEST(ConcurrentUse, SnapshotsAreWholeAndStayWithOneExecutorForAll) {
  const Executor shared = Executor::with_threads(2);
  read_while_fusing(shared, shared);
}

}  // namespace
}  // namespace saccade

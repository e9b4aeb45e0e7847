// SPDX-License-Identifier: Apache-2.0
// Whole arms that are free, configuration by configuration, one thread: ours, and FCL with a box per obstacle cell.
#include "saccade/arm/arm_collision.hpp"

#include <benchmark/benchmark.h>

#include "saccade/arm/urdf.hpp"
#include "support/fcl_arm.hpp"
#include "support/test_arms.hpp"

namespace {

using namespace saccade;

constexpr std::size_t kFree{2000};

/// The built-in arm in clutter, and configurations that both call free.
struct Scene {
  ArmModel model;
  ArmCollision arm;
  ObstacleMap obstacles;
  std::vector<Configuration> free;
};
const Scene& scene() {
  static const Scene made = [] {
    std::mt19937_64 random{5};
    const ArmModel model = find_robot("comau_smart_six").value().arm;
    Scene scene{model,
                ArmCollision::create(model).value(),
                test::clutter_around(forward_kinematics(model, model.middle()).T_world_link[1].translation(), random),
                {}};
    test::FclArm fcl{scene.arm, scene.obstacles};
    while (scene.free.size() < kFree) {
      const Configuration q = test::random_configuration(model, random);
      if (fcl.collides(forward_kinematics(model, q))) {
        SACCADE_EXPECTS(scene.arm.contact(q, scene.obstacles).has_value());
      } else if (!scene.arm.contact(q, scene.obstacles)) {
        scene.free.push_back(q);
      }
    }
    return scene;
  }();
  return made;
}

void free_arms(benchmark::State& state) {
  const Scene& of = scene();
  std::size_t i{0};
  for (auto _ : state) {
    benchmark::DoNotOptimize(of.arm.contact(of.free[i], of.obstacles));
    i = (i + 1) % kFree;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(free_arms)->Unit(benchmark::kMicrosecond);

void fcl_free_arms(benchmark::State& state) {
  test::FclArm fcl{scene().arm, scene().obstacles};
  std::size_t i{0};
  for (auto _ : state) {
    benchmark::DoNotOptimize(fcl.collides(forward_kinematics(scene().model, scene().free[i])));
    i = (i + 1) % kFree;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(fcl_free_arms)->Unit(benchmark::kMicrosecond);

/// From one free configuration straight to the next, the first contact if there is one.
void motions(benchmark::State& state) {
  const Scene& of = scene();
  std::size_t i{0};
  for (auto _ : state) {
    benchmark::DoNotOptimize(of.arm.motion_contact(of.free[i], of.free[i + 1], of.obstacles));
    i = (i + 1) % (kFree - 1);
  }
}
BENCHMARK(motions)->Unit(benchmark::kMicrosecond);

/// The cover of the links, once per arm.
void create(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(ArmCollision::create(scene().model));
}
BENCHMARK(create)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();

// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/surfel_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <set>

#include "saccade/core/clock.hpp"

namespace saccade {
namespace {

TEST(SurfelScenes, HaveManySegmentsThatTheCameraSees) {
  std::size_t scenes{0};
  for (const std::string_view name : kSurfelScenes) {
    const SurfelScene made = surfel_scene(name).value();
    RenderedSequenceConfig config;
    config.camera = PinholeCamera{320, 240, 285.0, 285.0, 159.5, 119.5, 0.4, 3.5};
    auto sequence = RenderedSequence::create(RayScene::build(made.scene).value(), hand_held_poses(made.path, 40),
                                             config, Executor::with_threads(2))
                        .value();
    std::set<std::uint16_t> seen;
    const Stopwatch stopwatch;
    while (sequence.next().value()) {
      for (const std::uint16_t label : sequence.truth().label.pixels()) seen.insert(label);
    }
    std::printf("%s: %zu segments, %zu seen, %.1f ms per frame\n", std::string{name}.c_str(),
                sequence.segments().names().size() - 1, seen.size(), stopwatch.elapsed_ms() / 40.0);
    EXPECT_GE(sequence.segments().names().size(), 87U) << name;
    EXPECT_LE(sequence.segments().names().size(), 210U) << name;
    EXPECT_GE(10 * seen.size(), 9 * sequence.segments().names().size()) << name;
    ++scenes;
  }
  EXPECT_EQ(scenes, kSurfelScenes.size());
  EXPECT_FALSE(surfel_scene("atrium"));
}

}  // namespace
}  // namespace saccade

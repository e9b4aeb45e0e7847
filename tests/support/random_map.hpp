// SPDX-License-Identifier: Apache-2.0
#pragma once
// RandomMap: the map of a RandomRun, to which random things happen.

#include <gtest/gtest.h>

#include "saccade/map/tsdf_map.hpp"
#include "support/random_run.hpp"

namespace saccade::test {

/// The map of a random run, and random things that happen to it.
class RandomMap {
 public:
  explicit RandomMap(std::uint32_t seed) : run_{seed}, map_{TsdfMap::create(run_.config()).value()} {}

  [[nodiscard]] TsdfSnapshot snapshot() const { return map_.snapshot(); }
  [[nodiscard]] RandomRun& run() { return run_; }
  void step() {
    const int action = run_.integer(0, 9);
    if (action == 0) return;  // nothing happens
    if (action == 1) return free(run_.region());
    if (action <= 3) return forget(run_.region());
    const DepthImage depth = run_.depth();
    const ColorImage color = run_.color();
    const Pose T_world_camera = run_.pose();
    const bool colored = run_.integer(0, 1) == 0;
    for (int repeats = run_.integer(1, 7); repeats > 0; --repeats) {
      EXPECT_TRUE(map_.integrate(run_.camera(), depth, T_world_camera, {}, colored ? &color : nullptr).ok());
    }
  }
  void forget(const Region& region) { EXPECT_TRUE(map_.forget(region).ok()); }
  void free(const Region& region) { EXPECT_TRUE(map_.free(region).ok()); }

 private:
  RandomRun run_;
  TsdfMap map_;
};

}  // namespace saccade::test

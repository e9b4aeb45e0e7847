// SPDX-License-Identifier: Apache-2.0
// Damaged scenes: each is read or refused in one line, soon, and what is read can be looked at.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "saccade/io/files/file_io.hpp"
#include "saccade/scene/ray_scene.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"
#include "support/text_mutator.hpp"

namespace saccade {
namespace {

TEST(SceneMutation, TwoThousandAreReadOrRefusedInOneLine) {
  constexpr std::uint64_t kSeed{32};
  const auto tiny = read_text_file(test::tiny_cell_file());
  const auto tabletop = read_text_file(test::source_folder() / "scenes/tabletop-1.yaml");
  ASSERT_TRUE(tiny && tabletop);
  test::TextMutator mutated{kSeed};
  const int mutants = test::scaled_cases(2000);
  int read{0};
  double slowest_s{0.0};
  for (int i = 0; i < mutants; ++i) {
    const std::string mutant = mutated(i % 2 == 0 ? *tiny : *tabletop);
    const auto begin = std::chrono::steady_clock::now();
    const auto scene = parse_scene(mutant);
    if (scene) {
      ++read;
      const auto rays = RayScene::build(*scene);
      if (rays) {
        (void)rays->cast(Eigen::Vector3d{0.1, 0.2, 2.0}, Eigen::Vector3d{0.0, 0.0, -1.0});
      } else {
        ASSERT_EQ(rays.error().to_string().find('\n'), std::string::npos) << rays.error().to_string();
      }
    } else {
      ASSERT_EQ(scene.error().to_string().find('\n'), std::string::npos) << scene.error().to_string();
    }
    slowest_s = std::max(slowest_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  EXPECT_GT(read, mutants / 20) << "seed " << kSeed;
  EXPECT_LT(read, mutants) << "seed " << kSeed;
  EXPECT_LT(slowest_s, 10.0) << "seed " << kSeed;
}

}  // namespace
}  // namespace saccade

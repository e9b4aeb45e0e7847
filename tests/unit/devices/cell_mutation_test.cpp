// SPDX-License-Identifier: Apache-2.0
// Damaged cells: each is read or refused in one line, and what is read keeps to sensible numbers.
#include <gtest/gtest.h>

#include "saccade/core/length_limit.hpp"
#include "saccade/devices/cell.hpp"
#include "saccade/io/files/file_io.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"
#include "support/text_mutator.hpp"

namespace saccade {
namespace {

TEST(CellMutation, TwoThousandAreReadOrRefusedInOneLine) {
  constexpr std::uint64_t kSeed{33};
  const auto example = read_text_file(test::source_folder() / "examples/cell/cell.yaml");
  ASSERT_TRUE(example);
  test::TextMutator mutated{kSeed};
  const int mutants = test::scaled_cases(2000);
  int read{0};
  for (int i = 0; i < mutants; ++i) {
    const std::string mutant = mutated(*example);
    const auto cell = parse_cell(mutant);
    if (!cell) {
      ASSERT_EQ(cell.error().to_string().find('\n'), std::string::npos) << cell.error().to_string();
      continue;
    }
    ++read;
    ASSERT_TRUE(std::isfinite(cell->camera_clock_offset_s)) << mutant;
    if (cell->arm) {
      ASSERT_GT(cell->arm->speed, 0.0) << mutant;
      ASSERT_LE(cell->arm->speed, 1.0) << mutant;
    }
    for (const Box& box : cell->fixtures) {
      ASSERT_LE(box.min.cwiseAbs().maxCoeff(), kMaxLength_m) << mutant;
      ASSERT_LE(box.max.cwiseAbs().maxCoeff(), kMaxLength_m) << mutant;
      ASSERT_TRUE((box.min.array() < box.max.array()).all()) << mutant;
    }
  }
  EXPECT_GT(read, mutants / 20) << "seed " << kSeed;
  EXPECT_LT(read, mutants) << "seed " << kSeed;
}

}  // namespace
}  // namespace saccade

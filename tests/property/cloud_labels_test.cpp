// SPDX-License-Identifier: Apache-2.0
// Random clouds and labels through files of every format: every number comes back.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdio>
#include <random>

#include "saccade/io/clouds/label_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "support/effort.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

constexpr std::uint64_t kLabelSeed{71};

/// Any finite bits as a float.
float random_float(std::mt19937_64& random) {
  while (true) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (std::isfinite(value)) return random() % 2 == 0 ? value : static_cast<float>(random() % 100000) / 1000.0F;
  }
}

ColumnTable random_cloud(std::mt19937_64& random) {
  const std::size_t rows = 1 + random() % 20;
  ColumnTable table;
  for (const char* name : {"x", "y", "z"}) {
    std::vector<float> values(rows);
    for (float& value : values) value = random_float(random);
    table.add<float>(name, std::span<const float>{values});
  }
  std::vector<double> doubles(rows);
  for (double& value : doubles) value = std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 80) - 70);
  table.add<double>("stamp", std::span<const double>{doubles});
  std::vector<std::uint32_t> words(rows);
  for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random()) >> random() % 32;
  table.add<std::uint32_t>(random() % 2 == 0 ? "label" : "id", std::span<const std::uint32_t>{words});
  return table;
}

std::vector<std::uint32_t> random_labels(std::size_t rows, std::uint32_t most, std::mt19937_64& random) {
  std::vector<std::uint32_t> labels(rows);
  for (std::uint32_t& label : labels) {
    label = static_cast<std::uint32_t>(random() % 3 == 0 ? 0 : random() % (std::uint64_t{most} + 1));
  }
  return labels;
}

/// The columns of `before` in `after`, number by number, under the name that they have now.
std::size_t compare_columns(const ColumnTable& before, const ColumnTable& after) {
  std::size_t compared{0};
  for (const Column& column : before.columns) {
    const Column* kept = after.find(column.name == kLabelField ? before.unused_name(kEarlierLabelField) : column.name);
    EXPECT_NE(kept, nullptr) << column.name;
    if (kept == nullptr) continue;
    for (std::size_t i = 0; i < before.rows; ++i, ++compared) {
      const double value = kept->value(i);
      const bool same = column.type == ColumnType::f32
                            ? static_cast<float>(value) == static_cast<float>(column.value(i))
                            : value == column.value(i);
      EXPECT_TRUE(same) << column.name << " " << i << ": " << value << " for " << column.value(i);
    }
  }
  return compared;
}

TEST(CloudLabels, AndEveryFieldComeBackFromEveryFormat) {
  const int cases = test::scaled_cases(60);
  std::printf("seed %llu, %d cases\n", static_cast<unsigned long long>(kLabelSeed), cases);
  std::mt19937_64 random{kLabelSeed};
  const test::TempFolder folder;
  std::size_t compared{0};
  for (int i = 0; i < cases; ++i) {
    CloudFile cloud{PcdFile{}};
    auto& pcd = std::get<PcdFile>(cloud.file);
    pcd.table = random_cloud(random);
    pcd.width = pcd.table.rows;
    pcd.format = static_cast<PcdFormat>(random() % 3);
    for (const char* name : {"a.pcd", "a.ply", "a.xyz", "a.csv", "a.txt", "a.npy", "a.label"}) {
      const bool small = std::string_view{name} == "a.label";
      const std::vector<std::uint32_t> labels = random_labels(pcd.table.rows, small ? 0xFFFFU : 0xFFFFFFFFU, random);
      ASSERT_TRUE(write_labels(folder / name, cloud, labels)) << name;
      ASSERT_EQ(read_labels(folder / name, labels.size()).value(), labels) << name << ", case " << i;
      if (small || std::string_view{name} == "a.npy") continue;
      const CloudFile again = read_cloud(folder / name).value();
      compared += compare_columns(pcd.table, again.fields());
      if (!std::holds_alternative<TextCloud>(again.file)) continue;
      // Labels once more, now beside the lines as they were.
      ASSERT_TRUE(write_labels(folder / "b.txt", again, labels));
      ASSERT_EQ(read_labels(folder / "b.txt", labels.size()).value(), labels) << name << ", case " << i;
      compared += compare_columns(again.fields(), read_cloud(folder / "b.txt").value().fields());
    }
    ASSERT_FALSE(HasFailure()) << "case " << i;
  }
  EXPECT_GE(compared, static_cast<std::size_t>(cases) * 25U);
}

}  // namespace
}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/disk_memory.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "support/small_disk.hpp"
#include "support/temp_folder.hpp"

namespace saccade::test {
namespace {

TEST(DiskMemory, HoldsVectorsAndLeavesNoFile) {
  const TempFolder folder;
  const auto disk = DiskMemory::in(folder.path());
  ASSERT_TRUE(disk);
  DiskVector<int> numbers(100'000, DiskAllocator<int>{*disk});
  std::iota(numbers.begin(), numbers.end(), 7);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  DiskVector<int> moved;
  moved = std::move(numbers);
  EXPECT_EQ(moved.get_allocator().disk, *disk);
  moved.resize(200'000);
  EXPECT_EQ(moved[99'999], 100'006);
  DiskVector<int> in_memory(moved.begin(), moved.begin() + 5);
  EXPECT_EQ(in_memory.get_allocator().disk, nullptr);
  std::swap(in_memory, moved);
  EXPECT_EQ(moved.size(), 5U);
  EXPECT_EQ(in_memory[5], 12);
}

TEST(DiskMemory, SaysWhereThereIsNoRoom) {
  const TempFolder folder;
  const auto disk = DiskMemory::in(folder.path());
  ASSERT_TRUE(disk);
  const SmallDisk full{1U << 20U};
  std::string why;
  try {
    const DiskVector<char> numbers(std::size_t{10} << 20U, DiskAllocator<char>{*disk});
  } catch (const std::bad_alloc& problem) {
    why = problem.what();
  }
  EXPECT_NE(why.find(folder.path().string() + ": no room for 11 MiB"), std::string::npos) << why;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(DiskMemory, NeedsAFolder) {
  const TempFolder folder;
  const auto none = DiskMemory::in(folder / "missing");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::io_failure);
}

}  // namespace
}  // namespace saccade::test

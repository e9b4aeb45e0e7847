// SPDX-License-Identifier: Apache-2.0
// SpillFile, and paged maps on it against maps in memory: saved bytes are equal, whatever happens in between.
#include "saccade/io/maps/spill_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "saccade/io/files/leftovers.hpp"
#include "saccade/io/maps/internal/file_room.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/map/raycast.hpp"
#include "support/effort.hpp"
#include "support/parallel_backend.hpp"
#include "support/random_run.hpp"
#include "support/small_disk.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::RandomRun;
using test::TempFolder;

std::vector<std::byte> some_bytes(std::mt19937& random, std::size_t count) {
  std::vector<std::byte> bytes(count);
  for (std::byte& byte : bytes) byte = std::byte{static_cast<unsigned char>(random() % 7)};
  return bytes;
}

TEST(FileRoom, StretchesNeverOverlapAndAreUsedAgain) {
  std::mt19937 random{3};
  FileRoom room;
  std::map<std::uint64_t, std::uint64_t> taken;
  std::uint64_t in_use{0};
  std::uint64_t most{0};
  for (int step = 0; step < 5000; ++step) {
    if (taken.size() < 60 || random() % 2 == 0) {
      const std::uint64_t size = 1 + random() % 5000;
      const std::uint64_t offset = room.take(size);
      const auto next = taken.lower_bound(offset);
      if (next != taken.end()) {
        ASSERT_LE(offset + size, next->first);
      }
      if (next != taken.begin()) {
        ASSERT_GE(offset, std::prev(next)->first + std::prev(next)->second);
      }
      taken.emplace(offset, size);
      in_use += size;
    } else {
      auto it = std::next(taken.begin(), static_cast<long>(random() % taken.size()));
      in_use -= it->second;
      room.give_back(it->first, it->second);
      taken.erase(it);
    }
    most = std::max(most, in_use);
  }
  EXPECT_LT(room.end(), 2 * most);
  for (const auto& [offset, size] : taken) room.give_back(offset, size);
  EXPECT_EQ(room.end(), 0U);
}

TEST(SpillFile, KeepsBytesUntilTheyAreReleased) {
  TempFolder folder;
  std::mt19937 random{5};
  const auto file = SpillFile::create(folder.path()).value();
  EXPECT_TRUE(fs::is_empty(folder.path())) << "the file has no name";
  std::vector<std::pair<StoredPlace, std::vector<std::byte>>> kept;
  for (int i = 0; i < 200; ++i) {
    const std::vector<std::byte> bytes = some_bytes(random, random() % 20000);
    kept.emplace_back(file->write(bytes).value(), bytes);
    if (i % 3 == 0) {
      file->release(kept[kept.size() / 2].first);
      kept.erase(kept.begin() + static_cast<long>(kept.size() / 2));
    }
  }
  for (const auto& [place, bytes] : kept) EXPECT_EQ(file->read(place).value(), bytes);
  EXPECT_GT(file->file_bytes(), 0U);
}

TEST(SpillFile, SaysWhereItIsDamaged) {
  TempFolder folder;
  std::mt19937 random{7};
  const auto file = SpillFile::create(folder.path()).value();
  const StoredPlace first = file->write(some_bytes(random, 3000)).value();
  const StoredPlace second = file->write(some_bytes(random, 3000)).value();
  const char wrong{'\x55'};
  ASSERT_EQ(::pwrite(file->descriptor(), &wrong, 1, static_cast<off_t>(second.offset + 40)), 1);
  EXPECT_TRUE(file->read(first).ok());
  const auto damaged = file->read(second);
  ASSERT_FALSE(damaged.ok());
  EXPECT_EQ(damaged.error().code, Errc::corrupt_data);
  EXPECT_NE(damaged.error().message.find("byte " + std::to_string(second.offset)), std::string::npos);
  EXPECT_EQ(damaged.error().context, folder.path().string());
  ASSERT_EQ(::ftruncate(file->descriptor(), static_cast<off_t>(second.offset + 10)), 0);
  EXPECT_EQ(file->read(second).error().code, Errc::corrupt_data);
}

TEST(SpillFile, AFullDiskIsAnErrorAndLosesNothing) {
  TempFolder folder;
  std::mt19937 random{9};
  const auto file = SpillFile::create(folder.path()).value();
  const std::vector<std::byte> bytes = some_bytes(random, 30000);
  const StoredPlace place = file->write(bytes).value();
  {
    const test::SmallDisk small{16384};
    const auto refused = file->write(some_bytes(random, 60000));
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, Errc::io_failure);
    EXPECT_NE(refused.error().message.find("make room"), std::string::npos);
    EXPECT_EQ(refused.error().context, folder.path().string());
  }
  EXPECT_EQ(file->read(place).value(), bytes);
  EXPECT_TRUE(file->write(some_bytes(random, 60000)).ok());
}

TEST(SpillFile, NeedsAFolderAndSweepsIt) {
  TempFolder folder;
  const auto missing = SpillFile::create(folder.path() / "missing");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, Errc::io_failure);
  EXPECT_EQ(missing.error().context, (folder.path() / "missing").string());
  // A process that was killed between making its file and taking its name away; process numbers end below this one.
  const fs::path leftover = folder.path() / ".map-pages.1999999999-0.tmp";
  std::ofstream{leftover} << "left";
  ASSERT_TRUE(parse_temporary_name(leftover.filename().string()).has_value());
  EXPECT_TRUE(SpillFile::create(folder.path()).ok());
  EXPECT_FALSE(fs::exists(leftover));
}

/// A paged map and one in memory, to which the same random things happen.
class RandomTwins {
 public:
  RandomTwins(std::uint32_t seed, const fs::path& folder, const Executor& executor)
      : run_{RandomRun::with_clearing(seed)},
        executor_{executor},
        paged_{TsdfMap::create(run_.config()).value()},
        plain_{TsdfMap::create(run_.config()).value()} {
    PagingConfig config;
    if (seed % 4 != 0) config.memory_bytes = limit();
    if (seed % 4 == 0 || seed % 4 == 3) config.moving_volume_m = run_.uniform(0.1, 3.0) * run_.extent();
    config.store = SpillFile::create(folder).value();
    EXPECT_TRUE(paged_.keep_within(config).ok());
  }

  void step() {
    switch (run_.integer(0, 9)) {
      case 0: return edit(&TsdfMap::forget);
      case 1: return edit(&TsdfMap::free);
      case 2: return look();
      case 3: snapshots_.emplace_back(paged_.snapshot(), plain_.snapshot()); return;
      case 4: EXPECT_TRUE(paged_.page_out_all(executor_).ok()); return;
      default: return fuse();
    }
  }
  void expect_equal() {
    EXPECT_EQ(encode_map(paged_.content(), executor_).value(), encode_map(plain_.content()).value());
    for (const auto& [paged, plain] : snapshots_) {
      EXPECT_EQ(encode_map(paged).value(), encode_map(plain).value());
    }
    const PagingStats stats = *paged_.paging();
    EXPECT_EQ(stats.map_bytes, paged_.content().grid.usage().bytes);
    EXPECT_EQ(stats.sectors_away, paged_.content().grid.away_count());
  }
  [[nodiscard]] PagingStats stats() const { return *paged_.paging(); }

 private:
  /// From a byte to more than all.
  std::size_t limit() { return static_cast<std::size_t>(std::exp(run_.uniform(0.0, 15.0))); }
  void edit(Status (TsdfMap::*change)(const Region&)) {
    const Region region = run_.region();
    EXPECT_TRUE((paged_.*change)(region).ok());
    EXPECT_TRUE((plain_.*change)(region).ok());
  }
  void fuse() {
    const DepthImage depth = run_.depth();
    const ColorImage color = run_.color();
    const Pose T_world_camera = run_.pose();
    const ColorImage* seen = run_.integer(0, 1) == 0 ? &color : nullptr;
    const auto paged = paged_.integrate(run_.camera(), depth, T_world_camera, executor_, seen);
    const auto plain = plain_.integrate(run_.camera(), depth, T_world_camera, {}, seen);
    ASSERT_TRUE(paged.ok());
    EXPECT_EQ(paged->bricks_updated, plain->bricks_updated);
    EXPECT_EQ(paged->bricks_free, plain->bricks_free);
    EXPECT_EQ(paged->bricks_saturated, plain->bricks_saturated);
  }
  void look() {
    const Pose T_world_camera = run_.pose();
    if (run_.integer(0, 1) == 0) {
      EXPECT_TRUE(paged_.look_from(run_.camera(), T_world_camera, executor_).ok());
    }
    const auto paged = raycast(paged_.content(), run_.camera(), T_world_camera, executor_, {true});
    const auto plain = raycast(plain_.content(), run_.camera(), T_world_camera, {}, {true});
    ASSERT_TRUE(paged.ok());
    EXPECT_EQ(paged->depth.pixels(), plain->depth.pixels());
    EXPECT_EQ(paged->normals.pixels(), plain->normals.pixels());
    EXPECT_EQ(paged->colors.pixels(), plain->colors.pixels());
  }

  RandomRun run_;
  Executor executor_;
  TsdfMap paged_;
  TsdfMap plain_;
  std::vector<std::pair<TsdfSnapshot, TsdfSnapshot>> snapshots_;
};

TEST(PagedMapProperty, SavesTheBytesOfTheUnpagedMap) {
  constexpr int kAllRuns{12};
  constexpr int kRuns{test::scaled_cases(kAllRuns)};
  constexpr int kSteps{10};
  TempFolder folder;
  std::size_t out{0};
  std::size_t in{0};
  std::size_t shifts{0};
  int runs{0};
  for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(kRuns); ++seed, ++runs) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto threads = static_cast<std::size_t>(1 + seed % 3);
    RandomTwins twins{seed, folder.path(), Executor::with_threads(threads)};
    for (int step = 0; step < kSteps; ++step) {
      twins.step();
      if (step % 5 == 4) twins.expect_equal();
    }
    out += twins.stats().sectors_out;
    in += twins.stats().sectors_in;
    shifts += twins.stats().shifts;
  }
  EXPECT_EQ(runs, kRuns);
  EXPECT_GT(out, static_cast<std::size_t>(kRuns));
  EXPECT_GT(in, static_cast<std::size_t>(kRuns));
  if (kRuns == kAllRuns) {  // not in every shorter test
    EXPECT_GT(shifts, 0U);
  }
}

}  // namespace
}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/file_io.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "saccade/io/files/leftovers.hpp"
#include "support/small_disk.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::SmallDisk;
using test::TempFolder;

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator{folder}, fs::directory_iterator{}));
}

TEST(AtomicFile, AppearsWithItsContentAndNothingElse) {
  const TempFolder folder;
  const std::string content(1000000, 'x');
  ASSERT_TRUE(write_file_atomically(folder / "a.bin", content));
  EXPECT_EQ(*read_text_file(folder / "a.bin"), content);
  ASSERT_TRUE(write_file_atomically(folder / "a.bin", std::string_view{"second"}));
  EXPECT_EQ(*read_text_file(folder / "a.bin"), "second");
  ASSERT_TRUE(write_file_atomically(folder / "empty", std::string_view{}));
  EXPECT_EQ(fs::file_size(folder / "empty"), 0U);
  EXPECT_EQ(entries(folder.path()), 2U);
}

TEST(AtomicFile, WithoutCommitTheOldFileStays) {
  const TempFolder folder;
  folder.write("a", "old");
  {
    auto file = AtomicFile::create(folder / "a");
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write(std::string(500000, 'n')));
    EXPECT_EQ(entries(folder.path()), 2U);  // the temporary
    AtomicFile moved = std::move(*file);
    ASSERT_TRUE(moved.write(std::string_view{"more"}));
  }
  EXPECT_EQ(*read_text_file(folder / "a"), "old");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(AtomicFile, FullDiskIsAnErrorThatNamesThePath) {
  for (const std::size_t size : {std::size_t{5000}, std::size_t{1} << 20U}) {  // fails in commit, fails in write
    const TempFolder folder;
    folder.write("a", "old");
    {
      const SmallDisk disk{4096};
      const Status status = write_file_atomically(folder / "a", std::string(size, 'x'));
      ASSERT_FALSE(status);
      EXPECT_EQ(status.error().code, Errc::io_failure);
      EXPECT_EQ(status.error().context, (folder / "a").string());
      auto file = AtomicFile::create(folder / "b");
      ASSERT_TRUE(file);
      Status last;
      for (int i = 0; i < 100 && last; ++i) last = file->write(std::string(size, 'y'));
      if (last) last = file->commit();
      EXPECT_FALSE(last);
      EXPECT_FALSE(file->write(std::string_view{"z"}));
      EXPECT_FALSE(file->commit());
    }
    EXPECT_EQ(*read_text_file(folder / "a"), "old");
    EXPECT_EQ(entries(folder.path()), 1U);
  }
}

TEST(AtomicFile, ANewFileReplacesNone) {
  const TempFolder folder;
  auto first = AtomicFile::create(folder / "a");
  auto second = AtomicFile::create(folder / "a");
  ASSERT_TRUE(first && second);
  ASSERT_TRUE(first->write(std::string_view{"first"}));
  ASSERT_TRUE(second->write(std::string_view{"second"}));
  EXPECT_TRUE(*first->commit_new());
  EXPECT_FALSE(*second->commit_new());
  EXPECT_EQ(*read_text_file(folder / "a"), "first");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(AtomicFile, FolderThatCannotBeWrittenIsAnError) {
  const TempFolder folder;
  folder.write("file", "content");
  for (const fs::path& path : {folder / "file/below", folder / "no/such/folder"}) {
    const Status status = write_file_atomically(path, std::string_view{"x"});
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, Errc::io_failure);
    EXPECT_EQ(status.error().context, path.string());
  }
}

TEST(AtomicFile, OnlyRegularFilesAreReplaced) {
  const TempFolder folder;
  EXPECT_EQ(write_file_atomically("/dev/full", std::string_view{"x"}).error().code, Errc::invalid_argument);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_EQ(write_file_atomically(folder.path(), std::string_view{"x"}).error().code, Errc::invalid_argument);
  EXPECT_EQ(write_file_atomically(folder.path() / "", std::string_view{"x"}).error().code, Errc::invalid_argument);
}

TEST(AtomicFile, LinksAreFollowedAndPermissionsKept) {
  const TempFolder folder;
  const auto target = folder.write("target", "old");
  ::chmod(target.c_str(), 0640);
  fs::create_symlink("target", folder / "link");
  ASSERT_TRUE(write_file_atomically(folder / "link", std::string_view{"new"}));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(*read_text_file(target), "new");
  struct stat info {};
  ::stat(target.c_str(), &info);
  EXPECT_EQ(info.st_mode & 0777U, 0640U);
}

TEST(FileIo, ReadsWholeFilesOrSaysWhyNot) {
  const TempFolder folder;
  const auto path = folder.write("a", "content");
  EXPECT_EQ(*read_text_file(path), "content");
  EXPECT_EQ(read_file(path)->size(), 7U);
  EXPECT_EQ(read_file(path, 6).error().code, Errc::unsupported);
  EXPECT_TRUE(read_file(path, 7));
  EXPECT_EQ(read_file(folder / "b").error().code, Errc::not_found);
  EXPECT_EQ(read_file(folder.path()).error().code, Errc::io_failure);
  EXPECT_EQ(read_file(folder / "a/b").error().code, Errc::not_found);
  EXPECT_GT(read_text_file("/proc/self/status")->size(), 100U);  // a file whose size is said to be 0
}

/// Returns the number of a process that has ended.
pid_t ended_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

TEST(AtomicFile, RemovesWhatKilledProcessesLeftOfTheSameFile) {
  const TempFolder folder;
  const std::string gone = std::to_string(ended_process());
  const std::string here = std::to_string(::getppid());
  folder.write(".a.bin." + gone + "-0.tmp", "half");
  folder.write(".a.bin." + gone + "-17.tmp", "");
  for (const std::string& kept :
       std::vector<std::string>{".a.bin." + here + "-0.tmp", ".b.bin." + gone + "-0.tmp", ".a.bin.x-0.tmp",
                                ".a.bin.b." + gone + "-0.tmp", "a.bin." + gone + "-0.tmp", ".a.bin.tmp"}) {
    folder.write(kept, "kept");
  }
  ASSERT_TRUE(write_file_atomically(folder / "a.bin", std::string_view{"whole"}));
  EXPECT_EQ(entries(folder.path()), 7U);
  EXPECT_FALSE(fs::exists(folder / (".a.bin." + gone + "-0.tmp")));
  EXPECT_FALSE(fs::exists(folder / (".a.bin." + gone + "-17.tmp")));
}

TEST(AtomicFile, KeepsALockedTemporary) {
  const TempFolder folder;
  const fs::path other = folder.write(".a.bin." + std::to_string(ended_process()) + "-0.tmp", "of another machine");
  const int fd = ::open(other.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(fd, LOCK_EX), 0);
  ASSERT_TRUE(write_file_atomically(folder / "a.bin", std::string_view{"whole"}));
  EXPECT_TRUE(fs::exists(other));
  ::close(fd);
  ASSERT_TRUE(write_file_atomically(folder / "a.bin", std::string_view{"again"}));
  EXPECT_FALSE(fs::exists(other));
}

TEST(Leftovers, NamesOfTemporaries) {
  const auto name = parse_temporary_name(make_temporary_name("map 1.sacmap"));
  ASSERT_TRUE(name);
  EXPECT_EQ(name->destination, "map 1.sacmap");
  EXPECT_EQ(name->process, ::getpid());
  EXPECT_NE(make_temporary_name("a"), make_temporary_name("a"));
  for (const std::string_view wrong : {"", ".tmp", ".a.tmp", ".a.1.tmp", ".a.1-.tmp", ".a.-1.tmp", "..1-1.tmp",
                                       "a.1-1.tmp", ".a.1-1.tm", ".a.0-1.tmp", ".a.99999999999-1.tmp"}) {
    EXPECT_FALSE(parse_temporary_name(wrong)) << wrong;
  }
}

}  // namespace
}  // namespace saccade

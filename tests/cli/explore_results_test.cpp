// SPDX-License-Identifier: Apache-2.0
// When saccade explore writes run.json: once, and before it removes the journal.
#include <gtest/gtest.h>
#include <sys/inotify.h>

#include <array>
#include <cstring>

#include "run_program.hpp"
#include "saccade/io/files/json_io.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

Arguments one_view(const fs::path& out, const Arguments& more = {}) {
  return Arguments{"explore", tiny_cell_file(), "--out", out.string(),   "--quiet", "--image-size",
                   "96,72",   "--voxel-size",   "0.015", "--robot",      "free",    "--max-views",
                   "1",       "--min-gain",     "5",     "--no-pictures"} +
         more;
}

/// Counts how often a file of a folder was written, each time under another name that then became its own.
class WrittenFiles {
 public:
  explicit WrittenFiles(const fs::path& folder) : inotify_{::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)} {
    EXPECT_GE(::inotify_add_watch(inotify_, folder.c_str(), IN_MOVED_TO), 0);
  }
  WrittenFiles(const WrittenFiles&) = delete;
  WrittenFiles& operator=(const WrittenFiles&) = delete;
  ~WrittenFiles() { ::close(inotify_); }

  [[nodiscard]] int times(const std::string& name) const {
    alignas(inotify_event) std::array<char, 65536> bytes{};
    int times{0};
    for (;;) {
      const ssize_t count = ::read(inotify_, bytes.data(), bytes.size());
      if (count <= 0) return times;
      for (ssize_t at = 0; at < count;) {
        inotify_event event{};
        std::memcpy(&event, bytes.data() + at, sizeof event);
        times += event.len > 0 && name == bytes.data() + at + sizeof event ? 1 : 0;
        at += static_cast<ssize_t>(sizeof event + event.len);
      }
    }
  }

 private:
  int inotify_;
};

TEST(ExploreResults, TheRecordOfARunIsWrittenOnce) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers";
  const TempFolder folder;
  for (const char* name : {"whole", "left"}) {
    const fs::path run = folder / name;
    fs::create_directory(run);
    const WrittenFiles written{run};
    const Arguments more = name == std::string{"left"} ? Arguments{"--step"} : Arguments{};
    ASSERT_EQ(run_program(one_view(run, more), 0, "y\nq\n").status, 0);
    EXPECT_EQ(written.times("run.json"), 1) << name;
    const auto document = read_json(run / "run.json");
    ASSERT_TRUE(document);
    EXPECT_EQ(document->at("result").at("interrupted"), name == std::string{"left"});
    EXPECT_EQ(fs::exists(run / "journal.json"), name == std::string{"left"});
  }
}

TEST(ExploreResults, ARecordThatCannotBeWrittenLosesNothing) {
  if (kSanitized) GTEST_SKIP() << "explorations take long under sanitizers";
  const TempFolder folder;
  const fs::path run = folder / "run";
  fs::create_directories(run / "run.json");  // a folder has the name of the file
  const Outcome failed = run_program(one_view(run, {"--force"}));
  EXPECT_EQ(failed.status, 3) << failed.err;
  EXPECT_NE(failed.err.find("run.json"), std::string::npos) << failed.err;
  EXPECT_NE(failed.err.find("is kept, add --resume to go on"), std::string::npos) << failed.err;
  ASSERT_TRUE(fs::exists(run / "journal.json"));
  fs::remove(run / "run.json");
  const Outcome resumed = run_program(one_view(run, {"--resume"}));
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  const auto document = read_json(run / "run.json");
  ASSERT_TRUE(document);
  EXPECT_EQ(document->at("result").at("views").size(), 1U);
  EXPECT_FALSE(fs::exists(run / "journal.json"));
}

}  // namespace
}  // namespace saccade::test

// SPDX-License-Identifier: Apache-2.0
// SACCADE_KILL_CASES: processes that are killed while they annotate (30).
#include "saccade/io/sessions/annotation_session.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "saccade/core/clock.hpp"
#include "saccade/io/files/file_io.hpp"
#include "support/annotated_cloud.hpp"
#include "support/effort.hpp"
#include "support/small_disk.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::SmallDisk;
using test::TempFolder;

/// A cloud with its graph, and sessions of it.
struct AnnotatedCloud {
  explicit AnnotatedCloud(int side) : cloud{test::patchy_cloud(side)}, graph{test::graph_of(cloud)} {}
  [[nodiscard]] Result<AnnotationSession> session(const fs::path& path) const {
    return AnnotationSession::open_or_create(path, "patches.ply", hash_positions(cloud), graph);
  }
  PointCloud cloud;
  std::shared_ptr<const Neighbourhood> graph;
};

void expect_same_state(const Annotation& a, const Annotation& b) {
  ASSERT_TRUE(std::equal(a.labels().begin(), a.labels().end(), b.labels().begin(), b.labels().end()));
  ASSERT_EQ(a.control_points(), b.control_points());
  ASSERT_EQ(a.counts(), b.counts());
  ASSERT_EQ(a.label_table().defined(), b.label_table().defined());
  ASSERT_EQ(a.history().size(), b.history().size());
  ASSERT_EQ(a.history().active(), b.history().active());
}

/// Applies random actions until `actions` of them count; returns the expected annotation.
Annotation annotate(AnnotationSession& session, std::uint64_t seed, std::size_t actions) {
  test::RandomActions random{seed};
  Annotation expected{std::make_shared<const Neighbourhood>(session.annotation().forest().neighbourhood())};
  while (expected.history().size() < actions) {
    const AnnotationAction action = random.next(expected);
    expected.apply(action);
    const auto applied = session.apply(action);
    EXPECT_TRUE(applied) << applied.error().to_string();
    EXPECT_EQ(applied->sequence, expected.history().size());
  }
  return expected;
}

TEST(AnnotationSession, IsThereWhenItIsOpenedAgain) {
  const AnnotatedCloud cloud{12};
  const TempFolder folder;
  const fs::path path = folder / "a.sacann";
  std::optional<Annotation> expected;
  {
    auto session = cloud.session(path);
    ASSERT_TRUE(session) << session.error().to_string();
    EXPECT_TRUE(session->opening().created);
    EXPECT_EQ(session->opening().actions, 0U);
    expected = annotate(*session, 5, 60);
    expect_same_state(session->annotation(), *expected);
  }
  auto session = cloud.session(path);
  ASSERT_TRUE(session) << session.error().to_string();
  EXPECT_FALSE(session->opening().created);
  EXPECT_EQ(session->opening().actions, 60U);
  EXPECT_EQ(session->opening().torn_bytes, 0U);
  expect_same_state(session->annotation(), *expected);
  EXPECT_EQ(read_journal(path)->subject.graph.max_path, cloud.graph->config().max_path);
  // Undo goes on where it was.
  const std::size_t before = session->annotation().history().active().size();
  ASSERT_TRUE(session->apply({1, UndoAction{}})->done);
  EXPECT_EQ(session->annotation().history().active().size(), before - 1);
  EXPECT_EQ(std::distance(fs::directory_iterator{folder.path()}, fs::directory_iterator{}), 1);
}

TEST(AnnotationSession, RefusedActionsAndEmptyUndoAreNotWritten) {
  const AnnotatedCloud cloud{6};
  const TempFolder folder;
  auto session = cloud.session(folder / "a");
  ASSERT_TRUE(session);
  const auto size = fs::file_size(folder / "a");
  EXPECT_EQ(session->apply({1, PaintPoints{{1000}, 1}}).error().code, Errc::invalid_argument);
  EXPECT_EQ(session->apply({1, RemoveControlPoints{{1}}}).error().code, Errc::invalid_argument);
  const auto undone = session->apply({1, UndoAction{}});
  ASSERT_TRUE(undone);
  EXPECT_FALSE(undone->done);
  EXPECT_EQ(fs::file_size(folder / "a"), size);
  EXPECT_TRUE(session->apply({1, PaintPoints{{1}, 1}})->done);
  EXPECT_GT(fs::file_size(folder / "a"), size);
}

TEST(AnnotationSession, TruncatedAnywhereItHoldsTheWholeRecordsAndGoesOn) {
  const AnnotatedCloud cloud{8};
  const TempFolder folder;
  const fs::path path = folder / "a";
  std::vector<std::size_t> ends;
  std::vector<std::vector<std::uint32_t>> labels;
  {
    auto session = cloud.session(path);
    ASSERT_TRUE(session);
    test::RandomActions random{3};
    const auto note = [&] {
      ends.push_back(fs::file_size(path));
      labels.emplace_back(session->annotation().labels().begin(), session->annotation().labels().end());
    };
    note();
    while (ends.size() < 9) {
      if (session->apply(random.next(session->annotation()))->done) note();
    }
  }
  const std::vector<std::byte> whole = read_file(path).value();
  constexpr std::size_t kStep{test::kSanitized ? 13 : 1};
  std::size_t cut = 0;
  for (std::size_t size = ends[0]; size <= whole.size(); size += kStep, ++cut) {
    SCOPED_TRACE(size);
    folder.write("a", as_text(std::span{whole}.first(size)));
    const auto records = static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), size) - ends.begin()) - 1;
    {
      auto session = cloud.session(path);
      ASSERT_TRUE(session) << session.error().to_string();
      ASSERT_EQ(session->opening().actions, records);
      ASSERT_EQ(session->opening().torn_bytes, size - ends[records]);
      ASSERT_TRUE(std::equal(labels[records].begin(), labels[records].end(), session->annotation().labels().begin()));
      ASSERT_EQ(fs::file_size(path), ends[records]);
      ASSERT_TRUE(session->apply({9, PaintPoints{{0}, 99}}));
    }
    auto again = cloud.session(path);
    ASSERT_TRUE(again);
    ASSERT_EQ(again->opening().actions, records + 1);
    ASSERT_EQ(again->opening().torn_bytes, 0U);
    ASSERT_EQ(again->annotation().label_of(0), 99U);
  }
  EXPECT_GT(cut, 200U / kStep);
}

TEST(AnnotationSession, TenThousandActionsAreThereAtOnce) {
  const AnnotatedCloud cloud{40};
  const TempFolder folder;
  constexpr std::size_t kActions{test::scaled_cases(10000)};
  Annotation expected{cloud.graph};
  test::RandomActions random{8};
  std::vector<std::byte> file =
      encode_journal_header({"patches.ply", cloud.graph->size(), hash_positions(cloud.cloud), cloud.graph->config()});
  while (expected.history().size() < kActions) {
    const AnnotationAction action = random.next(expected);
    if (!expected.apply(action).done) continue;
    const std::vector<std::byte> record = encode_journal_record(action);
    file.insert(file.end(), record.begin(), record.end());
  }
  ASSERT_TRUE(write_file_atomically(folder / "a", file));
  const Stopwatch watch;
  auto session = cloud.session(folder / "a");
  const double ms = watch.elapsed_ms();
  ASSERT_TRUE(session) << session.error().to_string();
  expect_same_state(session->annotation(), expected);
  EXPECT_EQ(session->opening().actions, kActions);
  EXPECT_LT(ms, test::kSanitized ? 10000.0 : 500.0);
}

TEST(AnnotationSession, DamagedFilesStayAsTheyAre) {
  const AnnotatedCloud cloud{8};
  const TempFolder folder;
  const fs::path path = folder / "a";
  {
    auto session = cloud.session(path);
    ASSERT_TRUE(session);
    annotate(*session, 1, 8);
  }
  std::vector<std::byte> bytes = read_file(path).value();
  bytes[bytes.size() / 2] ^= std::byte{4};
  ASSERT_TRUE(write_file_atomically(path, bytes));
  const auto session = cloud.session(path);
  ASSERT_FALSE(session);
  EXPECT_EQ(session.error().code, Errc::corrupt_data);
  EXPECT_EQ(session.error().context, path.string());
  EXPECT_NE(session.error().message.find("at byte"), std::string::npos);
  EXPECT_EQ(read_file(path).value(), bytes);
  folder.write("text", "labels: []");
  EXPECT_EQ(cloud.session(folder / "text").error().message, "this is not an annotation session");
  EXPECT_EQ(*read_text_file(folder / "text"), "labels: []");
}

TEST(AnnotationSession, BelongsToOneCloud) {
  const AnnotatedCloud cloud{8};
  const TempFolder folder;
  ASSERT_TRUE(cloud.session(folder / "a"));
  const auto other = AnnotatedCloud{9}.session(folder / "a");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Errc::invalid_argument);
  EXPECT_NE(other.error().message.find("65 points"), std::string::npos) << other.error().message;
  const auto moved = AnnotationSession::open_or_create(folder / "a", "patches.ply", 1, cloud.graph);
  ASSERT_FALSE(moved);
  EXPECT_NE(moved.error().message.find("other positions"), std::string::npos);
}

TEST(AnnotationSession, IsOpenOnce) {
  const AnnotatedCloud cloud{6};
  const TempFolder folder;
  {
    auto first = cloud.session(folder / "a");
    ASSERT_TRUE(first);
    const auto second = cloud.session(folder / "a");
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, Errc::unavailable);
    AnnotationSession moved = std::move(*first);
    EXPECT_FALSE(cloud.session(folder / "a"));
    EXPECT_TRUE(moved.apply({1, PaintPoints{{1}, 1}}));
  }
  EXPECT_TRUE(cloud.session(folder / "a"));
}

TEST(AnnotationSession, AFullDiskIsReportedAndLeavesWhatWasThere) {
  const AnnotatedCloud cloud{30};
  std::vector<std::uint32_t> many(800);
  std::iota(many.begin(), many.end(), 0U);
  for (const rlim_t room : {0U, 1U, 12U, 500U, 3000U}) {  // part of a record of 3.2 kB
    const TempFolder folder;
    const fs::path path = folder / "a";
    std::optional<Annotation> expected;
    {
      auto session = cloud.session(path);
      ASSERT_TRUE(session);
      expected = annotate(*session, 2, 20);
      const auto size = fs::file_size(path);
      {
        const SmallDisk disk{size + room};
        const auto failed = session->apply({1, PaintPoints{many, 6}});
        ASSERT_FALSE(failed);
        EXPECT_EQ(failed.error().code, Errc::io_failure);
        EXPECT_EQ(failed.error().context, path.string());
        EXPECT_NE(failed.error().message.find("until there is room"), std::string::npos) << failed.error().message;
      }
      EXPECT_EQ(fs::file_size(path), size);
      expect_same_state(session->annotation(), *expected);
      ASSERT_TRUE(session->read_only());
      EXPECT_EQ(session->apply({1, PaintPoints{{1}, 6}}).error().code, Errc::io_failure);  // also when there is room
      EXPECT_EQ(fs::file_size(path), size);
    }
    auto session = cloud.session(path);
    ASSERT_TRUE(session);
    expect_same_state(session->annotation(), *expected);
    EXPECT_FALSE(session->read_only());
    EXPECT_TRUE(session->apply({1, PaintPoints{many, 6}}));
  }
}

TEST(AnnotationSession, CannotBeginOnAFullDiskOrWithoutAFolder) {
  const AnnotatedCloud cloud{6};
  const TempFolder folder;
  {
    const SmallDisk disk{50};
    EXPECT_EQ(cloud.session(folder / "a").error().code, Errc::io_failure);
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  EXPECT_EQ(cloud.session(folder / "no/such/folder").error().code, Errc::io_failure);
  EXPECT_EQ(cloud.session(folder.path()).error().code, Errc::io_failure);
  EXPECT_EQ(cloud.session("/dev/null").error().code, Errc::invalid_argument);
}

/// Root may write everything; until the end of this, the process has another user.
class WithoutPrivileges {
 public:
  WithoutPrivileges() : before_{::geteuid()} {
    constexpr uid_t kNobody{65534};
    if (before_ == 0 && ::seteuid(kNobody) != 0) throw std::runtime_error{"cannot become another user"};
  }
  WithoutPrivileges(const WithoutPrivileges&) = delete;
  WithoutPrivileges& operator=(const WithoutPrivileges&) = delete;
  ~WithoutPrivileges() { static_cast<void>(::seteuid(before_) == 0); }

 private:
  uid_t before_;
};

TEST(AnnotationSession, AFileThatCannotBeWrittenIsOpenedToBeRead) {
  const AnnotatedCloud cloud{6};
  const TempFolder folder;
  {
    auto session = cloud.session(folder / "a");
    ASSERT_TRUE(session);
    annotate(*session, 1, 5);
  }
  ::chmod((folder / "a").c_str(), 0444);
  ::chmod(folder.path().c_str(), 0755);
  const WithoutPrivileges nobody;
  auto session = cloud.session(folder / "a");
  ASSERT_TRUE(session) << session.error().to_string();
  EXPECT_EQ(session->opening().actions, 5U);
  EXPECT_TRUE(session->read_only());
  EXPECT_EQ(session->apply({1, ClearAnnotation{}}).error().code, Errc::io_failure);
}

int kill_cases() {
  const char* wanted = std::getenv("SACCADE_KILL_CASES");
  return wanted != nullptr ? std::atoi(wanted) : test::scaled_cases(30);
}

/// Actions of a process: alternately anything, and paint on all points, whose record is long.
class LongAndShortActions {
 public:
  explicit LongAndShortActions(std::uint64_t seed) : random_{seed} {}

  AnnotationAction next(const Annotation& annotation) {
    long_ = !long_;
    if (!long_) return random_.next(annotation);
    std::vector<std::uint32_t> all(annotation.labels().size() - 1);
    std::iota(all.begin(), all.end(), 0U);
    const auto label = static_cast<std::uint32_t>(annotation.history().size() % 7);
    AnnotationAction paint{1, PaintPoints{std::move(all), label}};
    return annotation.validate(paint) ? paint : random_.next(annotation);  // a label may be locked
  }

 private:
  test::RandomActions random_;
  bool long_{false};
};

/// In a process of its own: annotates without end; one byte into the pipe for each action that is acknowledged.
[[noreturn]] void annotate_for_ever(const AnnotatedCloud& cloud, const fs::path& path, std::uint64_t seed, int acks) {
  auto session = cloud.session(path);
  if (!session) ::_exit(2);
  LongAndShortActions actions{seed};
  while (true) {
    const auto applied = session->apply(actions.next(session->annotation()));
    if (!applied) ::_exit(3);
    if (applied->done && ::write(acks, "+", 1) != 1) ::_exit(4);
  }
}

/// Kills the child some time after its first acknowledgements; how many there were in all.
std::size_t kill_somewhen(pid_t child, int acks, std::mt19937& random) {
  const std::size_t at_least = random() % 12;
  std::size_t count = 0;
  std::array<char, 4096> buffer{};
  while (count < at_least && ::read(acks, buffer.data(), 1) == 1) ++count;
  std::this_thread::sleep_for(std::chrono::microseconds{random() % 3000});
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << "status " << status;
  while (true) {
    const ssize_t got = ::read(acks, buffer.data(), buffer.size());
    if (got <= 0) return count;
    count += static_cast<std::size_t>(got);
  }
}

TEST(AnnotationSessionKilled, HoldsWhatWasAcknowledgedAndAtMostTheActionAtHand) {
  const AnnotatedCloud cloud{250};  // records up to 250 kB
  std::mt19937 random{11};
  std::size_t acknowledged = 0;
  std::size_t at_hand = 0;
  std::size_t torn = 0;
  const int cases = kill_cases();
  for (int i = 0; i < cases; ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const TempFolder folder;
    const fs::path path = folder / "a";
    const auto seed = static_cast<std::uint64_t>(i);
    Pipe pipe = Pipe::create().value();
    const pid_t child = ::fork();
    if (child == 0) annotate_for_ever(cloud, path, seed, pipe.write_end.get());
    pipe.write_end.reset();
    const std::size_t acks = kill_somewhen(child, pipe.read_end.get(), random);
    auto session = cloud.session(path);
    ASSERT_TRUE(session) << session.error().to_string();
    const std::size_t there = session->opening().actions;
    ASSERT_GE(there, acks);
    ASSERT_LE(there, acks + 1);
    Annotation expected{cloud.graph};
    LongAndShortActions same{seed};
    while (expected.history().size() < there) expected.apply(same.next(expected));
    ASSERT_NO_FATAL_FAILURE(expect_same_state(session->annotation(), expected));
    acknowledged += acks;
    at_hand += there - acks;
    torn += session->opening().torn_bytes > 0 ? 1 : 0;
  }
  EXPECT_GT(acknowledged, static_cast<std::size_t>(3 * cases));
  std::cout << cases << " processes killed: " << acknowledged << " actions acknowledged and there, " << at_hand
            << " there without, " << torn << " torn records dropped\n";
}

}  // namespace
}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/internal/external_process.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <thread>

#include "saccade/core/clock.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

constexpr double kPatience_s{8.0};
constexpr double kShort_s{0.15};

std::unique_ptr<ExternalProcess> started(const std::string& command) {
  auto process = ExternalProcess::start({"camera", command, {}, {}});
  EXPECT_TRUE(process.ok());
  return std::move(process).value();
}

/// The error of one question.
Error error_of(const std::string& command, double limit_s = kPatience_s) {
  const auto process = started(command);
  const Request request{"hello", limit_s};
  const auto answer = process->ask(request, "{}");
  EXPECT_FALSE(answer.ok()) << command;
  const Error error = answer ? Error{} : answer.error();
  EXPECT_EQ(error.to_string().find_first_of("\r\n"), std::string::npos);
  EXPECT_NE(error.to_string().find("camera '" + command.substr(0, 8)), std::string::npos) << error.to_string();
  return error;
}

void expect_says(const Error& error, Errc code, const std::string& words) {
  EXPECT_EQ(error.code, code) << error.to_string();
  EXPECT_NE(error.to_string().find(words), std::string::npos) << error.to_string();
}

TEST(ExternalProcess, AnswersLinesAndBytes) {
  const auto process = started("sh -c 'read a; echo \"<$a>\"; read b; printf \"six\\r\\nabcdef\"; read c; echo end'");
  const auto first = process->ask({"one", kPatience_s}, "hello there");
  ASSERT_TRUE(first.ok());
  EXPECT_EQ(*first, "<hello there>");
  const Request request{"two", kPatience_s};
  const auto second = process->ask(request, "");
  ASSERT_TRUE(second.ok());
  EXPECT_EQ(*second, "six");
  std::array<std::byte, 6> bytes{};
  ASSERT_TRUE(process->read_bytes(request, bytes).ok());
  EXPECT_EQ(bytes.back(), std::byte{'f'});
  EXPECT_TRUE(process->read_bytes(request, {}).ok());
  const auto third = process->ask({"three", kPatience_s}, "");
  ASSERT_TRUE(third.ok());
  EXPECT_EQ(*third, "end");
}

TEST(ExternalProcess, AProgramThatIsNotThere) {
  expect_says(error_of("/nowhere/at-all --fast"), Errc::not_found, "no such program");
  expect_says(error_of("/nowhere/at-all --fast"), Errc::not_found, "/nowhere/at-all: not found");
  expect_says(error_of("/etc/passwd"), Errc::io_failure, "exit status 126");
  EXPECT_FALSE(ExternalProcess::start({"camera", " ", {}, {}}).ok());
}

TEST(ExternalProcess, AProgramThatEnds) {
  expect_says(error_of("sh -c 'echo no device >&2; exit 3'"), Errc::io_failure,
              "ended with exit status 3 before the answer to hello");
  expect_says(error_of("sh -c 'echo no device >&2; exit 3'"), Errc::io_failure, "its stderr ends: no device");
  expect_says(error_of("sh -c 'read a; kill -SEGV $$'"), Errc::io_failure, "was ended by signal 11 (Segmentation");
  expect_says(error_of("sh -c 'read a; printf \"{\\\"sac\"; exit 4'"), Errc::io_failure, "which begins '{\"sac'");
}

TEST(ExternalProcess, AProgramThatDiesAmidItsBytes) {
  const auto process = started("sh -c 'read a; echo ok; printf 12345; exit 1'");
  const Request request{"frame 7", kPatience_s};
  ASSERT_TRUE(process->ask(request, "").ok());
  std::array<std::byte, 9> bytes{};
  const Status status = process->read_bytes(request, bytes);
  ASSERT_FALSE(status.ok());
  expect_says(status.error(), Errc::io_failure, "exit status 1 before all of the answer to frame 7: 5 of the 9 bytes");
  const auto again = process->ask(request, "");  // for good
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().to_string(), status.error().to_string());
}

TEST(ExternalProcess, AProgramThatHangs) {
  const Stopwatch clock;
  expect_says(error_of("sh -c 'cat >/dev/null'", kShort_s), Errc::io_failure, "hello took longer");
  expect_says(error_of("sh -c 'read a; printf half; cat >/dev/null'", kShort_s), Errc::io_failure,
              "than the 0.15 s allowed");
  const auto process = started("sh -c 'read a; echo ok; printf 123; cat >/dev/null'");
  ASSERT_TRUE(process->ask({"frame 1", kPatience_s}, "").ok());
  const Request request{"frame 1", kShort_s};
  std::array<std::byte, 9> bytes{};
  const Status status = process->read_bytes(request, bytes);
  ASSERT_FALSE(status.ok());
  expect_says(status.error(), Errc::io_failure, "only 3 of the 9 bytes");
  EXPECT_LT(clock.elapsed_ms(), 3000.0);
}

TEST(ExternalProcess, AProgramWhoseHelperHangs) {
  // The program ends once it is asked, and its helper keeps the answer open.
  constexpr double kTimeToEnd_s{2.0};
  expect_says(error_of("sh -c 'read a; sleep 1000 & exit 2'", kTimeToEnd_s), Errc::io_failure,
              "the program itself ended with exit status 2");
}

TEST(ExternalProcess, AProgramThatDoesNotRead) {
  const auto process = started("sleep 1000");
  const Status status = process->write_line({"hello", kShort_s}, std::string(1 << 20, 'a'));
  ASSERT_FALSE(status.ok());
  expect_says(status.error(), Errc::io_failure, "it did not read the request");
}

TEST(ExternalProcess, AProgramThatClosesItsStreams) {
  const auto deaf = started("sh -c 'exec 0</dev/null; echo ready; sleep 1000'");
  ASSERT_TRUE(deaf->read_line({"start", kPatience_s}).ok());
  const Status status = deaf->write_line({"hello", kPatience_s}, "");
  ASSERT_FALSE(status.ok());
  expect_says(status.error(), Errc::io_failure, "it closed its input before the answer to hello, and goes on running");
  // And SIGPIPE has not ended this test.
  expect_says(error_of("cat >/dev/null"), Errc::io_failure,
              "it closed its output before the answer to hello, and goes");
}

TEST(ExternalProcess, RubbishIsQuoted) {
  expect_says(error_of("sh -c 'read a; cat /dev/zero | tr \"\\0\" x'"), Errc::corrupt_data,
              "no end of line within 65536 bytes; it begins 'xxxxx");
  const auto process = started("sh -c 'read a; echo ok; echo SDK 1.2; read b'");
  ASSERT_TRUE(process->ask({"hello", kPatience_s}, "").ok());
  std::this_thread::sleep_for(std::chrono::milliseconds{50});
  const auto answer = process->ask({"frame 0", kPatience_s}, "");
  ASSERT_FALSE(answer.ok());
  expect_says(answer.error(), Errc::corrupt_data, "it sent, before it was asked for frame 0, 'SDK 1.2 '");
}

TEST(ExternalProcess, FloodsOfMessagesBlockNobody) {
  // 6 MB before the answer, and as much after it, while no request is pending.
  const auto process = started(
      "sh -c 'n=\"yes 012345678901234567890123456789012345678901234567890123456789\"; read a; $n | head -100000 >&2; "
      "echo ok; $n | head -100000 >&2; echo last >&2; read b; exit 5'");
  ASSERT_TRUE(process->ask({"hello", kPatience_s}, "").ok());
  const auto answer = process->ask({"frame 0", kPatience_s}, "");
  ASSERT_FALSE(answer.ok());
  expect_says(answer.error(), Errc::io_failure, "exit status 5");
  expect_says(answer.error(), Errc::io_failure, "0123456789 | last");
  EXPECT_LT(answer.error().to_string().size(), 1000U);
}

/// Tells whether any process of a group still runs. Its state and group follow the name, which ends with the last ')'.
bool any_left(pid_t group) {
  for (const auto& entry : std::filesystem::directory_iterator{"/proc"}) {
    std::ifstream file{entry.path() / "stat"};
    std::string line;
    if (!std::getline(file, line) || line.rfind(')') == std::string::npos) continue;
    std::istringstream fields{line.substr(line.rfind(')') + 1)};
    char state = 0;
    pid_t parent = 0;
    pid_t its_group = 0;
    fields >> state >> parent >> its_group;
    if (its_group == group && state != 'Z' && state != 'X') return true;
  }
  return false;
}

TEST(ExternalProcess, LeavesNothingBehind) {
  pid_t polite = 0;
  {
    const auto process = started("sh -c 'read a; read b'");
    polite = process->pid();
    EXPECT_TRUE(any_left(polite));
  }
  EXPECT_FALSE(any_left(polite));
  EXPECT_EQ(::waitpid(polite, nullptr, WNOHANG), -1);  // no zombie

  pid_t stubborn = 0;
  const Stopwatch clock;
  {
    const auto process =
        started("sh -c 'trap \"\" TERM HUP INT; echo ready; sleep 1000 & while true; do sleep 0.1; done'");
    stubborn = process->pid();
    ASSERT_TRUE(process->read_line({"start", kPatience_s}).ok());
  }
  EXPECT_GT(clock.elapsed_ms(), 1000.0);
  EXPECT_LT(clock.elapsed_ms(), 4000.0);
  for (int i = 0; i < 200 && any_left(stubborn); ++i) std::this_thread::sleep_for(std::chrono::milliseconds{10});
  EXPECT_FALSE(any_left(stubborn));
}

TEST(ExternalProcess, TheEndOfItsInputEndsItInOrder) {
  const test::TempFolder folder;
  const auto note = folder / "note";
  { const auto process = started("sh -c 'cat >/dev/null; sleep 0.2; echo at rest >" + note.string() + "'"); }
  std::ifstream file{note};
  std::string text;
  std::getline(file, text);
  EXPECT_EQ(text, "at rest");
}

TEST(ExternalProcess, InheritsNoSignals) {
  ::signal(SIGPIPE, SIG_IGN);
  const auto process = started("sh -c 'read a; kill -PIPE $$; echo still here'");
  const auto answer = process->ask({"hello", kPatience_s}, "");
  ::signal(SIGPIPE, SIG_DFL);
  ASSERT_FALSE(answer.ok());
  expect_says(answer.error(), Errc::io_failure, "signal 13");
}

TEST(ExternalProcess, InheritsNoPipes) {
  auto first = started("sh -c 'cat >/dev/null'");
  const auto second = started("sh -c 'cat >/dev/null'");
  const Stopwatch clock;
  first.reset();  // its input ends, though the second one lives
  EXPECT_LT(clock.elapsed_ms(), 900.0);
}

TEST(ExternalProcess, TimeLimitsAreChecked) {
  EXPECT_TRUE(validate_time_limit(1.0, "camera").ok());
  for (const double bad : {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(validate_time_limit(bad, "camera").ok());
  }
}

TEST(ReadableText, IsOneLineOfUtf8) {
  EXPECT_EQ(readable("a\nb\x1b[1m\x7f", 80), "a b [1m ");
  EXPECT_EQ(readable("10 \xC2\xB0\xE2\x86\x92\xF0\x9F\x98\x80", 80), "10 \xC2\xB0\xE2\x86\x92\xF0\x9F\x98\x80");
  EXPECT_EQ(readable("\xFF\xC0\x80\xE0\x80\x80\xED\xA0\x80\xF4\x90\x80\x80\xE2\x86", 80), "???????????????");
  EXPECT_EQ(readable("\xC2\x9B"
                     "x",
                     80),
            " x");
  EXPECT_EQ(readable("abc\xC2\xB0", 4), "abc...");
  EXPECT_EQ(readable("abcd", 4), "abcd");
}

TEST(ReadableText, LastLines) {
  EXPECT_EQ(last_lines(""), "");
  EXPECT_EQ(last_lines("\n \r\n"), "");
  EXPECT_EQ(last_lines("one"), "one");
  EXPECT_EQ(last_lines("one\ntwo\n\n  three\nfour\n"), "two | three | four");
}

}  // namespace
}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#pragma once
// RunningProgram, run_program: the built command line as a child process; Outcome and what is expected of it.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "support/places.hpp"
#include "support/temp_folder.hpp"

namespace saccade::test {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

inline std::string text_of(const fs::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

struct Outcome {
  int status{-1};  ///< −1 when a signal ended it
  std::string out;
  std::string err;

  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(out, nullptr, false); }
};

/// The program, started with the given arguments; its output goes to files.
class RunningProgram {
 public:
  /// file_bytes > 0: writing a larger file fails in the program, as on a full disk.
  /// `input` is what stands on its standard input.
  explicit RunningProgram(const Arguments& arguments, rlim_t file_bytes = 0, const std::string& input = "",
                          const char* program = saccade_program()) {
    std::ofstream{folder_ / "in"} << input;
    const std::string in = (folder_ / "in").string();
    std::vector<char*> argv{const_cast<char*>(program)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const std::string out = (folder_ / "out").string();
    const std::string err = (folder_ / "err").string();
    pid_ = ::fork();
    if (pid_ != 0) return;
    ::dup2(::open(in.c_str(), O_RDONLY), STDIN_FILENO);
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    const rlimit limit{file_bytes, file_bytes};
    if (file_bytes > 0) ::setrlimit(RLIMIT_FSIZE, &limit);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;
  ~RunningProgram() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
  }

  [[nodiscard]] std::string out() const { return text_of(folder_ / "out"); }
  [[nodiscard]] std::string err() const { return text_of(folder_ / "err"); }
  void send(int signal) const { ::kill(pid_, signal); }
  [[nodiscard]] pid_t id() const { return pid_; }
  /// Returns the processor time of all its threads so far. Unlike wall time, it does not grow with other work on the
  /// machine.
  [[nodiscard]] double processor_ms() const {
    clockid_t clock{};
    timespec used{};
    if (::clock_getcpuclockid(pid_, &clock) != 0 || ::clock_gettime(clock, &used) != 0) return 0.0;
    return 1e3 * static_cast<double>(used.tv_sec) + 1e-6 * static_cast<double>(used.tv_nsec);
  }
  /// Tells whether the text shows up on standard error within 120 s.
  [[nodiscard]] bool wait_for(const std::string& text) const {
    for (int i = 0; i < 24000; ++i) {
      if (err().find(text) != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds{5});
    }
    return false;
  }
  [[nodiscard]] Outcome finish() {
    int status{0};
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, out(), err()};
  }

 private:
  TempFolder folder_;
  pid_t pid_{-1};
};

inline Outcome run_program(const Arguments& arguments, rlim_t file_bytes = 0, const std::string& input = "") {
  return RunningProgram{arguments, file_bytes, input}.finish();
}

/// Tells whether the file appears within 60 s.
inline bool wait_for_file(const fs::path& path) {
  for (int i = 0; i < 12000 && !fs::exists(path); ++i) std::this_thread::sleep_for(std::chrono::milliseconds{5});
  return fs::exists(path);
}

inline Arguments operator+(Arguments left, const Arguments& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/// One line on standard error that names the command and holds all of `parts`; nothing on standard output.
inline void expect_failure(const Outcome& outcome, int status, const std::string& command, const Arguments& parts) {
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("saccade " + command + ": ")) << outcome.err;
  for (const std::string& part : parts)
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << "\n" << outcome.err;
}

inline void expect_envelope(const nlohmann::json& document, const std::string& command) {
  ASSERT_TRUE(document.is_object());
  EXPECT_EQ(document.at("schema"), "saccade-result/1");
  EXPECT_TRUE(document.at("version").is_string());
  EXPECT_EQ(document.at("command"), command);
  EXPECT_TRUE(document.at("backend").is_string());
  EXPECT_TRUE(document.at("threads").is_number_unsigned());
  EXPECT_TRUE(document.at("seed").is_number_unsigned());
  EXPECT_TRUE(document.at("timings_ms").at("total").is_number());
  EXPECT_TRUE(document.at("result").is_object());
}

/// Names in a folder, sorted.
inline std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator{folder, ignored}) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// A small sample sequence: 160×120, noisy.
inline void make_sample(const fs::path& folder, int frames) {
  const Outcome outcome = run_program({"sample", "--out", folder.string(), "--frames", std::to_string(frames),
                                       "--noise", "--image-size", "160,120", "--max-range", "1.5", "--quiet"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
}

/// Fast settings for it.
inline Arguments fuse(const fs::path& frames, const fs::path& out, const Arguments& more = {}) {
  return Arguments{"fuse", frames.string(), "--out", out.string(), "--quiet", "--voxel-size", "0.01"} + more;
}

}  // namespace saccade::test

// SPDX-License-Identifier: Apache-2.0
// saccade starts the program saccade-reproduce in its own place: output, signals and the exit status are that one's.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "reproduce.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReproduceProgram{"saccade-reproduce"};

bool is_program(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

/// The folder of this program; empty where the system does not say.
fs::path own_folder() {
  std::error_code failed;
  const fs::path self = fs::read_symlink("/proc/self/exe", failed);
  return failed ? fs::path{} : self.parent_path();
}

/// Looks beside this program, then on PATH.
Result<fs::path> find_reproduce_program() {
  const fs::path beside = own_folder();
  if (!beside.empty() && is_program(beside / kReproduceProgram)) return beside / kReproduceProgram;
  const char* path = std::getenv("PATH");
  std::istringstream folders{path == nullptr ? "" : path};
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path{folder.empty() ? "." : folder} / kReproduceProgram;
    if (is_program(program)) return program;
  }
  return Error{Errc::unavailable,
               "the program that makes the tables is not installed: it is neither beside saccade (" +
                   (beside.empty() ? std::string{"whose folder is not known"} : beside.string()) +
                   ") nor on PATH; install it, or build the target saccade-reproduce",
               kReproduceProgram};
}

}  // namespace

void check_reproduce(ReproduceArguments& /*arguments*/, const GlobalOptions& /*global*/) {}

Result<int> run_reproduce(const ReproduceArguments& arguments, const GlobalOptions& /*global*/) {
  SACCADE_TRY(const fs::path program, find_reproduce_program());
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.words.begin(), arguments.words.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::cout.flush();
  ::execv(argv[0], argv.data());
  return Error{Errc::unavailable, "cannot be started", program.string()};
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
// saccade-reproduce TABLE…: what `saccade reproduce` starts. It reads the same command line, so that it works alone,
// too.
#include <vector>

#include "command_line.hpp"
#include "saccade/trial/simulated_run.hpp"

int main(int argc, char** argv) {
  char command[] = "reproduce";
  std::vector<char*> words{argv, argv + argc};
  words.insert(words.begin() + (argc > 0 ? 1 : 0), command);
  const auto count = static_cast<int>(words.size());
  words.push_back(nullptr);
  return saccade::cli::run_command_line(count, words.data(), saccade::trial_planners());
}

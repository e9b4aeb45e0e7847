// SPDX-License-Identifier: Apache-2.0
// saccade generate: manual pages and completion, for the packages. The program describes itself, so no list of its
// options is written a second time. Hidden, since it is of no use to others.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "add_value.hpp"
#include "command.hpp"
#include "command_tree.hpp"
#include "exit_status.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade::cli {
namespace {

struct ManualOptions {
  std::filesystem::path folder;
  std::string date;
};

Result<int> write_manual(const CLI::App& program, const ManualOptions& options) {
  std::error_code failed;
  std::filesystem::create_directories(options.folder, failed);
  if (failed) return Error{Errc::io_failure, "cannot make the folder", options.folder.string()};
  for (const auto& [name, text] : manual_pages(command_tree(program), SACCADE_VERSION, options.date)) {
    SACCADE_CHECK(write_file_atomically(options.folder / name, text));
  }
  return static_cast<int>(ExitStatus::done);
}

}  // namespace

void add_generate(CLI::App& program, const GlobalOptions& /*global*/, Action& action) {
  CLI::App* command = program.add_subcommand("generate", "manual pages and completion of this program")->group("");
  command->require_subcommand(1);
  CLI::App* manual = command->add_subcommand("man", "manual pages, one per command");
  auto options = std::make_shared<ManualOptions>();
  add_value(*manual, "folder", options->folder, "DIR", "folder for the pages; made if it is not there")->required();
  add_value(*manual, "--date", options->date, "YYYY-MM-DD", "date that stands in the pages");
  manual->callback(
      [options, &program, &action] { action = [options, &program] { return write_manual(program, *options); }; });

  using Completion = std::string(const CommandEntry&);
  const auto add_shell = [&](const char* shell, Completion* completion) {
    command->add_subcommand(shell, std::string{"completion in "} + shell)->callback([completion, &program, &action] {
      action = [completion, &program] {
        std::cout << completion(command_tree(program));
        return Result<int>{static_cast<int>(ExitStatus::done)};
      };
    });
  };
  add_shell("bash", bash_completion);
  add_shell("zsh", zsh_completion);
  add_shell("fish", fish_completion);
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
// The scaffold of commands: from a declaration to an exit status.
#include <CLI/CLI.hpp>
#include <iostream>

#include "context.hpp"
#include "exit_status.hpp"
#include "saccade/io/files/json_io.hpp"

namespace saccade::cli {
namespace {

/// A command with what its declaration and the command line say.
struct Declaration {
  std::shared_ptr<Command> command;
  FolderRequest folder;
};

/// Prints and returns the exit status.
int finish(const std::string& name, const Outcome& outcome) {
  for (const std::string& warning : outcome.warnings) print_error(name, warning);
  if (!outcome.cut_short.empty() || interrupted()) {
    if (!outcome.cut_short.empty()) print_error(name, outcome.cut_short);
    if (interrupted() && !outcome.afterwards) return interrupt_status();
  }
  if (outcome.empty.empty()) return static_cast<int>(ExitStatus::done);
  print_error(name, outcome.empty);
  return static_cast<int>(ExitStatus::no_result);
}

Result<int> run_command(const Declaration& declared, const GlobalOptions& global) {
  const CommandInfo info = declared.command->info();
  const std::string name = info.result_name.empty() ? info.name : info.result_name;
  SACCADE_CHECK(check_json_output(global));
  Context context{global, name, declared.folder};
  if (!declared.folder.opened_by_command) SACCADE_CHECK(context.open_folder());
  SACCADE_TRY(Outcome outcome, declared.command->run(context));
  if (outcome.result.is_null()) {
    context.bar().finish();
    std::cout << outcome.text << std::flush;
    return finish(name, outcome);
  }
  const nlohmann::json document = context.document(std::move(outcome.result));
  if (context.folder() != nullptr && !declared.folder.document.empty() && !context.document_is_written()) {
    SACCADE_CHECK(write_json(*context.folder() / declared.folder.document, document));
  }
  context.bar().finish();
  SACCADE_CHECK(write_json_output(global, document));
  if (!global.json_to_stdout()) std::cout << outcome.text << std::flush;
  if (outcome.afterwards) outcome.afterwards();
  return finish(name, outcome);
}

}  // namespace

Context::Context(const GlobalOptions& global, std::string result_name, const FolderRequest& folder)
    : global_{global},
      result_name_{std::move(result_name)},
      request_{folder},
      executor_{global.executor()},
      bar_{global.quiet, !global.json_to_stdout()},
      progress_{[this](std::string_view stage, std::size_t done, std::size_t total) {
        bar_.update(stage_.empty() ? stage : stage_, done, total);
      }},
      cancel_{progress_} {}

Progress& Context::stage(std::string name) {
  stage_ = std::move(name);
  bar_.update(stage_, 0, 0);
  return progress_;
}

Status Context::stop_if_interrupted() const {
  return interrupted() ? Status{Error{Errc::cancelled, "interrupted", {}}} : Status{};
}

Status Context::open_folder(std::string_view marker) {
  if (request_.path.empty()) return {};
  if (marker.empty()) marker = request_.marker.empty() ? request_.document : request_.marker;
  SACCADE_TRY(RunFolder opened, RunFolder::open(request_.path, request_.files, marker, request_.force));
  folder_.emplace(std::move(opened));
  return {};
}

nlohmann::json Context::document(nlohmann::json result) {
  timings_ms_.try_emplace("total", total_.elapsed_ms());  // a page and the files of one run say one time
  return json_envelope(result_name_, global_, executor_, timings_ms_, std::move(result));
}

nlohmann::json Context::document_so_far(nlohmann::json result) const {
  TimingsMs timings_ms = timings_ms_;
  timings_ms.try_emplace("total", total_.elapsed_ms());
  return json_envelope(result_name_, global_, executor_, timings_ms, std::move(result));
}

Result<nlohmann::json> Context::write_document(nlohmann::json result) {
  SACCADE_EXPECTS(folder_ && !request_.document.empty());
  nlohmann::json written = document(std::move(result));
  SACCADE_CHECK(write_json(*folder_ / request_.document, written));
  document_is_written_ = true;
  return written;
}

void add_command(CLI::App& program, const GlobalOptions& global, Action& action, std::shared_ptr<Command> command) {
  const CommandInfo info = command->info();
  CLI::App* added = program.add_subcommand(info.name, info.description);
  if (info.hidden) added->group("");
  std::vector<std::unique_ptr<Command>> parts = command->parts();
  if (!parts.empty()) {
    added->require_subcommand(1);
    for (std::unique_ptr<Command>& part : parts) add_command(*added, global, action, std::move(part));
    return;
  }
  auto declared = std::make_shared<Declaration>();
  declared->command = std::move(command);
  Options options{*added, declared->folder};
  declared->command->declare(options);
  added->callback([declared, &global, &action] {
    if (declared->folder.path.empty() && declared->folder.otherwise) {
      declared->folder.path = declared->folder.otherwise();
    }
    declared->command->check(global);
    action = [declared, &global] { return run_command(*declared, global); };
  });
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
// saccade generate: manual pages, completion and the reference in docs. The program describes itself, so no list of its
// options is written a second time. Hidden, since it is of no use to others.
#include <CLI/CLI.hpp>

#include "command_tree.hpp"
#include "context.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade::cli {
namespace {

/// The program that a command belongs to.
const CLI::App* program_of(Options& options) {
  const CLI::App* app = &options.group();
  while (app->get_parent() != nullptr) app = app->get_parent();
  return app;
}

class GenerateManual final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {.name = "man", .description = "manual pages, one per command", .result_name = "generate"};
  }
  void declare(Options& options) override {
    program_ = program_of(options);
    options.value("folder", folder_, "DIR", "folder for the pages; made if it is not there").required();
    options.value("--date", date_, "YYYY-MM-DD", "date that stands in the pages");
  }
  [[nodiscard]] Result<Outcome> run(Context& /*context*/) override {
    std::error_code failed;
    std::filesystem::create_directories(folder_, failed);
    if (failed) return Error{Errc::io_failure, "cannot make the folder", folder_.string()};
    const auto pages = manual_pages(command_tree(*program_), SACCADE_VERSION, date_);
    for (const auto& [name, text] : pages) SACCADE_CHECK(write_file_atomically(folder_ / name, text));
    return Outcome{.result = {{"pages", pages.size()}}};
  }

 private:
  const CLI::App* program_{nullptr};
  std::filesystem::path folder_;
  std::string date_;
};

/// A text about the whole program, to standard output.
class GenerateText final : public Command {
 public:
  using Make = std::string(const CommandEntry&);
  GenerateText(std::string name, std::string description, Make* make)
      : name_{std::move(name)}, description_{std::move(description)}, make_{make} {}
  [[nodiscard]] CommandInfo info() const override {
    return {.name = name_, .description = description_, .result_name = "generate"};
  }
  void declare(Options& options) override { program_ = program_of(options); }
  [[nodiscard]] Result<Outcome> run(Context& /*context*/) override {
    return Outcome{.text = make_(command_tree(*program_))};
  }

 private:
  std::string name_;
  std::string description_;
  Make* make_;
  const CLI::App* program_{nullptr};
};

class Generate final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {.name = "generate",
            .description = "writes manual pages, completion and reference of this program",
            .hidden = true};
  }
  [[nodiscard]] std::vector<std::unique_ptr<Command>> parts() const override {
    std::vector<std::unique_ptr<Command>> parts;
    parts.push_back(std::make_unique<GenerateManual>());
    parts.push_back(std::make_unique<GenerateText>("bash", "completion in bash", bash_completion));
    parts.push_back(std::make_unique<GenerateText>("zsh", "completion in zsh", zsh_completion));
    parts.push_back(std::make_unique<GenerateText>("fish", "completion in fish", fish_completion));
    parts.push_back(std::make_unique<GenerateText>("markdown", "docs/reference/cli.md", markdown_reference));
    return parts;
  }
};

}  // namespace

void add_generate(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Generate>(program, global, action);
}

}  // namespace saccade::cli

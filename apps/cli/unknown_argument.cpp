// SPDX-License-Identifier: Apache-2.0
#include "unknown_argument.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

#include "saccade/core/names.hpp"
#include "saccade/core/nearest_word.hpp"

namespace saccade::cli {
namespace {

/// A dash and a letter, or two dashes: no negative number.
bool is_option(const std::string& argument) {
  if (argument.size() < 2 || argument[0] != '-') return false;
  return argument[1] == '-' || std::isalpha(static_cast<unsigned char>(argument[1])) != 0;
}

/// Names of the options of a command and those above it.
std::vector<std::string> option_names(const CLI::App* command) {
  std::vector<std::string> names;
  for (; command != nullptr; command = command->get_parent()) {
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  return names;
}

}  // namespace

const CLI::App* chosen_command(const CLI::App& program) {
  const CLI::App* chosen = &program;
  while (!chosen->get_subcommands().empty()) chosen = chosen->get_subcommands().front();
  return chosen;
}

std::vector<std::string_view> visible_commands(const CLI::App& command) {
  std::vector<std::string_view> names;
  for (const CLI::App* below : command.get_subcommands([](const CLI::App* app) { return !app->get_group().empty(); })) {
    names.emplace_back(below->get_name());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string unknown_argument(const CLI::App& program) {
  const std::vector<std::string> left = program.remaining(true);
  if (left.empty()) return {};
  const CLI::App* chosen = chosen_command(program);
  if (const auto option = std::find_if(left.begin(), left.end(), is_option); option != left.end()) {
    const std::string name = option->substr(0, option->find('='));
    const std::vector<std::string> known = option_names(chosen);
    return "there is no option " + name + did_you_mean(name, std::vector<std::string_view>{known.begin(), known.end()});
  }
  if (chosen->get_require_subcommand_min() > 0) {
    const std::vector<std::string_view> known = visible_commands(*chosen);
    const std::string nearest = did_you_mean(left.front(), known);
    return "there is no command " + left.front() + (nearest.empty() ? "; name " + listed(known) : nearest);
  }
  return "there is an argument too many: " + left.front();
}

}  // namespace saccade::cli

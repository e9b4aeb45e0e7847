// SPDX-License-Identifier: Apache-2.0
#include "command_tree.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <string_view>

#include "help_formatter.hpp"
#include "saccade/core/names.hpp"

namespace saccade::cli {
namespace {

std::vector<std::string> parts_of(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

bool has_capital(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) { return std::isupper(c) != 0; });
}

/// CLI11's text for a type: a placeholder, then the description of each check, with colons between.
struct TypeText {
  std::string placeholder;
  std::string checks;
};

TypeText type_text(const CLI::Option& option) {
  const std::string text = option.get_type_name();
  const std::size_t bracket = text.find('[');  // a colon in brackets belongs to the placeholder: DIR[:DIR]
  std::size_t colon = text.find(':');
  if (bracket < colon) colon = text.find(':', std::min(text.find(']', bracket), text.size()));
  if (colon == std::string::npos) return {text, ""};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

/// Words that are the only values: those of a placeholder a|b, or of a check {a,b} or {a->0,b->1}.
std::vector<std::string> words_of(const TypeText& type) {
  if (type.placeholder.find('|') != std::string::npos && !has_capital(type.placeholder)) {
    return parts_of(type.placeholder, '|');
  }
  const std::size_t open = type.checks.find('{');
  const std::size_t close = type.checks.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  std::vector<std::string> words = parts_of(std::string_view{type.checks}.substr(open + 1, close - open - 1), ',');
  for (std::string& word : words) word = word.substr(0, word.find("->"));
  return words;
}

/// Placeholders name what they stand for.
ValueKind kind_of(const TypeText& type, const std::vector<std::string>& words) {
  if (!words.empty()) return ValueKind::word;
  for (const char* folder : {"DIR", "RUN", "FOLDER"}) {
    if (type.placeholder == folder) return ValueKind::folder;
  }
  for (const char* file : {"FILE", "RUN", "DIR", "CLOUD", "MAP", "MESH", "URDF", "SCENE", "CELL", "TRUTH", "LABELS",
                           "ROBOT", "COMMAND", "PATH", "BAG", "HANDS"}) {
    if (type.placeholder.find(file) != std::string::npos) return ValueKind::file;
  }
  return ValueKind::text;
}

std::string range_of(const TypeText& type) { return range_text(type.checks); }

std::string placeholder_of(const TypeText& type, const std::vector<std::string>& words) {
  if (!words.empty()) return joined(words, "|");
  return type.placeholder.empty() ? "VALUE" : type.placeholder;
}

OptionEntry option_entry(const CLI::Option& option) {
  OptionEntry entry;
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : shown_names(option)) entry.names.push_back("--" + name);
  entry.description = option.get_description();
  entry.group = option.get_group();
  entry.required = option.get_required();
  if (option.get_items_expected_max() == 0) return entry;
  const TypeText type = type_text(option);
  entry.words = words_of(type);
  entry.kind = kind_of(type, entry.words);
  entry.value = placeholder_of(type, entry.words);
  entry.preset = option.get_default_str();
  entry.range = range_of(type);
  entry.repeats = option.get_items_expected_max() > 1;
  return entry;
}

ArgumentEntry argument_entry(const CLI::Option& option) {
  const TypeText type = type_text(option);
  const std::vector<std::string> words = words_of(type);
  return {.name = option.get_name(true),
          .value = placeholder_of(type, words),
          .kind = kind_of(type, words),
          .description = option.get_description(),
          .required = option.get_required(),
          .repeats = option.get_items_expected_max() > 1};
}

CommandEntry command_entry(const CLI::App& command, std::vector<std::string> path) {
  CommandEntry entry;
  entry.path = std::move(path);
  entry.path.push_back(command.get_name());
  entry.description = command.get_description();
  entry.footer = command.get_footer();
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    if (option->get_positional()) {
      entry.arguments.push_back(argument_entry(*option));
    } else {
      entry.options.push_back(option_entry(*option));
    }
  }
  for (const CLI::App* below : command.get_subcommands([](const CLI::App* app) { return !app->get_group().empty(); })) {
    entry.commands.push_back(command_entry(*below, entry.path));
  }
  return entry;
}

}  // namespace

std::vector<std::string> shown_names(const CLI::Option& option) {
  std::vector<std::string> names = option.get_lnames();
  const bool is_flag = option.get_items_expected_max() == 0;
  if (!is_flag && names.size() > 1) names.resize(1);
  return names;
}

ValueText value_text(const CLI::Option& option) {
  const TypeText type = type_text(option);
  return {placeholder_of(type, words_of(type)), range_of(type)};
}

std::string CommandEntry::path_with(const std::string& separator) const { return joined(path, separator); }

CommandEntry command_tree(const CLI::App& program) { return command_entry(program, {}); }

std::vector<const CommandEntry*> all_commands(const CommandEntry& program) {
  std::vector<const CommandEntry*> all{&program};
  for (const CommandEntry& below : program.commands) {
    const std::vector<const CommandEntry*> further = all_commands(below);
    all.insert(all.end(), further.begin(), further.end());
  }
  return all;
}

}  // namespace saccade::cli

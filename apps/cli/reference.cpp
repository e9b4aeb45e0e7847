// SPDX-License-Identifier: Apache-2.0
// The reference of the command line, in Markdown.
#include <algorithm>

#include "command_tree.hpp"
#include "saccade/core/names.hpp"

namespace saccade::cli {
namespace {

/// Text in a cell of a table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*' || c == '_') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

std::string code(const std::string& text) {
  std::string out{"`"};
  for (const char c : text) out += c == '|' ? std::string{"\\|"} : std::string{c};
  return out + "`";
}

std::string value_cell(const OptionEntry& option) {
  if (option.value.empty()) return "";
  std::string text = option.words.empty() ? code(option.value) : joined(option.words, ", ", code);
  if (!option.range.empty()) text += ", " + cell(option.range);
  if (option.repeats) text += ", may be repeated";
  return text;
}

std::string synopsis_of(const CommandEntry& command) {
  std::string text = command.path_with(" ");
  if (!command.options.empty()) text += " [OPTIONS]";
  if (!command.commands.empty()) text += " COMMAND";
  for (const ArgumentEntry& argument : command.arguments) {
    const std::string value = argument.value + (argument.repeats && !argument.value.ends_with("...") ? "..." : "");
    text += argument.required ? " " + value : " [" + value + "]";
  }
  return "```\n" + text + "\n```\n\n";
}

std::string options_table(const CommandEntry& command) {
  if (command.options.empty()) return "";
  std::string text{"| option | value | default | |\n|---|---|---|---|\n"};
  for (const OptionEntry& option : command.options) {
    text += "| " + joined(option.names, ", ", code) + " | " + value_cell(option) + " | " +
            (option.required         ? std::string{"required"}
             : option.preset.empty() ? std::string{}
                                     : code(option.preset)) +
            " | " + cell(option.description) + " |\n";
  }
  return text + "\n";
}

std::string section(const CommandEntry& command) {
  std::string text =
      "## " + command.path_with(" ") + "\n\n" + cell(command.description) + ".\n\n" + synopsis_of(command);
  for (const ArgumentEntry& argument : command.arguments) {
    text += "- " + code(argument.value) + ": " + cell(argument.description) + "\n";
  }
  if (!command.arguments.empty()) text += "\n";
  return text + options_table(command);
}

}  // namespace

std::string markdown_reference(const CommandEntry& program) {
  std::string text{
      "# The command line\n\n"
      "Made by `saccade generate markdown` from the declarations of the options; a test compares.\n\n"};
  text += cell(program.description) + "\n\n" + synopsis_of(program);
  text += "These options may stand with every command:\n\n" + options_table(program);
  text += "```\n" + program.footer + "\n```\n\n";
  std::vector<const CommandEntry*> commands = all_commands(program);
  std::sort(commands.begin() + 1, commands.end(),
            [](const CommandEntry* a, const CommandEntry* b) { return a->path < b->path; });
  for (const CommandEntry* command : commands) {
    if (command != &program) text += section(*command);
  }
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

}  // namespace saccade::cli

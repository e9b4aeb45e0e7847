// SPDX-License-Identifier: Apache-2.0
// Completion in zsh: a function per command, which hands what it takes to _arguments.
#include <cstddef>

#include "command_tree.hpp"
#include "saccade/core/names.hpp"

namespace saccade::cli {
namespace {

/// Text within single quotes; brackets and colons, which _arguments reads, mean nothing.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else if (c == '\n') {
      out += ' ';
    } else {
      if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
      out += c;
    }
  }
  return out;
}

std::string zsh_action(ValueKind kind, const std::vector<std::string>& words) {
  switch (kind) {
    case ValueKind::word: return std::string{"("}.append(joined(words, " ")).append(")");
    case ValueKind::folder: return "_files -/";
    case ValueKind::file: return "_files";
    case ValueKind::text: break;
  }
  return " ";
}

std::string option_specs(const OptionEntry& option) {
  std::string specs;
  const std::string all_names = std::string{"("}.append(joined(option.names, " ")).append(")");
  for (const std::string& name : option.names) {
    specs +=
        " \\\n    '" + std::string{option.repeats ? "*" : all_names} + name + "[" + zsh_text(option.description) + "]";
    if (!option.value.empty()) specs += ":" + zsh_text(option.value) + ":" + zsh_action(option.kind, option.words);
    specs += "'";
  }
  return specs;
}

std::string argument_specs(const std::vector<ArgumentEntry>& arguments) {
  std::string specs;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const ArgumentEntry& argument = arguments[i];
    const std::string place = argument.repeats ? "*" : std::to_string(i + 1);
    const std::string action = argument.kind == ValueKind::text ? " " : "_files";
    specs += " \\\n    '" + place + ":" + zsh_text(argument.name) + ":" + action + "'";
  }
  return specs;
}

/// The function of a command that has commands of its own describes these, then calls the one that was chosen.
std::string command_choice(const CommandEntry& command) {
  std::string text{"  case \"$state\" in\n    command)\n      local -a commands=("};
  for (const CommandEntry& below : command.commands) {
    text += "\n        '" + below.name() + ":" + zsh_text(below.description) + "'";
  }
  text += ")\n      _describe -t commands command commands\n      ;;\n    rest)\n      case \"$line[1]\" in\n";
  for (const CommandEntry& below : command.commands) {
    text += "        " + below.name() + ") _" + below.path_with("_") + " ;;\n";
  }
  return text + "      esac\n      ;;\n  esac\n";
}

/// Global options may stand behind any command.
std::string command_function(const CommandEntry& program, const CommandEntry& command) {
  std::string text =
      "_" + command.path_with("_") + "() {\n  local context state line\n  typeset -A opt_args\n  _arguments -s";
  if (!command.commands.empty()) text += " -C";
  for (const OptionEntry& option : command.options) text += option_specs(option);
  if (&command != &program) {
    for (const OptionEntry& option : program.options) {
      if (option.names.back() != "--help" && option.names.back() != "--version") text += option_specs(option);
    }
  }
  if (command.commands.empty()) return text + argument_specs(command.arguments) + "\n}\n";
  return text + " \\\n    '1:command:->command' \\\n    '*::argument:->rest'\n" + command_choice(command) + "}\n";
}

}  // namespace

std::string zsh_completion(const CommandEntry& program) {
  std::string text{
      "#compdef saccade\n# SPDX-License-Identifier: Apache-2.0\n# Completion of saccade in zsh, made by saccade "
      "generate zsh.\n"};
  for (const CommandEntry* command : all_commands(program)) {
    if (command != &program) text += command_function(program, *command);
  }
  text += command_function(program, program);
  return text + "if [ \"$funcstack[1]\" = _saccade ]; then _saccade \"$@\"; else compdef _saccade saccade; fi\n";
}

}  // namespace saccade::cli

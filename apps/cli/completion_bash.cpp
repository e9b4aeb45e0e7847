// SPDX-License-Identifier: Apache-2.0
// Completion in bash: two tables, of commands and of values, and a function that finds its way through them.
#include "command_tree.hpp"
#include "saccade/core/names.hpp"

namespace saccade::cli {
namespace {

/// $1 is the path of a command. `options` and `commands` are its words; what `valued` lists takes a value.
std::string command_table(const std::vector<const CommandEntry*>& commands) {
  std::string text{"_saccade_command() {\n  case \"$1\" in\n"};
  for (const CommandEntry* command : commands) {
    std::vector<std::string> options;
    std::vector<std::string> valued;
    for (const OptionEntry& option : command->options) {
      options.insert(options.end(), option.names.begin(), option.names.end());
      if (!option.value.empty()) valued.insert(valued.end(), option.names.begin(), option.names.end());
    }
    text += "    '" + command->path_with(" ") + "')\n      commands='" +
            joined(command->commands, " ", [](const CommandEntry& below) { return below.name(); }) +
            "'\n      options+=' " + joined(options, " ") + "'\n      valued+=' " + joined(valued, " ") +
            "'\n      ;;\n";
  }
  return text + "  esac\n}\n";
}

/// $1 is a command and $2 its option. Prints the words that are its values; `<folder>`, `<file>` for names of these.
std::string value_table(const std::vector<const CommandEntry*>& commands) {
  std::string text{"_saccade_values() {\n  case \"$1 $2\" in\n"};
  for (const CommandEntry* command : commands) {
    for (const OptionEntry& option : command->options) {
      if (option.value.empty() || option.kind == ValueKind::text) continue;
      std::string pattern;
      for (const std::string& name : option.names) {
        if (!pattern.empty()) pattern += '|';
        pattern.append("'").append(command->path_with(" ")).append(" ").append(name).append("'");
      }
      const std::string values = option.kind == ValueKind::word     ? joined(option.words, " ")
                                 : option.kind == ValueKind::folder ? std::string{"<folder>"}
                                                                    : std::string{"<file>"};
      text += "    " + pattern + ") echo '" + values + "' ;;\n";
    }
  }
  return text + "  esac\n}\n";
}

/// Goes through the words before the cursor, command by command, and completes the last by what stands before it.
constexpr const char* kFunction{R"bash(
_saccade() {
  local word option='' path='saccade' commands='' options='' valued='' known='' values=''
  local current="${COMP_WORDS[COMP_CWORD]}"
  COMPREPLY=()
  _saccade_command "$path"
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ -n $option ]]; then
      option=''
    elif [[ $word == -* ]]; then
      if [[ " $valued " == *" $word "* ]]; then option="$word"; fi
    elif [[ -n $word && " $commands " == *" $word "* ]]; then
      path="$path $word"
      commands=''
      _saccade_command "$path"
    fi
  done
  if [[ -n $option ]]; then
    known="$path"
    while values="$(_saccade_values "$known" "$option")" && [[ -z $values && $known == *' '* ]]; do known="${known% *}"; done
    case "$values" in
      '<folder>') compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- "$current") ;;
      '<file>') compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- "$current") ;;
      ?*) mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current") ;;
    esac
  elif [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  elif [[ -n $commands ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}
complete -F _saccade saccade
)bash"};

}  // namespace

std::string bash_completion(const CommandEntry& program) {
  const std::vector<const CommandEntry*> commands = all_commands(program);
  return "# SPDX-License-Identifier: Apache-2.0\n# Completion of saccade in bash, made by saccade generate bash.\n" +
         command_table(commands) + value_table(commands) + kFunction;
}

}  // namespace saccade::cli

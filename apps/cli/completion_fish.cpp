// SPDX-License-Identifier: Apache-2.0
// Completion in fish: one line per command and option, each for the place where it may stand.
#include "command_tree.hpp"
#include "saccade/core/names.hpp"

namespace saccade::cli {
namespace {

std::string fish_text(const std::string& text) {
  std::string out{"'"};
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out + "'";
}

/// __saccade_at PATH: whether the words before the cursor lead to that command.
std::string place_function(const std::vector<const CommandEntry*>& commands) {
  std::vector<std::string> valued;
  std::vector<std::string> paths;
  for (const CommandEntry* command : commands) {
    paths.push_back(fish_text(command->path_with(" ")));
    for (const OptionEntry& option : command->options) {
      if (option.value.empty()) continue;
      for (const std::string& name : option.names) valued.push_back(fish_text(command->path_with(" ") + " " + name));
    }
  }
  return "set -g __saccade_paths " + joined(paths, " ") + "\nset -g __saccade_valued " + joined(valued, " ") + R"fish(
function __saccade_at
    set -l path saccade
    set -l skip 0
    set -l words (commandline -opc)
    for word in $words[2..-1]
        if test $skip = 1
            set skip 0
        else if string match -q -- '-*' $word
            if contains -- "$path $word" $__saccade_valued; or contains -- "saccade $word" $__saccade_valued
                set skip 1
            end
        else if contains -- "$path $word" $__saccade_paths
            set path "$path $word"
        end
    end
    test "$path" = "$argv[1]"
end
)fish";
}

std::string option_line(const CommandEntry& program, const CommandEntry& command, const OptionEntry& option) {
  std::string line{"complete -c saccade"};
  if (&command != &program) line += " -n " + fish_text("__saccade_at '" + command.path_with(" ") + "'");
  for (const std::string& name : option.names) {
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  switch (option.value.empty() ? ValueKind::text : option.kind) {
    case ValueKind::word: line += " -x -a " + fish_text(joined(option.words, " ")); break;
    case ValueKind::folder: line += " -x -a '(__fish_complete_directories)'"; break;
    case ValueKind::file: line += " -r -F"; break;
    case ValueKind::text: line += option.value.empty() ? "" : " -x"; break;
  }
  return line + " -d " + fish_text(option.description) + "\n";
}

}  // namespace

std::string fish_completion(const CommandEntry& program) {
  const std::vector<const CommandEntry*> commands = all_commands(program);
  std::string text{
      "# SPDX-License-Identifier: Apache-2.0\n# Completion of saccade in fish, made by saccade generate fish.\n"};
  text += place_function(commands);
  for (const CommandEntry* command : commands) {
    const std::string place = fish_text("__saccade_at '" + command->path_with(" ") + "'");
    for (const CommandEntry& below : command->commands) {
      text +=
          "complete -c saccade -n " + place + " -f -a " + below.name() + " -d " + fish_text(below.description) + "\n";
    }
    for (const OptionEntry& option : command->options) text += option_line(program, *command, option);
  }
  return text;
}

}  // namespace saccade::cli

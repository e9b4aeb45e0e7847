// SPDX-License-Identifier: Apache-2.0
#pragma once
// CommandEntry, OptionEntry, ArgumentEntry: what the program takes, read off its CLI::App, for manual pages and
// completion. manual_pages, markdown_reference, bash_completion, zsh_completion, fish_completion: texts made of them.

#include <map>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace saccade::cli {

/// How the value of an option or argument may be completed.
enum class ValueKind { file, folder, word, text };

struct OptionEntry {
  std::vector<std::string> names;  ///< "-q", "--quiet"
  std::string value;               ///< "FILE", "a|b"; empty for flags
  ValueKind kind{ValueKind::text};
  std::vector<std::string> words;  ///< values, where there are but a few
  std::string preset;              ///< default value, or empty
  std::string range;               ///< "0 to 12", or empty
  std::string description;
  std::string group;  ///< heading in the help
  bool required{false};
  bool repeats{false};
};

struct ArgumentEntry {
  std::string name;
  std::string value;
  ValueKind kind{ValueKind::text};
  std::string description;
  bool required{false};
  bool repeats{false};
};

struct CommandEntry {
  std::vector<std::string> path;  ///< "saccade", "robot", "check"
  std::string description;
  std::string footer;
  std::vector<OptionEntry> options;
  std::vector<ArgumentEntry> arguments;
  std::vector<CommandEntry> commands;

  [[nodiscard]] const std::string& name() const { return path.back(); }
  /// The names of the path in a row: "saccade robot check" for " ".
  [[nodiscard]] std::string path_with(const std::string& separator) const;
};

/// The value of an option, for people.
struct ValueText {
  std::string placeholder;  ///< "METRES", "a|b"
  std::string range;        ///< "0 to 12", or empty
};
/// Long names of an option without the dashes. Those after the first are old names, which are read and not shown; of a
/// switch, all are shown.
[[nodiscard]] std::vector<std::string> shown_names(const CLI::Option& option);
[[nodiscard]] ValueText value_text(const CLI::Option& option);

/// Reads the program and all its commands; hidden ones are left out.
[[nodiscard]] CommandEntry command_tree(const CLI::App& program);

/// Lists a command and all below it, each before its own.
[[nodiscard]] std::vector<const CommandEntry*> all_commands(const CommandEntry& program);

/// Makes the manual pages, one per command: file name → text in the macros of man(7).
/// @param version  stands in the foot of each page
/// @param date     YYYY-MM-DD
[[nodiscard]] std::map<std::string, std::string> manual_pages(const CommandEntry& program, const std::string& version,
                                                              const std::string& date);

/// Makes docs/reference/cli.md.
[[nodiscard]] std::string markdown_reference(const CommandEntry& program);

[[nodiscard]] std::string bash_completion(const CommandEntry& program);
[[nodiscard]] std::string zsh_completion(const CommandEntry& program);
[[nodiscard]] std::string fish_completion(const CommandEntry& program);

}  // namespace saccade::cli

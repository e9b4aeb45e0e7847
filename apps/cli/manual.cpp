// SPDX-License-Identifier: Apache-2.0
// Manual pages in the macros of man(7).
#include <algorithm>
#include <cctype>

#include "command_tree.hpp"
#include "saccade/core/names.hpp"

namespace saccade::cli {
namespace {

/// Text as roff takes it: backslashes and leading dots mean nothing.
std::string roff(const std::string& text) {
  std::string out;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else {
      out += c;
    }
    line_begins = c == '\n';
  }
  return out;
}

/// What is typed as it stands: its hyphens are minus signs.
std::string literal(const std::string& text) {
  std::string out;
  for (const char c : roff(text)) {
    if (c == '-') out += '\\';
    out += c;
  }
  return out;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string page_name(const CommandEntry& command) { return command.path_with("-"); }

std::string bold(const std::string& text) { return "\\fB" + literal(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + literal(text) + "\\fR"; }

std::string paragraph(const OptionEntry& option) {
  std::string head = joined(option.names, ", ", bold);
  if (!option.value.empty()) head += " " + italic(option.value);
  std::vector<std::string> more;
  if (option.required) more.emplace_back("required");
  if (!option.preset.empty()) more.push_back("default: " + option.preset);
  if (!option.range.empty()) more.push_back(option.range);
  if (option.repeats) more.emplace_back("may be repeated");
  std::string body = option.description;
  if (!more.empty()) body += " (" + joined(more, "; ") + ")";
  return ".TP\n" + head + "\n" + roff(body) + "\n";
}

std::string synopsis(const CommandEntry& command) {
  std::string text = ".B " + literal(command.path_with(" ")) + "\n";
  text += "[" + italic("OPTIONS") + "]";
  if (!command.commands.empty()) text += " " + italic("COMMAND") + " ...";
  for (const ArgumentEntry& argument : command.arguments) {
    const std::string name = italic(argument.name) + (argument.repeats ? " ..." : "");
    text += argument.required ? " " + name : " [" + name + "]";
  }
  return text + "\n";
}

std::string arguments_section(const CommandEntry& command) {
  std::string text;
  for (const ArgumentEntry& argument : command.arguments) {
    text +=
        ".TP\n" + italic(argument.name) + " (" + literal(argument.value) + ")\n" + roff(argument.description) + "\n";
  }
  return text.empty() ? text : ".SH ARGUMENTS\n" + text;
}

/// Options under the headings that the help has, the headings in the order in which they come.
std::string options_section(const CommandEntry& command) {
  std::vector<std::string> groups;
  for (const OptionEntry& option : command.options) {
    if (std::find(groups.begin(), groups.end(), option.group) == groups.end()) groups.push_back(option.group);
  }
  std::string text{".SH OPTIONS\n"};
  for (const std::string& group : groups) {
    if (group != "Options") text += ".SS \"" + roff(group) + "\"\n";
    for (const OptionEntry& option : command.options) {
      if (option.group == group) text += paragraph(option);
    }
  }
  return text;
}

std::string commands_section(const CommandEntry& command) {
  std::string text;
  for (const CommandEntry& below : command.commands) {
    text += ".TP\n.BR " + literal(page_name(below)) + " (1)\n" + roff(below.description) + "\n";
  }
  return text.empty() ? text : ".SH COMMANDS\n" + text;
}

std::string notes_section(const std::string& footer) { return ".SH NOTES\n" + roff(footer) + "\n"; }

std::string see_also(const CommandEntry& program, const CommandEntry& command) {
  std::vector<std::string> pages;
  for (const CommandEntry* other : all_commands(program)) {
    const bool nested = other->path.size() > 2 && other->path[1] != (command.path.size() > 1 ? command.path[1] : "");
    if (other != &command && !nested) pages.push_back(page_name(*other));
  }
  std::string text{".SH SEE ALSO\n"};
  for (const std::string& page : pages) text += ".BR " + literal(page) + (page == pages.back() ? " (1)\n" : " (1),\n");
  return text + ".PP\nThe documentation is in\n.IR /usr/share/doc/saccade .\n";
}

}  // namespace

std::map<std::string, std::string> manual_pages(const CommandEntry& program, const std::string& version,
                                                const std::string& date) {
  std::map<std::string, std::string> pages;
  for (const CommandEntry* command : all_commands(program)) {
    std::string text{".\\\" SPDX-License-Identifier: Apache-2.0\n"};
    text += ".TH " + upper(page_name(*command)) + " 1 \"" + date + "\" \"saccade " + version + "\" \"User Commands\"\n";
    text += ".SH NAME\n" + literal(page_name(*command)) + " \\- " + roff(command->description) + "\n";
    text += ".SH SYNOPSIS\n" + synopsis(*command) + commands_section(*command) + arguments_section(*command);
    text += options_section(*command);
    if (command != &program) text += ".PP\nThe options of\n.BR saccade (1)\nmay stand here, too.\n";
    text += notes_section(program.footer) + see_also(program, *command);
    pages[page_name(*command) + ".1"] = text;
  }
  return pages;
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
#include "help_formatter.hpp"

#include <vector>

#include "command_tree.hpp"
#include "saccade/core/names.hpp"

namespace saccade::cli {

std::string range_text(const std::string& checks) {
  if (checks.find("POSITIVE") != std::string::npos) return "above 0";
  if (checks.find("NONNEGATIVE") != std::string::npos) return "0 or more";
  const std::size_t open = checks.find(" in [");
  const std::size_t dash = checks.find(" - ", open);
  const std::size_t close = checks.find(']', dash);
  if (open == std::string::npos || dash == std::string::npos || close == std::string::npos) return {};
  const std::size_t least = open + std::string_view{" in ["}.size();
  const std::size_t most = dash + std::string_view{" - "}.size();
  return checks.substr(least, dash - least) + " to " + checks.substr(most, close - most);
}

std::string HelpFormatter::make_option_name(const CLI::Option* option, bool is_positional) const {
  if (is_positional) return CLI::Formatter::make_option_name(option, is_positional);
  std::string text;
  for (const std::string& name : option->get_snames()) text += (text.empty() ? "-" : ",-") + name;
  for (const std::string& name : shown_names(*option)) text += (text.empty() ? "--" : ",--") + name;
  return text;
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  if (option->get_items_expected_max() == 0) return "";
  const ValueText value = value_text(*option);
  std::string text = " " + value.placeholder;
  std::vector<std::string> notes;
  if (!value.range.empty()) notes.push_back(value.range);
  if (!option->get_default_str().empty()) notes.push_back("default " + option->get_default_str());
  if (option->get_required()) notes.emplace_back("required");
  if (!notes.empty()) text += " (" + joined(notes, "; ") + ")";
  return text;
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once
// add_value: an option that takes a value, its type and its default in the help.

#include <CLI/CLI.hpp>
#include <string>
#include <type_traits>

namespace saccade::cli {

/// Adds an option, or for a name without dashes an argument, that sets `target`. `type` stands for the value in the
/// help, which shows the default of numbers and texts, unless the description says "(default: …)" itself.
template <class T>
CLI::Option* add_value(CLI::App& command, const std::string& option, T& target, const std::string& type,
                       const std::string& description) {
  CLI::Option* added = command.add_option(option, target, description)->type_name(type);
  if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    if (description.find("(default:") == std::string::npos) added->capture_default_str();
  }
  return added;
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once
// Options that are sizes of memory, with a unit: 512MiB, 2GiB.

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

namespace saccade::cli {

/// Parses "N", "NKiB", "NMiB", "NGiB", "NTiB" (1024) and "NkB", "NMB", "NGB", "NTB" (1000), with or without a blank and
/// in any case; N may have decimals. Throws a usage error of the option for any other text, and below one byte.
[[nodiscard]] std::size_t parse_size(const std::string& option, const std::string& text);
/// Adds an option for a size to a std::size_t, or an optional one.
template <typename Size>
CLI::Option* add_size(CLI::App& command, const std::string& option, Size& bytes, const std::string& description) {
  const auto take = [option, &bytes](const std::string& text) { bytes = parse_size(option, text); };
  return command.add_option_function<std::string>(option, take, description)->type_name("SIZE");
}

}  // namespace saccade::cli

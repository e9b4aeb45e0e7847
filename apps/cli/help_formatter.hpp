// SPDX-License-Identifier: Apache-2.0
#pragma once
// HelpFormatter: --help with ranges and defaults in words.

#include <CLI/CLI.hpp>
#include <string>

namespace saccade::cli {

/// Returns what an option's value may be, in words: "INT in [0 - 12]" is "0 to 12"; empty for checks that say nothing.
[[nodiscard]] std::string range_text(const std::string& checks);

class HelpFormatter final : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_option_name(const CLI::Option* option, bool is_positional) const override;
  [[nodiscard]] std::string make_option_opts(const CLI::Option* option) const override;
};

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once
// report_in: the document that a browser reads from a report.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "run_program.hpp"

namespace saccade::test {

/// null where the file holds no page with a document.
inline nlohmann::json report_in(const std::filesystem::path& file) {
  constexpr std::string_view kBegin{R"(<script type="application/json" id="record">)"};
  const std::string page = text_of(file);
  const std::size_t begin = page.find(kBegin);
  if (!page.starts_with("<!doctype html>") || begin == std::string::npos) return nullptr;
  const std::size_t first = begin + kBegin.size();
  return nlohmann::json::parse(page.substr(first, page.find("</script>", first) - first), nullptr, false);
}

}  // namespace saccade::test

// SPDX-License-Identifier: Apache-2.0
#pragma once
// The page's files, as they lie in web/dist, within the program.

#include <cstdint>
#include <span>
#include <string_view>

namespace saccade::server {

struct PageFile {
  std::string_view path;  ///< "index.html", "assets/index-….js"
  std::string_view content_type;
  std::span<const std::uint8_t> content;
};

[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace saccade::server

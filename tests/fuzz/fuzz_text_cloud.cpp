// SPDX-License-Identifier: Apache-2.0
// Feeds the reader of clouds in text, and that of labels in lines. What is accepted must be whole.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "saccade/io/clouds/label_io.hpp"
#include "saccade/io/clouds/text_cloud.hpp"
#include "saccade/io/files/file_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span{data, size});
  const std::string_view text = saccade::as_text(bytes);
  const auto cloud = saccade::parse_text_cloud({bytes.begin(), bytes.end()});
  const bool says_where =
      cloud.ok() || !cloud.error().context.empty() || cloud.error().message.find("no points") != std::string::npos;
  if (!says_where) std::abort();
  if (cloud) {
    const saccade::ColumnTable& table = cloud->table;
    if (table.rows == 0 || table.rows > size || !table.validate()) std::abort();
    for (const char* name : {"x", "y", "z"}) {
      if (table.find(name) == nullptr) std::abort();
    }
    if (cloud->first_row_line <= cloud->header_line || !saccade::looks_like_text_cloud(text)) std::abort();
  }
  const auto labels = saccade::parse_label_lines(text);
  if (!labels && labels.error().context.empty()) std::abort();
  if (labels && labels->bytes.size() > 8 * size) std::abort();
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
// Feeds the PCD reader, and the LZF decompressor by itself; what LZF packs must unpack to the same.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "saccade/io/clouds/internal/lzf.hpp"
#include "saccade/io/clouds/pcd_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span{data, size});
  const auto file = saccade::parse_pcd(bytes);
  if (!file && file.error().context.empty()) std::abort();
  if (file) {
    if (file->width * file->height != file->table.rows) std::abort();
    for (const saccade::Column& column : file->table.columns) {
      if (column.bytes.size() != file->table.rows * column.row_bytes()) std::abort();
    }
  }
  const auto unpacked = saccade::lzf_decompress(bytes, 4 * size);
  if (unpacked && unpacked->size() != 4 * size) std::abort();
  const auto packed = saccade::lzf_compress(bytes);
  const auto again = saccade::lzf_decompress(packed, size);
  if (!again || !std::equal(again->begin(), again->end(), bytes.begin(), bytes.end())) std::abort();
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
// Feeds the PLY reader and the mesh made of what it read.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "saccade/io/clouds/ply_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = saccade::parse_ply(std::as_bytes(std::span{data, size}));
  if (!file) {
    if (file.error().context.empty()) std::abort();
    return 0;
  }
  for (const saccade::PlyElement& element : file->elements) {
    for (const saccade::Column& column : element.table.columns) {
      if (column.bytes.size() != element.table.rows * column.row_bytes()) std::abort();
    }
    for (const saccade::PlyList& list : element.lists) {
      if (list.starts.size() != element.table.rows + 1) std::abort();
    }
  }
  const auto mesh = saccade::mesh_from_ply(*file);
  if (!mesh) return 0;
  for (const auto& triangle : mesh->triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= mesh->vertices.size()) std::abort();
    }
  }
  return 0;
}

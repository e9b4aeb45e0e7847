// SPDX-License-Identifier: Apache-2.0
#pragma once
// Header of a PLY file: parsing and writing. Used by ply_read.cpp and ply_write.cpp.

#include <string>
#include <string_view>

#include "saccade/io/clouds/ply_io.hpp"

namespace saccade {

struct PlyHeader {
  PlyFile file;                ///< elements with their properties and row counts, without values
  std::size_t body_offset{0};  ///< first byte after the header
  std::size_t body_line{1};    ///< number of the line that starts there
};

[[nodiscard]] Result<PlyHeader> parse_ply_header(std::string_view text);
[[nodiscard]] std::string ply_header_text(const PlyFile& file, PlyFormat format);
/// Returns the order of an element's properties: its own, or columns before lists.
[[nodiscard]] std::vector<int> property_order(const PlyElement& element);

}  // namespace saccade

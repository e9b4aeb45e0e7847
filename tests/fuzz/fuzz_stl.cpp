// SPDX-License-Identifier: Apache-2.0
// Feeds the reader of STL.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "saccade/io/clouds/internal/mesh_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto mesh = saccade::parse_stl({reinterpret_cast<const char*>(data), size});
  if (!mesh) return 0;
  for (const auto& triangle : mesh->triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= mesh->vertices.size()) std::abort();
    }
  }
  return 0;
}

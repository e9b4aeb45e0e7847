// SPDX-License-Identifier: Apache-2.0
#pragma once
// parse_stl, parse_obj, parse_off: triangles from the formats that are simple enough to read ourselves.

#include <string_view>

#include "saccade/core/result.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {

/// Reads STL, as text with any number of solids or binary. Vertices with the same coordinates become one; normals and
/// the colours that some programs hide in spare bytes are not read.
/// @return corrupt_data with the line or the number of bytes where the file is cut short, has no triangles, or a
/// coordinate is not finite. O(file).
[[nodiscard]] Result<TriangleMesh> parse_stl(std::string_view file);

/// Reads Wavefront OBJ: v (with colours of 0 … 1 where every vertex has them) and f, indices from the front or the end.
/// Groups, normals, texture coordinates, materials, points and lines are skipped; faces are split as by split_polygon.
/// @return unsupported for free-form curves and surfaces; corrupt_data with the line otherwise. O(file).
[[nodiscard]] Result<TriangleMesh> parse_obj(std::string_view file);

/// Reads the text form of OFF, with what Geomview allows before and behind the coordinates (COFF, NOFF, CNOFF, STOFF),
/// and headers without a break before the counts, as in ModelNet. Only positions and faces are kept.
/// @return unsupported for binary files and for coordinates of other than three dimensions; corrupt_data with the line
/// otherwise, also where lines follow the last face. O(file).
[[nodiscard]] Result<TriangleMesh> parse_off(std::string_view file);

}  // namespace saccade

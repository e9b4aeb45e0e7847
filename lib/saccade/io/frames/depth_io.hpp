// SPDX-License-Identifier: Apache-2.0
#pragma once
// Depth images in files of any format that is read: PNG, PGM, TIFF, NPY, EXR. DepthUnits: what their samples mean, and
// who says so. docs/reference/formats.md.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "saccade/core/names.hpp"
#include "saccade/core/result.hpp"
#include "saccade/io/frames/image_io.hpp"

namespace saccade {

/// Origin of a depth scale.
enum class UnitsSource {
  layout,  ///< usual for the layout of the folder
  files,   ///< a file beside the images says so
  given,   ///< the caller says so
};
inline constexpr auto kUnitsSourceNames = make_names<UnitsSource>(
    {{UnitsSource::layout, "layout"}, {UnitsSource::files, "files"}, {UnitsSource::given, "given"}});
[[nodiscard]] constexpr std::string_view to_string(UnitsSource source) { return kUnitsSourceNames.of(source); }

struct DepthUnits {
  DepthEncoding encoding{};
  UnitsSource source{UnitsSource::layout};
};

/// Decodes a depth image, recognised by its first bytes, to metres along z; 0 where there is no return.
///
/// | format | samples                                                         |
/// |--------|-----------------------------------------------------------------|
/// | PNG    | one channel of 8 or 16 bits                                     |
/// | PGM    | binary or plain, up to 65535                                    |
/// | TIFF   | one channel of 8, 16 or 32 bits, or floats; one image, no tiles |
/// | NPY    | integers or floats, (height, width) or (height, width, 1)       |
/// | EXR    | floats or half floats: the only channel, Z, depth or V, or equal R, G and B |
///
/// Whole numbers are divided by the scale. Samples of 8 bits have no usual scale: it must come from files or the
/// caller. Floats are metres, unless the caller gives a scale. Floats that are not finite or not positive are no
/// return, as are negative numbers and the largest number of 16 bits.
/// @return corrupt_data for a damaged file; unsupported for other formats and kinds of pixels, with what to do;
///         invalid_argument for 8 bits without a scale. O(pixels). Safe to call concurrently; prints nothing.
[[nodiscard]] Result<DepthImage> decode_depth_image(std::span<const std::byte> file, const DepthUnits& scale);
/// Reads such an image; the error's context starts with the path.
[[nodiscard]] Result<DepthImage> read_depth_image(const std::filesystem::path& path, const DepthUnits& scale);

}  // namespace saccade

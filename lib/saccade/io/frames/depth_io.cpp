// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/depth_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/npy_io.hpp"
#include "saccade/io/frames/internal/sample_image.hpp"

namespace saccade {
namespace {

constexpr std::uintmax_t kMaxDepthFileBytes{std::uintmax_t{1} << 30U};
constexpr float kSaturated16{65535.0F};

bool starts_with(std::span<const std::byte> file, std::string_view magic) { return as_text(file).starts_with(magic); }

/// Formats that people keep depth in and that are not read, by their first bytes.
struct UnreadFormat {
  std::string_view magic;
  const char* advice;
};
constexpr std::array<UnreadFormat, 4> kUnreadFormats{
    {{"\xff\xd8\xff", "a JPEG, which cannot hold depths; look for PNG, TIFF, PGM or NPY of 16 bits or floats"},
     {"PK\x03\x04", "a ZIP or NPZ archive; write each image as a .npy of its own: numpy.save"},
     {"\x89HDF", "an HDF5 file; write each image as a .npy of its own: numpy.save"},
     {"Pf", "a PFM image; convert it to floats in TIFF: oiiotool IN.pfm -d float -o OUT.tif"}}};

Result<DepthImage> to_metres(const SampleImage& image, const DepthUnits& scale) {
  if (image.channels != 1) {
    return Error{Errc::unsupported,
                 "a picture of " + std::to_string(image.channels) +
                     " channels; depth needs one channel. Depths drawn in colours cannot be read back",
                 {}};
  }
  if (image.kind == SampleKind::whole8 && scale.source == UnitsSource::layout) {
    return Error{Errc::invalid_argument,
                 "depths of 8 bits, and nothing here says how many make a metre; pass --depth-scale N",
                 {}};
  }
  const bool is_metric = image.kind == SampleKind::real && scale.source != UnitsSource::given;
  const float units_per_m = is_metric ? 1.0F : static_cast<float>(scale.encoding.units_per_m);
  DepthImage depth{image.width, image.height};
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const float sample = image.values[i];
    const bool is_saturated = image.kind == SampleKind::whole16 && sample == kSaturated16;
    depth.data()[i] = std::isfinite(sample) && sample > 0.0F && !is_saturated ? sample / units_per_m : 0.0F;
  }
  return depth;
}

Result<DepthImage> depth_from_png(std::span<const std::byte> file, const DepthUnits& scale) {
  SACCADE_TRY(const PngPixels png, decode_png(file));
  if (png.sample_bits == 16 && png.channels == 1) {
    Image16 samples{png.width, png.height};
    std::memcpy(samples.data(), png.bytes.data(), png.bytes.size());
    return decode_depth(samples, scale.encoding);
  }
  SampleImage image{png.width, png.height, png.channels, SampleKind::whole8, {}};
  if (png.sample_bits == 8) image.values.assign(png.bytes.begin(), png.bytes.end());
  return to_metres(image, scale);
}

/// Appends numbers of type T, in file order.
template <class T>
void append_numbers(std::span<const std::byte> bytes, std::vector<float>& values) {
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    T value{};
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    values.push_back(static_cast<float>(value));
  }
}

struct NpyType {
  std::string_view name;
  std::size_t bytes;
  SampleKind kind;
  void (*append)(std::span<const std::byte>, std::vector<float>&);
};
constexpr std::array<NpyType, 10> kNpyTypes{{{"u1", 1, SampleKind::whole8, append_numbers<std::uint8_t>},
                                             {"i1", 1, SampleKind::whole8, append_numbers<std::int8_t>},
                                             {"u2", 2, SampleKind::whole16, append_numbers<std::uint16_t>},
                                             {"i2", 2, SampleKind::whole16, append_numbers<std::int16_t>},
                                             {"u4", 4, SampleKind::whole32, append_numbers<std::uint32_t>},
                                             {"i4", 4, SampleKind::whole32, append_numbers<std::int32_t>},
                                             {"u8", 8, SampleKind::whole32, append_numbers<std::uint64_t>},
                                             {"i8", 8, SampleKind::whole32, append_numbers<std::int64_t>},
                                             {"f4", 4, SampleKind::real, append_numbers<float>},
                                             {"f8", 8, SampleKind::real, append_numbers<double>}}};

std::vector<float> rows_first(const std::vector<float>& columns, std::size_t width, std::size_t height) {
  std::vector<float> rows;
  rows.reserve(columns.size());
  for (std::size_t v = 0; v < height; ++v) {
    for (std::size_t u = 0; u < width; ++u) rows.push_back(columns[u * height + v]);
  }
  return rows;
}

}  // namespace

bool is_npy(std::span<const std::byte> file) { return starts_with(file, "\x93NUMPY"); }

Result<SampleImage> decode_npy_image(std::span<const std::byte> file) {
  SACCADE_TRY(const NpyArray array, parse_npy_array(file));
  const bool is_image = array.shape.size() == 2 || (array.shape.size() == 3 && array.shape[2] == 1);
  if (!is_image) {
    return Error{Errc::unsupported,
                 "an array of shape (" +
                     joined(array.shape, ", ", [](std::size_t edge) { return std::to_string(edge); }) +
                     "); a depth image has the shape (height, width)",
                 {}};
  }
  const std::size_t height = array.shape[0];
  const std::size_t width = array.shape[1];
  SACCADE_CHECK(check_edges(width, height));
  const std::string_view name = array.type;
  const bool is_little = name.size() == 3 && std::string_view{"<|="}.find(name[0]) != std::string_view::npos;
  const auto* type = std::find_if(kNpyTypes.begin(), kNpyTypes.end(),
                                  [&](const NpyType& known) { return is_little && known.name == name.substr(1); });
  if (type == kNpyTypes.end()) {
    return Error{Errc::unsupported,
                 "an array of another type than integers and floats (<u2, <f4 ...); convert it: array.astype('<f4')",
                 {}};
  }
  if (array.bytes.size() != width * height * type->bytes) {
    return Error{Errc::corrupt_data, "the array's bytes are fewer or more than its shape says",
                 "byte " + std::to_string(array.offset)};
  }
  SampleImage image{static_cast<int>(width), static_cast<int>(height), 1, type->kind, {}};
  image.values.reserve(width * height);
  type->append(array.bytes, image.values);
  if (array.is_fortran) image.values = rows_first(image.values, width, height);
  return image;
}

Result<DepthImage> decode_depth_image(std::span<const std::byte> file, const DepthUnits& scale) {
  SACCADE_CHECK(scale.encoding.validate());
  const auto decode = [&](auto decoder) -> Result<DepthImage> {
    SACCADE_TRY(const SampleImage image, decoder(file));
    if (scale.encoding.bit_rotated) {
      return Error{Errc::unsupported, "bit-rotated depths are read from PNG alone", {}};
    }
    return to_metres(image, scale);
  };
  if (is_pnm(file)) return decode(decode_pnm);
  if (is_tiff(file)) return decode(decode_tiff);
  if (is_npy(file)) return decode(decode_npy_image);
  if (is_exr(file)) return decode(decode_exr);
  for (const UnreadFormat& format : kUnreadFormats) {
    if (starts_with(file, format.magic)) return Error{Errc::unsupported, format.advice, {}};
  }
  auto depth = depth_from_png(file, scale);
  if (depth || depth.error().message != "not a PNG file") return depth;
  return Error{Errc::corrupt_data, "neither PNG, TIFF, PGM, NPY nor EXR", "byte 0"};
}

Result<DepthImage> read_depth_image(const std::filesystem::path& path, const DepthUnits& scale) {
  SACCADE_TRY(const auto bytes, read_file(path, kMaxDepthFileBytes));
  return in_file(decode_depth_image(bytes, scale), path);
}

}  // namespace saccade

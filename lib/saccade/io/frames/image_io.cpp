// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/image_io.hpp"

#include <turbojpeg.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/internal/sample_image.hpp"

namespace saccade {
namespace {

constexpr std::uintmax_t kMaxImageFileBytes{std::uintmax_t{1} << 30U};
/// Largest number of JPEG pixels per byte: each 8×8 block of each channel takes at least one bit.
constexpr std::uint64_t kMaxJpegPixelsPerByte{1024};

Error with_path(Error error, const std::filesystem::path& path) {
  error.context = error.context.empty() ? path.string() : path.string() + ", " + error.context;
  return error;
}

template <class Decoder>
auto read_with(const std::filesystem::path& path, Decoder decode)
    -> std::invoke_result_t<Decoder, std::span<std::byte>> {
  SACCADE_TRY(const auto bytes, read_file(path, kMaxImageFileBytes));
  auto image = decode(std::span<const std::byte>{bytes});
  if (!image) return with_path(image.error(), path);
  return image;
}

/// Returns the 8-bit value of sample c of pixel i.
std::uint8_t sample8(const PngPixels& png, std::size_t i, std::size_t c) {
  const std::size_t sample = i * static_cast<std::size_t>(png.channels) + c;
  if (png.sample_bits == 8) return png.bytes[sample];
  std::uint16_t value = 0;
  std::memcpy(&value, &png.bytes[2 * sample], 2);
  return static_cast<std::uint8_t>(value >> 8U);
}

ColorImage color_from_png(const PngPixels& png) {
  ColorImage image{png.width, png.height};
  if (png.channels == 3 && png.sample_bits == 8) {
    std::memcpy(image.data(), png.bytes.data(), png.bytes.size());
    return image;
  }
  const bool grey = png.channels < 3;
  for (std::size_t i = 0; i < image.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) image.data()[i][c] = sample8(png, i, grey ? 0 : c);
  }
  return image;
}

Result<ColorImage> color_from_samples(const Result<SampleImage>& decoded) {
  if (!decoded) return decoded.error();
  const bool is_whole = decoded->kind == SampleKind::whole8 || decoded->kind == SampleKind::whole16;
  if (!is_whole) return Error{Errc::unsupported, "colours of 8 or 16 bits are needed", {}};
  ColorImage image{decoded->width, decoded->height};
  const auto channels = static_cast<std::size_t>(decoded->channels);
  const unsigned shift = decoded->kind == SampleKind::whole8 ? 0U : 8U;
  for (std::size_t i = 0; i < image.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto sample = static_cast<unsigned>(decoded->values[i * channels + (channels < 3 ? 0 : c)]);
      image.data()[i][c] = static_cast<std::uint8_t>(sample >> shift);
    }
  }
  return image;
}

bool is_jpeg(std::span<const std::byte> file) {
  return file.size() >= 4 && file[0] == std::byte{0xFF} && file[1] == std::byte{0xD8};
}

bool has_end_of_image(std::span<const std::byte> file) {
  for (std::size_t i = file.size() - 1; i > 2; --i) {
    if (file[i] == std::byte{0xD9} && file[i - 1] == std::byte{0xFF}) return true;
  }
  return false;
}

Result<ColorImage> decode_jpeg(std::span<const std::byte> file) {
  const auto damaged = [](const char* what) {
    return Error{Errc::corrupt_data, std::string{"corrupt or truncated JPEG: "} + what, {}};
  };
  if (!has_end_of_image(file)) return damaged("it ends without its end marker");
  struct Closer {
    void operator()(void* handle) const { tjDestroy(handle); }
  };
  const std::unique_ptr<void, Closer> handle{tjInitDecompress()};
  if (!handle) return Error{Errc::unavailable, "the JPEG decoder could not start", {}};
  const auto* data = reinterpret_cast<const unsigned char*>(file.data());
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int colorspace = 0;
  if (tjDecompressHeader3(handle.get(), data, file.size(), &width, &height, &subsampling, &colorspace) != 0) {
    return damaged(tjGetErrorStr2(handle.get()));
  }
  if (width <= 0 || height <= 0) return damaged("zero size");
  if (width > kMaxImageEdge || height > kMaxImageEdge) {
    return Error{Errc::unsupported, "JPEG is larger than " + std::to_string(kMaxImageEdge) + " pixels a side", {}};
  }
  if (colorspace == TJCS_CMYK || colorspace == TJCS_YCCK) {
    return Error{Errc::unsupported, "CMYK JPEG; convert it to RGB", {}};
  }
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (pixels > kMaxJpegPixelsPerByte * file.size()) return damaged("too few bytes for its size");
  ColorImage image{width, height};
  const int flags = TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS;
  if (tjDecompress2(handle.get(), data, file.size(), image.data()->data(), width, 0, height, TJPF_RGB, flags) != 0) {
    return damaged(tjGetErrorStr2(handle.get()));
  }
  return image;
}

template <class Pixel>
Status write_pixels(const std::filesystem::path& path, const Image<Pixel>& image, int channels, int sample_bits) {
  if (image.empty()) return Error{Errc::invalid_argument, "an image without pixels cannot be written", path.string()};
  PngPixels png{image.width(), image.height(), channels, sample_bits, {}};
  png.bytes.resize(image.size() * sizeof(Pixel));
  std::memcpy(png.bytes.data(), image.data(), png.bytes.size());
  const auto file = encode_png(png);
  if (!file) return with_path(file.error(), path);
  return write_file_atomically(path, *file);
}

}  // namespace

Result<Image16> decode_png16(std::span<const std::byte> file) {
  SACCADE_TRY(const PngPixels png, decode_png(file));
  if (png.channels != 1 || png.sample_bits != 16) {
    return Error{Errc::unsupported,
                 "a PNG with one 16-bit channel is needed, not " + std::to_string(png.channels) + " of " +
                     std::to_string(png.sample_bits) + " bits",
                 {}};
  }
  Image16 image{png.width, png.height};
  std::memcpy(image.data(), png.bytes.data(), png.bytes.size());
  return image;
}

Result<ColorImage> decode_color(std::span<const std::byte> file) {
  if (is_jpeg(file)) return decode_jpeg(file);
  if (is_pnm(file)) return color_from_samples(decode_pnm(file));
  if (is_tiff(file)) return color_from_samples(decode_tiff(file));
  auto png = decode_png(file);
  if (png) return color_from_png(*png);
  Error error = png.error();
  if (error.message == "not a PNG file") error.message = "neither PNG, JPEG, PPM nor TIFF";
  return error;
}

Result<MaskImage> decode_mask(std::span<const std::byte> file) {
  SACCADE_TRY(const PngPixels png, decode_png(file));
  MaskImage mask{png.width, png.height};
  const auto counted = static_cast<std::size_t>(png.channels >= 3 ? 3 : 1);  // alpha says nothing
  for (std::size_t i = 0; i < mask.size(); ++i) {
    bool used = false;
    for (std::size_t c = 0; c < counted; ++c) used = used || sample8(png, i, c) != 0;
    mask.data()[i] = used ? 255 : 0;
  }
  return mask;
}

Result<Image16> read_png16(const std::filesystem::path& path) { return read_with(path, decode_png16); }
Result<ColorImage> read_color(const std::filesystem::path& path) { return read_with(path, decode_color); }
Result<MaskImage> read_mask(const std::filesystem::path& path) { return read_with(path, decode_mask); }

Result<PngSize> read_png_size(const std::filesystem::path& path) { return read_with(path, png_size); }

Status write_png16(const std::filesystem::path& path, const Image16& image) { return write_pixels(path, image, 1, 16); }
Status write_png(const std::filesystem::path& path, const ColorImage& image) { return write_pixels(path, image, 3, 8); }
Status write_png(const std::filesystem::path& path, const MaskImage& image) { return write_pixels(path, image, 1, 8); }

}  // namespace saccade

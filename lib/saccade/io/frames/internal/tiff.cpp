// SPDX-License-Identifier: Apache-2.0
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "saccade/io/frames/internal/sample_image.hpp"

namespace saccade {
namespace {

/// No compression that is read expands data further.
constexpr std::uint64_t kMaxTiffExpansion{4096};
constexpr tmsize_t kMaxTiffAllocation{tmsize_t{1} << 30U};

/// Bytes that libtiff reads as a file, and its first complaint.
struct TiffMemory {
  std::span<const std::byte> file;
  std::uint64_t offset{0};
  std::array<char, 200> complaint{};
};

tmsize_t read_bytes(thandle_t handle, void* out, tmsize_t size) {
  auto& memory = *static_cast<TiffMemory*>(handle);
  const std::uint64_t left = memory.file.size() - std::min<std::uint64_t>(memory.offset, memory.file.size());
  const std::uint64_t count = std::min(left, static_cast<std::uint64_t>(std::max<tmsize_t>(size, 0)));
  if (count > 0) std::memcpy(out, memory.file.data() + memory.offset, count);
  memory.offset += count;
  return static_cast<tmsize_t>(count);
}

tmsize_t refuse_bytes(thandle_t /*handle*/, void* /*bytes*/, tmsize_t /*size*/) { return 0; }

toff_t seek_bytes(thandle_t handle, toff_t offset, int whence) {
  auto& memory = *static_cast<TiffMemory*>(handle);
  const std::uint64_t base = whence == SEEK_CUR ? memory.offset : whence == SEEK_END ? memory.file.size() : 0;
  memory.offset = base + offset;
  return memory.offset;
}

int close_bytes(thandle_t /*handle*/) { return 0; }
toff_t size_of_bytes(thandle_t handle) { return static_cast<TiffMemory*>(handle)->file.size(); }

int keep_complaint(TIFF* /*tiff*/, void* user, const char* /*module*/, const char* format, va_list values) {
  auto& memory = *static_cast<TiffMemory*>(user);
  if (memory.complaint[0] == '\0') std::vsnprintf(memory.complaint.data(), memory.complaint.size(), format, values);
  return 1;
}

/// Keeps a warning that sizes of strips are made up. Unknown tags and the like do not change a sample.
int judge_warning(TIFF* tiff, void* user, const char* module, const char* format, va_list values) {
  if (std::strstr(format, "calculating from imagelength") == nullptr) return 1;
  return keep_complaint(tiff, user, module, format, values);
}

struct TiffCloser {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};

Error tiff_fault(const TiffMemory& memory) {
  const std::string why = memory.complaint[0] != '\0' ? memory.complaint.data() : "it ends too early";
  return {Errc::corrupt_data, "corrupt or truncated TIFF: " + why, {}};
}

Error tiff_refusal(std::string what) { return {Errc::unsupported, std::move(what), {}}; }

struct TiffLayout {
  std::uint32_t width{0};
  std::uint32_t height{0};
  std::uint16_t channels{1};
  std::uint16_t bits{1};
  std::uint16_t format{SAMPLEFORMAT_UINT};
};

Result<TiffLayout> read_layout(TIFF* tiff, const TiffMemory& memory) {
  TiffLayout layout;
  std::uint16_t planes = PLANARCONFIG_CONTIG;
  std::uint16_t compression = COMPRESSION_NONE;
  std::uint16_t meaning = PHOTOMETRIC_MINISBLACK;
  if (TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &layout.width) == 0) return tiff_fault(memory);
  if (TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &layout.height) == 0) return tiff_fault(memory);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &layout.channels);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &layout.bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &layout.format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &planes);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &meaning);
  SACCADE_CHECK(check_edges(layout.width, layout.height));
  if (TIFFIsTiled(tiff) != 0) return tiff_refusal("a TIFF of tiles; write it in strips: tiffcp -s IN.tif OUT.tif");
  constexpr std::array<std::uint16_t, 6> kCompressions{COMPRESSION_NONE,     COMPRESSION_LZW,
                                                       COMPRESSION_DEFLATE,  COMPRESSION_ADOBE_DEFLATE,
                                                       COMPRESSION_PACKBITS, COMPRESSION_ZSTD};
  if (std::find(kCompressions.begin(), kCompressions.end(), compression) == kCompressions.end()) {
    return tiff_refusal("a TIFF of compression " + std::to_string(compression) +
                        "; write it without: tiffcp -c none IN.tif OUT.tif");
  }
  if (layout.channels > 1 && planes != PLANARCONFIG_CONTIG) return tiff_refusal("a TIFF of separate colour planes");
  if (layout.channels < 1 || layout.channels > 4) {
    return tiff_refusal("a TIFF of " + std::to_string(layout.channels) + " channels");
  }
  if (meaning != PHOTOMETRIC_MINISBLACK && meaning != PHOTOMETRIC_RGB) {
    return tiff_refusal("a TIFF that is neither grey from black on nor RGB");
  }
  return layout;
}

/// Appends `count` samples of type T. Negative whole numbers become 0.
template <class T>
void append_samples(const std::vector<std::uint8_t>& row, std::size_t count, std::vector<float>& values) {
  for (std::size_t i = 0; i < count; ++i) {
    T value{};
    std::memcpy(&value, row.data() + i * sizeof(T), sizeof(T));
    values.push_back(std::is_floating_point_v<T> || value > T{} ? static_cast<float>(value) : 0.0F);
  }
}

using AppendRow = void (*)(const std::vector<std::uint8_t>&, std::size_t, std::vector<float>&);
struct TiffSamples {
  std::uint16_t format;
  std::uint16_t bits;
  SampleKind kind;
  AppendRow append;
};
constexpr std::array<TiffSamples, 8> kTiffSamples{
    {{SAMPLEFORMAT_UINT, 8, SampleKind::whole8, append_samples<std::uint8_t>},
     {SAMPLEFORMAT_UINT, 16, SampleKind::whole16, append_samples<std::uint16_t>},
     {SAMPLEFORMAT_UINT, 32, SampleKind::whole32, append_samples<std::uint32_t>},
     {SAMPLEFORMAT_INT, 8, SampleKind::whole8, append_samples<std::int8_t>},
     {SAMPLEFORMAT_INT, 16, SampleKind::whole16, append_samples<std::int16_t>},
     {SAMPLEFORMAT_INT, 32, SampleKind::whole32, append_samples<std::int32_t>},
     {SAMPLEFORMAT_IEEEFP, 32, SampleKind::real, append_samples<float>},
     {SAMPLEFORMAT_IEEEFP, 64, SampleKind::real, append_samples<double>}}};

Result<SampleImage> read_samples(TIFF* tiff, const TiffMemory& memory) {
  SACCADE_TRY(const TiffLayout layout, read_layout(tiff, memory));
  const auto* samples = std::find_if(kTiffSamples.begin(), kTiffSamples.end(), [&](const TiffSamples& known) {
    return known.format == layout.format && known.bits == layout.bits;
  });
  if (samples == kTiffSamples.end()) {
    return tiff_refusal("a TIFF with samples of " + std::to_string(layout.bits) +
                        " bits of another kind than 8, 16 and 32 bits and floats");
  }
  SampleImage image{
      static_cast<int>(layout.width), static_cast<int>(layout.height), layout.channels, samples->kind, {}};
  const std::size_t row_samples = std::size_t{layout.width} * layout.channels;
  const std::uint64_t all_bytes = std::uint64_t{row_samples} * (layout.bits / 8U) * layout.height;
  if (all_bytes > kMaxTiffExpansion * memory.file.size()) {
    return Error{Errc::corrupt_data, "corrupt or truncated TIFF: too few bytes for its size", {}};
  }
  std::vector<std::uint8_t> row(std::max<std::size_t>(
      static_cast<std::size_t>(std::max<tmsize_t>(TIFFScanlineSize(tiff), 0)), row_samples * layout.bits / 8U));
  image.values.reserve(row_samples * layout.height);
  for (std::uint32_t v = 0; v < layout.height; ++v) {
    if (TIFFReadScanline(tiff, row.data(), v, 0) != 1 || memory.complaint[0] != '\0') return tiff_fault(memory);
    samples->append(row, row_samples, image.values);
  }
  if (TIFFLastDirectory(tiff) == 0) return tiff_refusal("a TIFF of several images; split it: tiffsplit IN.tif");
  return image;
}

}  // namespace

bool is_tiff(std::span<const std::byte> file) {
  if (file.size() < 8) return false;
  const auto starts = [&](const char* magic) { return std::memcmp(file.data(), magic, 4) == 0; };
  return starts("II*\0") || starts("MM\0*") || starts("II+\0") || starts("MM\0+");
}

Result<SampleImage> decode_tiff(std::span<const std::byte> file) {
  TiffMemory memory{file};
  const std::unique_ptr<TIFFOpenOptions, TiffCloser> options{TIFFOpenOptionsAlloc()};
  if (!options) return Error{Errc::unavailable, "the TIFF decoder could not start", {}};
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMaxTiffAllocation);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_complaint, &memory);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), judge_warning, &memory);
  const std::unique_ptr<TIFF, TiffCloser> tiff{TIFFClientOpenExt("image", "rm", &memory, read_bytes, refuse_bytes,
                                                                 seek_bytes, close_bytes, size_of_bytes, nullptr,
                                                                 nullptr, options.get())};
  if (!tiff) return tiff_fault(memory);
  return read_samples(tiff.get(), memory);
}

}  // namespace saccade

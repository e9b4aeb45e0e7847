// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/png.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <string>

#include "saccade/io/png_filter.hpp"

namespace saccade {
namespace {

constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::size_t kChunkOverhead{12};  // length, type, CRC
/// Deflate cannot expand data more than about 1032-fold.
constexpr std::uint64_t kMaxExpansion{1040};

enum ColorType : std::uint8_t { kGrey = 0, kRgb = 2, kPalette = 3, kGreyAlpha = 4, kRgba = 6 };

struct Header {
  int width{0};
  int height{0};
  int bit_depth{8};
  std::uint8_t color_type{kGrey};
  bool interlaced{false};

  [[nodiscard]] int samples() const {
    switch (color_type) {
      case kRgb: return 3;
      case kGreyAlpha: return 2;
      case kRgba: return 4;
      default: return 1;
    }
  }
  [[nodiscard]] std::size_t row_bytes() const {
    return (static_cast<std::size_t>(width) * static_cast<std::size_t>(samples() * bit_depth) + 7) / 8;
  }
  [[nodiscard]] std::size_t pixel_bytes() const {
    return std::max<std::size_t>(1, static_cast<std::size_t>(samples() * bit_depth) / 8);
  }
};

struct Chunk {
  std::string_view type;
  std::span<const std::uint8_t> data;
  std::size_t offset{0};
};

Error corrupt(std::string what, std::size_t offset) {
  return {Errc::corrupt_data, "corrupt or truncated PNG: " + what, "byte " + std::to_string(offset)};
}

std::uint32_t big_endian(const std::uint8_t* p) {
  return (std::uint32_t{p[0]} << 24U) | (std::uint32_t{p[1]} << 16U) | (std::uint32_t{p[2]} << 8U) | p[3];
}

/// Walks the chunks of a file, checking lengths and CRCs.
class ChunkReader {
 public:
  explicit ChunkReader(std::span<const std::byte> file)
      : bytes_{reinterpret_cast<const std::uint8_t*>(file.data()), file.size()} {}

  [[nodiscard]] Status check_signature() const {
    if (bytes_.size() < kSignature.size() || !std::equal(kSignature.begin(), kSignature.end(), bytes_.begin())) {
      return Error{Errc::corrupt_data, "not a PNG file", "byte 0"};
    }
    return {};
  }
  [[nodiscard]] Result<Chunk> next() {
    if (bytes_.size() - offset_ < kChunkOverhead) return corrupt("it ends without its IEND chunk", bytes_.size());
    const std::size_t length = big_endian(&bytes_[offset_]);
    if (length > bytes_.size() - offset_ - kChunkOverhead) return corrupt("a chunk is cut", offset_);
    const Chunk chunk{
        {reinterpret_cast<const char*>(&bytes_[offset_ + 4]), 4}, bytes_.subspan(offset_ + 8, length), offset_};
    const std::uint32_t crc = libdeflate_crc32(0, &bytes_[offset_ + 4], length + 4);
    if (crc != big_endian(&bytes_[offset_ + 8 + length])) return corrupt("wrong checksum of a chunk", offset_);
    offset_ += length + kChunkOverhead;
    return chunk;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t offset_{kSignature.size()};
};

bool valid_depth(const Header& h) {
  const bool small = h.bit_depth == 1 || h.bit_depth == 2 || h.bit_depth == 4;
  switch (h.color_type) {
    case kGrey: return small || h.bit_depth == 8 || h.bit_depth == 16;
    case kPalette: return small || h.bit_depth == 8;
    case kRgb:
    case kGreyAlpha:
    case kRgba: return h.bit_depth == 8 || h.bit_depth == 16;
    default: return false;
  }
}

Result<Header> read_header(ChunkReader& reader) {
  SACCADE_CHECK(reader.check_signature());
  SACCADE_TRY(const Chunk chunk, reader.next());
  if (chunk.type != "IHDR" || chunk.data.size() != 13) return corrupt("it does not start with IHDR", chunk.offset);
  const std::uint32_t width = big_endian(&chunk.data[0]);
  const std::uint32_t height = big_endian(&chunk.data[4]);
  if (width == 0 || height == 0) return corrupt("zero size", chunk.offset);
  if (width > kMaxImageEdge || height > kMaxImageEdge) {
    return Error{Errc::unsupported,
                 "PNG of " + std::to_string(width) + "x" + std::to_string(height) + " pixels is larger than " +
                     std::to_string(kMaxImageEdge) + " pixels a side",
                 {}};
  }
  const Header header{static_cast<int>(width), static_cast<int>(height), chunk.data[8], chunk.data[9],
                      chunk.data[12] != 0};
  if (!valid_depth(header) || chunk.data[10] != 0 || chunk.data[11] != 0) {
    return corrupt("unknown kind of pixels", chunk.offset);
  }
  return header;
}

/// What a PNG holds besides its header.
struct Body {
  std::vector<std::span<const std::uint8_t>> idat;
  std::span<const std::uint8_t> palette;
  std::size_t idat_bytes{0};
  std::size_t idat_offset{0};
};

Result<Body> read_body(ChunkReader& reader) {
  Body body;
  while (true) {
    SACCADE_TRY(const Chunk chunk, reader.next());
    if (chunk.type == "IEND") break;
    if (chunk.type == "PLTE") body.palette = chunk.data;
    if (chunk.type != "IDAT") continue;
    if (body.idat.empty()) body.idat_offset = chunk.offset;
    body.idat.push_back(chunk.data);
    body.idat_bytes += chunk.data.size();
  }
  if (body.idat.empty()) return corrupt("it holds no pixels", 0);
  return body;
}

Result<std::vector<std::uint8_t>> inflate(const Header& header, const Body& body) {
  const std::size_t raw_bytes = (header.row_bytes() + 1) * static_cast<std::size_t>(header.height);
  if (raw_bytes > kMaxExpansion * (body.idat_bytes + 1)) return corrupt("too few bytes of pixels", body.idat_offset);
  std::vector<std::uint8_t> joined;
  std::span<const std::uint8_t> packed = body.idat.front();
  if (body.idat.size() > 1) {
    joined.reserve(body.idat_bytes);
    for (const auto part : body.idat) joined.insert(joined.end(), part.begin(), part.end());
    packed = joined;
  }
  using Decompressor = std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>;
  const Decompressor decompressor{libdeflate_alloc_decompressor(), &libdeflate_free_decompressor};
  std::vector<std::uint8_t> raw(raw_bytes);
  if (!decompressor || libdeflate_zlib_decompress(decompressor.get(), packed.data(), packed.size(), raw.data(),
                                                  raw.size(), nullptr) != LIBDEFLATE_SUCCESS) {
    return corrupt("its pixels do not decompress to its size", body.idat_offset);
  }
  return raw;
}

/// Samples of fewer than 8 bits, one per output byte; grey is scaled to 0..255, palette indices are not.
std::vector<std::uint8_t> unpack_small(const Header& header, const std::vector<std::uint8_t>& rows) {
  const auto width = static_cast<std::size_t>(header.width);
  const auto bits = static_cast<unsigned>(header.bit_depth);
  const unsigned mask = (1U << bits) - 1U;
  const unsigned scale = header.color_type == kGrey ? 255U / mask : 1U;
  std::vector<std::uint8_t> out(width * static_cast<std::size_t>(header.height));
  for (std::size_t v = 0; v < static_cast<std::size_t>(header.height); ++v) {
    for (std::size_t u = 0; u < width; ++u) {
      const unsigned byte = rows[v * header.row_bytes() + u * bits / 8];
      const auto shift = 8U - bits - static_cast<unsigned>(u * bits % 8);
      out[v * width + u] = static_cast<std::uint8_t>(((byte >> shift) & mask) * scale);
    }
  }
  return out;
}

Result<std::vector<std::uint8_t>> apply_palette(const std::vector<std::uint8_t>& indices,
                                                std::span<const std::uint8_t> palette) {
  std::vector<std::uint8_t> rgb(indices.size() * 3);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (std::size_t{indices[i]} * 3 + 3 > palette.size()) return corrupt("a pixel outside of the palette", 0);
    std::memcpy(&rgb[i * 3], &palette[std::size_t{indices[i]} * 3], 3);
  }
  return rgb;
}

void swap_sample_bytes(std::vector<std::uint8_t>& bytes) {
  if constexpr (std::endian::native == std::endian::little) {
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
  }
}

void append_big_endian(std::vector<std::byte>& out, std::uint32_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) out.push_back(static_cast<std::byte>((value >> shift) & 0xFFU));
}

void append_chunk(std::vector<std::byte>& out, std::string_view type, std::span<const std::uint8_t> data) {
  append_big_endian(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  for (const char c : type) out.push_back(static_cast<std::byte>(c));
  const auto bytes = std::as_bytes(data);
  out.insert(out.end(), bytes.begin(), bytes.end());
  append_big_endian(out, libdeflate_crc32(0, &out[start], out.size() - start));
}

}  // namespace

Result<PngSize> png_size(std::span<const std::byte> file) {
  ChunkReader reader{file};
  SACCADE_TRY(const Header header, read_header(reader));
  return PngSize{header.width, header.height};
}

Result<PngPixels> decode_png(std::span<const std::byte> file) {
  ChunkReader reader{file};
  SACCADE_TRY(const Header header, read_header(reader));
  SACCADE_TRY(const Body body, read_body(reader));
  if (header.interlaced) return Error{Errc::unsupported, "interlaced PNG; save it without interlacing", {}};
  SACCADE_TRY(const auto raw, inflate(header, body));

  PngPixels out{header.width, header.height, header.samples(), header.bit_depth == 16 ? 16 : 8, {}};
  auto rows = undo_png_filters(raw, header.row_bytes(), header.pixel_bytes());
  if (rows.empty()) return corrupt("unknown row filter", body.idat_offset);
  if (header.bit_depth == 16) swap_sample_bytes(rows);
  out.bytes = header.bit_depth < 8 ? unpack_small(header, rows) : std::move(rows);
  if (header.color_type == kPalette) {
    SACCADE_TRY(out.bytes, apply_palette(out.bytes, body.palette));
    out.channels = 3;
  }
  return out;
}

std::vector<std::byte> encode_png(const PngPixels& pixels) {
  SACCADE_EXPECTS(pixels.width > 0 && pixels.height > 0 && pixels.channels >= 1 && pixels.channels <= 4);
  SACCADE_EXPECTS(pixels.sample_bits == 8 || pixels.sample_bits == 16);
  const auto pixel_bytes = static_cast<std::size_t>(pixels.channels * pixels.sample_bits / 8);
  const std::size_t row_bytes = pixel_bytes * static_cast<std::size_t>(pixels.width);
  SACCADE_EXPECTS(pixels.bytes.size() == row_bytes * static_cast<std::size_t>(pixels.height));

  std::vector<std::uint8_t> samples = pixels.bytes;
  if (pixels.sample_bits == 16) swap_sample_bytes(samples);
  const std::vector<std::uint8_t> raw = apply_png_filters(samples, row_bytes, pixel_bytes);

  constexpr int kLevel{6};
  using Compressor = std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)>;
  const Compressor compressor{libdeflate_alloc_compressor(kLevel), &libdeflate_free_compressor};
  SACCADE_EXPECTS(compressor != nullptr);
  std::vector<std::uint8_t> packed(libdeflate_zlib_compress_bound(compressor.get(), raw.size()));
  packed.resize(libdeflate_zlib_compress(compressor.get(), raw.data(), raw.size(), packed.data(), packed.size()));

  constexpr std::array<std::uint8_t, 5> kColorTypes{0, kGrey, kGreyAlpha, kRgb, kRgba};
  std::array<std::uint8_t, 13> header{};
  for (unsigned i = 0; i < 4; ++i) {
    header[i] = static_cast<std::uint8_t>(static_cast<unsigned>(pixels.width) >> (24U - 8U * i));
    header[4 + i] = static_cast<std::uint8_t>(static_cast<unsigned>(pixels.height) >> (24U - 8U * i));
  }
  header[8] = static_cast<std::uint8_t>(pixels.sample_bits);
  header[9] = kColorTypes[static_cast<std::size_t>(pixels.channels)];

  const auto signature = std::as_bytes(std::span{kSignature});
  std::vector<std::byte> file{signature.begin(), signature.end()};
  file.reserve(packed.size() + 64);
  append_chunk(file, "IHDR", header);
  append_chunk(file, "IDAT", packed);
  append_chunk(file, "IEND", {});
  return file;
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/bags/internal/chunk.hpp"

#include <zstd.h>
#ifdef SACCADE_HAS_BZ2
#include <bzlib.h>
#endif
#ifdef SACCADE_HAS_LZ4
#include <lz4frame.h>
#endif

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>

#include "saccade/io/bags/internal/bag_file.hpp"

namespace saccade::internal::io_bags {
namespace {

/// Result of a decoder: bytes produced, and whether it failed before the end.
struct Unpacked {
  std::size_t bytes{0};
  bool damaged{false};
};

Unpacked unpack_zstd(std::span<const std::byte> packed, std::span<std::byte> out) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context{ZSTD_createDCtx(), ZSTD_freeDCtx};
  if (context == nullptr) throw std::bad_alloc{};
  ZSTD_inBuffer from{packed.data(), packed.size(), 0};
  ZSTD_outBuffer to{out.data(), out.size(), 0};
  while (from.pos < from.size) {
    const std::size_t before = from.pos + to.pos;
    if (ZSTD_isError(ZSTD_decompressStream(context.get(), &to, &from)) != 0) return {to.pos, true};
    if (from.pos + to.pos == before) return {to.pos, true};  // more than announced
  }
  return {to.pos, false};
}

#ifdef SACCADE_HAS_BZ2
Unpacked unpack_bz2(std::span<const std::byte> packed, std::span<std::byte> out) {
  struct Stream : bz_stream {
    Stream() : bz_stream{} {
      if (BZ2_bzDecompressInit(this, 0, 0) != BZ_OK) throw std::bad_alloc{};
    }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
    ~Stream() { BZ2_bzDecompressEnd(this); }
  } stream;
  stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(packed.data()));  // NOLINT: read alone
  stream.avail_in = static_cast<unsigned>(packed.size());
  stream.next_out = reinterpret_cast<char*>(out.data());  // NOLINT: bytes as characters
  stream.avail_out = static_cast<unsigned>(out.size());
  int status = BZ_OK;
  while (status == BZ_OK) {
    const unsigned before = stream.avail_in + stream.avail_out;
    status = BZ2_bzDecompress(&stream);
    if (status == BZ_OK && stream.avail_in + stream.avail_out == before) break;
  }
  return {out.size() - stream.avail_out, status != BZ_STREAM_END};
}
#endif

#ifdef SACCADE_HAS_LZ4
Unpacked unpack_lz4(std::span<const std::byte> packed, std::span<std::byte> out) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) throw std::bad_alloc{};
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context{raw,
                                                                                     LZ4F_freeDecompressionContext};
  std::size_t read = 0;
  std::size_t written = 0;
  std::size_t left = 1;
  LZ4F_decompressOptions_t options{};
  options.stableDst = 1;
  while (left != 0 && read < packed.size()) {
    std::size_t in = packed.size() - read;
    std::size_t made = out.size() - written;
    left = LZ4F_decompress(context.get(), out.data() + written, &made, packed.data() + read, &in, &options);
    if (LZ4F_isError(left) != 0) return {written, true};
    read += in;
    written += made;
    if (in + made == 0) break;
  }
  return {written, left != 0};
}
#endif

[[maybe_unused]] Error lacks(const char* package) {
  return {
      Errc::unavailable,
      std::string{"its chunks are packed by a library that this build lacks: install "} + package + " and build again",
      {}};
}

}  // namespace

Packing packing_of(std::string_view name) {
  if (name.empty() || name == "none") return Packing::none;
  if (name == "bz2") return Packing::bz2;
  if (name == "lz4") return Packing::lz4;
  return name == "zstd" ? Packing::zstd : Packing::other;
}

Result<UninitializedVector<std::byte>> unpack_chunk(Packing packing, std::span<const std::byte> packed,
                                                    std::uint64_t size, bool is_cut) {
  if (size > kMaxPieceBytes) {
    return Error{
        Errc::unsupported,
        "a chunk of " + std::to_string(size) + " bytes; at most " + std::to_string(kMaxPieceBytes) + " are read",
        {}};
  }
  UninitializedVector<std::byte> out(static_cast<std::size_t>(size));
  if (out.empty()) return out;
  Unpacked unpacked;
  switch (packing) {
    case Packing::none:
      unpacked.bytes = std::min(packed.size(), out.size());
      unpacked.damaged = packed.size() > out.size();
      if (unpacked.bytes > 0) std::memcpy(out.data(), packed.data(), unpacked.bytes);
      break;
    case Packing::zstd: unpacked = unpack_zstd(packed, out); break;
#ifdef SACCADE_HAS_BZ2
    case Packing::bz2: unpacked = unpack_bz2(packed, out); break;
#else
    case Packing::bz2: return lacks("libbz2-dev");
#endif
#ifdef SACCADE_HAS_LZ4
    case Packing::lz4: unpacked = unpack_lz4(packed, out); break;
#else
    case Packing::lz4: return lacks("liblz4-dev");
#endif
    case Packing::other: return Error{Errc::unsupported, "a chunk is packed as none of none, bz2, lz4 and zstd", {}};
  }
  if (!is_cut && (unpacked.damaged || unpacked.bytes != out.size())) {
    return Error{Errc::corrupt_data, "a chunk is damaged: it does not unpack to the size that it states", {}};
  }
  out.resize(unpacked.bytes);
  return out;
}

}  // namespace saccade::internal::io_bags

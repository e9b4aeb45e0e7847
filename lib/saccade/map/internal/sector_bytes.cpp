// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/internal/sector_bytes.hpp"

#include <cstring>

namespace saccade {
namespace {

// Tags of bricks: 0 unknown, 1 … 7 constant free with this weight, and:
constexpr std::uint8_t kFreeTag{8};
constexpr std::uint8_t kDenseTag{9};
constexpr std::uint8_t kColoredTag{10};
constexpr std::size_t kMaskBytes{sizeof(Mask512)};
constexpr std::size_t kHeaderBytes{3 * kMaskBytes + kSectorBricks};
constexpr std::size_t kFreeBytes{3 * kMaskBytes};
constexpr std::size_t kDenseBytes{4 * kBrickVoxels + 2 * kMaskBytes};
constexpr std::size_t kColorBytes{3 * kBrickVoxels};

std::uint8_t tag_of(const BrickRef& brick) {
  switch (brick.kind()) {
    case BrickKind::unknown: return 0;
    case BrickKind::constant_free: return static_cast<std::uint8_t>(brick.constant_weight());
    case BrickKind::free: return kFreeTag;
    case BrickKind::dense: break;
  }
  return brick.dense()->colors ? kColoredTag : kDenseTag;
}

std::size_t payload_bytes(std::uint8_t tag) {
  switch (tag) {
    case kFreeTag: return kFreeBytes;
    case kDenseTag: return kDenseBytes;
    case kColoredTag: return kDenseBytes + kColorBytes;
    default: return 0;
  }
}

/// Puts values where the caller made room.
class Writer {
 public:
  explicit Writer(std::byte* to) : to_{to} {}
  void put(const Mask512& mask) {
    std::memcpy(to_, mask.words.data(), kMaskBytes);
    to_ += kMaskBytes;
  }
  void put(std::uint8_t tag) { *to_++ = std::byte{tag}; }
  template <class T>
  void put_planes(const std::array<T, kBrickVoxels>& values) {
    const std::byte* from = std::as_bytes(std::span{values}).data();
    for (std::size_t plane = 0; plane < sizeof(T); ++plane, to_ += kBrickVoxels) {
      for (std::size_t i = 0; i < kBrickVoxels; ++i) to_[i] = from[i * sizeof(T) + plane];
    }
  }

 private:
  std::byte* to_;
};

/// Takes values that are known to be there.
class Reader {
 public:
  explicit Reader(const std::byte* from) : from_{from} {}
  void take(Mask512& mask) {
    std::memcpy(mask.words.data(), from_, kMaskBytes);
    from_ += kMaskBytes;
  }
  template <class T>
  void take_planes(std::array<T, kBrickVoxels>& values) {
    std::byte* to = std::as_writable_bytes(std::span{values}).data();
    for (std::size_t plane = 0; plane < sizeof(T); ++plane, from_ += kBrickVoxels) {
      for (std::size_t i = 0; i < kBrickVoxels; ++i) to[i * sizeof(T) + plane] = from_[i];
    }
  }

 private:
  const std::byte* from_;
};

BrickRef take_brick(std::uint8_t tag, Reader& reader) {
  if (tag == 0) return {};
  if (tag < kFreeTag) return BrickRef::constant_free(tag);
  if (tag == kFreeTag) {
    FreeBrick free;
    for (Mask512& bits : free.weight_bits) reader.take(bits);
    return BrickRef::make(free);
  }
  BrickRef ref = BrickRef::make_dense();
  DenseBrick& dense = ref.writable_dense();
  reader.take_planes(dense.v);
  reader.take_planes(dense.w);
  reader.take(dense.occupied);
  reader.take(dense.unknown);
  if (tag == kColoredTag) {
    dense.colors = std::make_unique<BrickColors>();
    reader.take_planes(*dense.colors);
  }
  return ref;
}

}  // namespace

std::vector<std::byte> encode_sector(const Sector& sector) {
  std::size_t size{kHeaderBytes};
  for (const BrickRef& brick : sector.bricks) size += payload_bytes(tag_of(brick));
  std::vector<std::byte> bytes(size);
  Writer writer{bytes.data()};
  for (const Mask512* mask : {&sector.has_unknown, &sector.has_occupied, &sector.saturated}) writer.put(*mask);
  for (const BrickRef& brick : sector.bricks) writer.put(tag_of(brick));
  for (const BrickRef& brick : sector.bricks) {
    if (const FreeBrick* free = brick.free()) {
      for (const Mask512& bits : free->weight_bits) writer.put(bits);
    } else if (const DenseBrick* dense = brick.dense()) {
      writer.put_planes(dense->v);
      writer.put_planes(dense->w);
      writer.put(dense->occupied);
      writer.put(dense->unknown);
      if (dense->colors) writer.put_planes(*dense->colors);
    }
  }
  return bytes;
}

Status decode_sector(std::span<const std::byte> bytes, Sector& sector) {
  const Error damaged{Errc::corrupt_data, "the bytes of a sector of the map are damaged", {}};
  if (bytes.size() < kHeaderBytes) return damaged;
  const std::byte* tags = bytes.data() + 3 * kMaskBytes;
  const auto tag = [tags](std::size_t i) { return std::to_integer<std::uint8_t>(tags[i]); };
  std::size_t size{kHeaderBytes};
  for (std::size_t i = 0; i < kSectorBricks; ++i) {
    if (tag(i) > kColoredTag) return damaged;
    size += payload_bytes(tag(i));
  }
  if (size != bytes.size()) return damaged;
  Reader masks{bytes.data()};
  for (Mask512* mask : {&sector.has_unknown, &sector.has_occupied, &sector.saturated}) masks.take(*mask);
  Reader payload{bytes.data() + kHeaderBytes};
  for (std::size_t i = 0; i < kSectorBricks; ++i) sector.bricks[i] = take_brick(tag(i), payload);
  return {};
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/maps/internal/sacmap_bricks.hpp"

#include <zlib.h>

#include <algorithm>

#include "saccade/io/files/crc32.hpp"
#include "saccade/io/files/little_endian.hpp"

namespace saccade::sacmap {
namespace {

constexpr std::size_t kCrcOffset{kBrickHeaderBytes - sizeof(std::uint32_t)};

// 16-bit values are stored as 512 low bytes, then 512 high bytes, and colours as three planes: they compress better.
template <class T>
void append_planes(const std::array<T, kBrickVoxels>& values, std::vector<std::byte>& out) {
  for (std::size_t plane = 0; plane < sizeof(T); ++plane) {
    const std::size_t start = out.size();
    out.resize(start + kBrickVoxels);
    const std::byte* from = std::as_bytes(std::span{values}).data() + plane;
    for (std::size_t i = 0; i < kBrickVoxels; ++i) out[start + i] = from[i * sizeof(T)];
  }
}

template <class T>
void read_planes(ByteReader& reader, std::array<T, kBrickVoxels>& values) {
  for (std::size_t plane = 0; plane < sizeof(T); ++plane) {
    const std::span<const std::byte> bytes = reader.take(kBrickVoxels);
    std::byte* to = std::as_writable_bytes(std::span{values}).data() + plane;
    for (std::size_t i = 0; i < kBrickVoxels; ++i) to[i * sizeof(T)] = bytes[i];
  }
}

std::uint8_t info_of(const BrickRef& brick) {
  if (brick.kind() == BrickKind::constant_free) return static_cast<std::uint8_t>(brick.constant_weight());
  return brick.dense() != nullptr && brick.dense()->colors != nullptr ? 1 : 0;
}

void append_payload(const BrickRef& brick, std::vector<std::byte>& out) {
  if (const FreeBrick* free = brick.free()) append_value(out, free->weight_bits);
  if (const DenseBrick* dense = brick.dense()) {
    append_planes(dense->v, out);
    append_planes(dense->w, out);
    if (dense->colors) append_planes(*dense->colors, out);
  }
}

std::size_t payload_bytes(BrickKind kind, std::uint8_t info) {
  if (kind == BrickKind::free) return kFreeBytes;
  if (kind == BrickKind::dense) return kDenseBytes + (info != 0 ? kColorBytes : 0);
  return 0;
}

const char* fault_of_dense(const DenseBrick& dense, const TsdfConfig& config) {
  bool near_surface{false};
  for (std::size_t i = 0; i < kBrickVoxels; ++i) {
    const std::int16_t v = dense.v[i];
    const std::uint16_t w = dense.w[i];
    if (w == 0) {
      if (v != 0) return "a voxel that was never observed has a value";
      if (dense.colors && (*dense.colors)[i] != Rgb8{}) return "a voxel that was never observed has a colour";
      continue;
    }
    if (w > config.max_weight) return "a weight exceeds the maximum weight";
    if (v < -kTsdfOne) return "a value is below -1";
    if (v == kTsdfOne && w > config.free_weight) return "a weight in free space exceeds the free-space weight";
    near_surface = near_surface || v != kTsdfOne;
  }
  return near_surface ? nullptr : "a brick without a surface is stored in full";
}

const char* fault_of_free(const FreeBrick& free, const TsdfConfig& config) {
  for (int i = 0; i < kBrickVoxels; ++i) {
    if (free.weight(i) > config.free_weight) return "a weight in free space exceeds the free-space weight";
  }
  return free == FreeBrick::constant(free.weight(0)) ? "a constant brick is stored voxel by voxel" : nullptr;
}

/// One brick of the file, checked except for its voxels.
struct Record {
  int child{0};
  BrickKind kind{BrickKind::unknown};
  std::uint8_t info{0};
  std::span<const std::byte> payload;
};

Error corrupt(std::string what) { return {Errc::corrupt_data, std::move(what), {}}; }

bool known_variant(std::uint8_t kind, std::uint8_t info, const TsdfConfig& config) {
  switch (BrickKind{kind}) {
    case BrickKind::constant_free: return info >= 1 && info <= config.free_weight;
    case BrickKind::free: return info == 0;
    case BrickKind::dense: return info <= 1;
    default: return false;
  }
}

Result<Record> read_record(ByteReader& reader, std::span<const std::byte> bytes, const TsdfConfig& config) {
  if (!reader.has(kBrickHeaderBytes)) return corrupt("its header is cut short");
  const std::span<const std::byte> header = bytes.subspan(reader.offset(), kCrcOffset);
  const auto child = reader.value<std::uint16_t>();
  const auto kind = reader.value<std::uint8_t>();
  const auto info = reader.value<std::uint8_t>();
  const auto crc = reader.value<std::uint32_t>();
  if (child >= kSectorBricks) return corrupt("its index is beyond the sector");
  if (!known_variant(kind, info, config)) return corrupt("there is no such kind of brick");
  const std::size_t size = payload_bytes(BrickKind{kind}, info);
  if (!reader.has(size)) return corrupt("it is cut short");
  const std::span<const std::byte> payload = reader.take(size);
  if (crc32(header, payload) != crc) return corrupt("its checksum is wrong");
  return Record{child, BrickKind{kind}, info, payload};
}

BrickRef unpack(const Record& record) {
  ByteReader reader{record.payload};
  if (record.kind == BrickKind::constant_free) return BrickRef::constant_free(record.info);
  if (record.kind == BrickKind::free) {
    FreeBrick free;
    free.weight_bits = reader.value<decltype(free.weight_bits)>();
    return BrickRef::make(free);
  }
  BrickRef ref = BrickRef::make_dense();
  DenseBrick& dense = ref.writable_dense();
  read_planes(reader, dense.v);
  read_planes(reader, dense.w);
  if (record.info != 0) {
    dense.colors = std::make_unique<BrickColors>();
    read_planes(reader, *dense.colors);
  }
  dense.update_masks();
  return ref;
}

}  // namespace

const char* fault_of(const BrickRef& brick, const TsdfConfig& config) {
  if (const DenseBrick* dense = brick.dense()) return fault_of_dense(*dense, config);
  if (const FreeBrick* free = brick.free()) return fault_of_free(*free, config);
  const bool heavy = brick.kind() == BrickKind::constant_free && brick.constant_weight() > config.free_weight;
  return heavy ? "a weight in free space exceeds the free-space weight" : nullptr;
}

void append_bricks(const Sector& sector, std::vector<std::byte>& out) {
  for (std::size_t child = 0; child < kSectorBricks; ++child) {
    const BrickRef& brick = sector.bricks[child];
    if (brick.is_unknown()) continue;
    const std::size_t start = out.size();
    append_value(out, static_cast<std::uint16_t>(child));
    append_value(out, static_cast<std::uint8_t>(brick.kind()));
    append_value(out, info_of(brick));
    append_value(out, std::uint32_t{0});
    append_payload(brick, out);
    const std::span<std::byte> record = std::span{out}.subspan(start);
    const std::uint32_t crc = crc32(record.first(kCrcOffset), record.subspan(kBrickHeaderBytes));
    std::memcpy(record.data() + kCrcOffset, &crc, sizeof crc);
  }
}

Result<std::size_t> read_bricks(std::span<const std::byte> bytes, const TsdfConfig& config, Sector& sector) {
  ByteReader reader{bytes};
  std::size_t count{0};
  for (int last_child = -1; reader.left() > 0; ++count) {
    const Result<Record> record = read_record(reader, bytes, config);
    const char* fault = record ? nullptr : record.error().message.c_str();
    if (fault == nullptr && record->child <= last_child) fault = "bricks are out of order";
    BrickRef brick;
    if (fault == nullptr) {
      brick = unpack(*record);
      fault = fault_of(brick, config);
    }
    if (fault != nullptr) return corrupt("brick no. " + std::to_string(count) + ": " + fault);
    last_child = record->child;
    sector.bricks[static_cast<std::size_t>(last_child)] = std::move(brick);
    sector.update_summary(last_child, config.free_weight);
  }
  return count;
}

}  // namespace saccade::sacmap

// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/maps/sacmap.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "saccade/io/files/crc32.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/little_endian.hpp"
#include "saccade/io/maps/internal/sacmap_bricks.hpp"

namespace saccade {
namespace {

using Bytes = std::vector<std::byte>;
using Sink = std::function<Status(std::span<const std::byte>)>;

// "\r\n" and 0x1A show a transfer that changed line ends or stopped at one.
constexpr std::array<char, 8> kMagic{'S', 'A', 'C', 'M', 'A', 'P', '\n', '\x1A'};
constexpr std::uint32_t kMapVersion{1};
constexpr int kZstdLevel{1};
constexpr std::int32_t kMaxSectorCoordinate{1 << 20};  // voxel coordinates stay below 2^27
constexpr std::size_t kSectorsAtOnce{32};

/// Everything before the first sector, except its checksum.
struct FixedHeader {
  std::array<char, 8> magic{kMagic};
  std::uint32_t version{kMapVersion};
  std::uint16_t max_weight{0};
  std::uint8_t free_weight{0};
  std::uint8_t clearing_percent{0};  ///< 0 means 100
  double voxel_size_m{0.0};
  double truncation_vox{0.0};
  std::array<double, 6> workspace{};  ///< min, max; zeros without one
  std::uint32_t color{0};
  std::uint32_t has_workspace{0};
  std::uint64_t sectors{0};
  std::uint64_t bricks{0};
};
static_assert(sizeof(FixedHeader) == 104 && std::is_trivially_copyable_v<FixedHeader>);

/// Header before each sector's compressed bricks, without its checksum.
struct SectorHeader {
  Index3 key;
  std::uint32_t raw_bytes{0};
  std::uint32_t compressed_bytes{0};
  std::uint32_t compressed_crc{0};
};
static_assert(sizeof(SectorHeader) == 24 && std::is_trivially_copyable_v<SectorHeader>);

template <class T>
void append_with_crc(Bytes& out, const T& header) {
  append_value(out, header);
  append_value(out, crc32(std::as_bytes(std::span{&header, 1})));
}

/// Reads a value; nullopt when its checksum does not match.
template <class T>
std::optional<T> read_with_crc(ByteReader& reader) {
  const T header = reader.value<T>();
  const auto crc = reader.value<std::uint32_t>();
  return crc == crc32(std::as_bytes(std::span{&header, 1})) ? std::optional{header} : std::nullopt;
}

std::string name_of(const Index3& key) {
  return "sector (" + std::to_string(key.x) + ", " + std::to_string(key.y) + ", " + std::to_string(key.z) + ")";
}

bool within_limits(const Index3& key) {
  const auto ok = [](std::int32_t c) { return c >= -kMaxSectorCoordinate && c <= kMaxSectorCoordinate; };
  return ok(key.x) && ok(key.y) && ok(key.z);
}

Error damaged(std::size_t offset, const std::string& what) {
  return {Errc::corrupt_data, "the map is damaged at byte " + std::to_string(offset) + ": " + what, {}};
}

// ---- writing

Status check_map(const TsdfSnapshot& map, const std::vector<Index3>& keys) {
  SACCADE_CHECK(map.config.validate());
  for (const Index3& key : keys) {
    if (!within_limits(key)) return Error{Errc::invalid_argument, "the map reaches too far to be saved", name_of(key)};
  }
  return {};
}

Status check_sector(const Index3& key, const Sector& sector, const TsdfConfig& config) {
  for (const BrickRef& brick : sector.bricks) {
    if (const char* fault = sacmap::fault_of(brick, config)) {
      return Error{Errc::invalid_argument, std::string{"the map cannot be saved: "} + fault, name_of(key)};
    }
  }
  return {};
}

FixedHeader header_of(const TsdfSnapshot& map) {
  FixedHeader header;
  header.max_weight = map.config.max_weight;
  header.free_weight = static_cast<std::uint8_t>(map.config.free_weight);
  header.clearing_percent = map.config.clearing_percent == 100 ? std::uint8_t{0} : map.config.clearing_percent;
  header.voxel_size_m = map.config.voxel_size_m;
  header.truncation_vox = map.config.truncation_vox;
  header.color = map.config.color ? 1 : 0;
  if (const auto& box = map.config.workspace) {
    header.has_workspace = 1;
    header.workspace = {box->min.x(), box->min.y(), box->min.z(), box->max.x(), box->max.y(), box->max.z()};
  }
  const TsdfGrid::Usage usage = map.grid.usage();
  header.sectors = usage.sectors;
  header.bricks = usage.bricks();
  return header;
}

struct Compressor {
  Compressor() : context{ZSTD_createCCtx(), &ZSTD_freeCCtx} { SACCADE_EXPECTS(context != nullptr); }
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context;
  Bytes raw;
  Bytes packed;

  void encode(const Index3& key, const Sector& sector, Bytes& out) {
    raw.clear();
    sacmap::append_bricks(sector, raw);
    packed.resize(ZSTD_compressBound(raw.size()));
    const std::size_t size =
        ZSTD_compressCCtx(context.get(), packed.data(), packed.size(), raw.data(), raw.size(), kZstdLevel);
    SACCADE_EXPECTS(ZSTD_isError(size) == 0);
    const std::span<const std::byte> compressed = std::span{packed}.first(size);
    out.clear();
    append_with_crc(out, SectorHeader{key, static_cast<std::uint32_t>(raw.size()), static_cast<std::uint32_t>(size),
                                      crc32(compressed)});
    out.insert(out.end(), compressed.begin(), compressed.end());
  }
};

Status write_map(const TsdfSnapshot& map, const Executor& executor, const Sink& sink) {
  const std::vector<Index3> keys = map.grid.sorted_sectors();
  SACCADE_CHECK(check_map(map, keys));
  Bytes header;
  append_with_crc(header, header_of(map));
  SACCADE_CHECK(sink(header));
  std::array<Bytes, kSectorsAtOnce> records;
  std::array<Status, kSectorsAtOnce> statuses;
  // Sectors of a paged map come from their store and go again at once.
  const auto encode = [&](const Index3& key, Compressor& compressor, Bytes& record) -> Status {
    SACCADE_TRY(const SectorRef sector, map.grid.read(key));
    SACCADE_CHECK(check_sector(key, *sector, map.config));
    compressor.encode(key, *sector, record);
    return {};
  };
  for (std::size_t first = 0; first < keys.size(); first += kSectorsAtOnce) {
    const std::size_t count = std::min(kSectorsAtOnce, keys.size() - first);
    executor.parallel_for(count, kSectorsAtOnce / 8, [&](std::size_t begin, std::size_t end) {
      Compressor compressor;
      for (std::size_t i = begin; i < end; ++i) statuses[i] = encode(keys[first + i], compressor, records[i]);
    });
    for (std::size_t i = 0; i < count; ++i) {
      SACCADE_CHECK(statuses[i]);
      SACCADE_CHECK(sink(records[i]));
    }
  }
  return {};
}

// ---- reading

Result<FixedHeader> read_header(ByteReader& reader) {
  constexpr std::size_t kBytes{sizeof(FixedHeader) + sizeof(std::uint32_t)};
  const std::size_t present = std::min(reader.left(), kMagic.size());
  ByteReader peek = reader;
  const std::span<const std::byte> first = peek.take(present);
  if (present == 0 || std::memcmp(first.data(), kMagic.data(), present) != 0) {
    return Error{Errc::corrupt_data, "this is not a Saccade map (.sacmap)", {}};
  }
  if (!reader.has(kBytes)) return damaged(reader.left(), "the file ends within its header");
  peek = reader;
  const auto unchecked = peek.value<FixedHeader>();
  if (unchecked.version != kMapVersion) {
    return Error{Errc::unsupported,
                 "the map has format version " + std::to_string(unchecked.version) + ", this program reads version " +
                     std::to_string(kMapVersion),
                 {}};
  }
  const std::optional<FixedHeader> header = read_with_crc<FixedHeader>(reader);
  if (!header) return damaged(0, "the header's checksum is wrong");
  return *header;
}

Result<TsdfConfig> config_of(const FixedHeader& header) {
  if (header.color > 1 || header.has_workspace > 1)
    return damaged(0, "the header holds a flag that is neither 0 nor 1");
  TsdfConfig config;
  config.voxel_size_m = header.voxel_size_m;
  config.truncation_vox = header.truncation_vox;
  config.max_weight = header.max_weight;
  config.free_weight = header.free_weight;
  if (header.clearing_percent == 100) return damaged(0, "the header writes a clearing share of 100 % other than as 0");
  config.clearing_percent = header.clearing_percent == 0 ? std::uint8_t{100} : header.clearing_percent;
  config.color = header.color == 1;
  const auto& w = header.workspace;
  if (header.has_workspace == 1) config.workspace = Box{{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
  if (header.has_workspace == 0 && std::any_of(w.begin(), w.end(), [](double x) { return x != 0.0; })) {
    return damaged(0, "the header holds a workspace that it says is not there");
  }
  if (const Status valid = config.validate(); !valid) return damaged(0, valid.error().message);
  return config;
}

struct SectorRecord {
  std::size_t offset{0};
  SectorHeader header;
  std::span<const std::byte> compressed;
  Sector* sector{nullptr};
};

Result<SectorRecord> read_sector_header(ByteReader& reader, const std::optional<Index3>& previous) {
  SectorRecord record;
  record.offset = reader.offset();
  const auto fail = [&](const std::string& what) { return damaged(record.offset, what); };
  if (!reader.has(sizeof(SectorHeader) + sizeof(std::uint32_t))) return fail("the file ends where a sector is due");
  const std::optional<SectorHeader> header = read_with_crc<SectorHeader>(reader);
  if (!header) return fail("the checksum of a sector's header is wrong");
  record.header = *header;
  const std::string name = name_of(header->key);
  if (!within_limits(header->key)) return fail(name + " lies too far from the origin");
  if (previous && !zyx_less(*previous, header->key)) return fail(name + " is out of order");
  if (header->raw_bytes > sacmap::kMaxSectorBytes) return fail(name + " claims to be larger than a sector can be");
  if (!reader.has(header->compressed_bytes)) return fail("the file ends within " + name);
  record.compressed = reader.take(header->compressed_bytes);
  return record;
}

struct Decompressor {
  Decompressor() : context{ZSTD_createDCtx(), &ZSTD_freeDCtx} { SACCADE_EXPECTS(context != nullptr); }
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context;
  Bytes raw;

  Result<std::size_t> decode(const SectorRecord& record, const TsdfConfig& config) {
    const std::string name = name_of(record.header.key);
    if (crc32(record.compressed) != record.header.compressed_crc) {
      return damaged(record.offset, "the checksum of " + name + " is wrong");
    }
    raw.resize(record.header.raw_bytes);
    const std::size_t size =
        ZSTD_decompressDCtx(context.get(), raw.data(), raw.size(), record.compressed.data(), record.compressed.size());
    if (ZSTD_isError(size) != 0 || size != raw.size()) {
      return damaged(record.offset, name + " cannot be decompressed");
    }
    Result<std::size_t> bricks = sacmap::read_bricks(raw, config, *record.sector);
    if (!bricks) return damaged(record.offset, name + ", " + bricks.error().message);
    return bricks;
  }
};

/// Reads up to kSectorsAtOnce sectors; returns the number of bricks in them.
Result<std::size_t> read_batch(ByteReader& reader, std::size_t count, std::optional<Index3>& previous,
                               const Executor& executor, TsdfSnapshot& map) {
  std::vector<SectorRecord> records;
  for (std::size_t i = 0; i < count; ++i) {
    SACCADE_TRY(SectorRecord record, read_sector_header(reader, previous));
    previous = record.header.key;
    record.sector = &map.grid.writable(record.header.key);
    records.push_back(record);
  }
  std::vector<Result<std::size_t>> results(count, Result<std::size_t>{std::size_t{0}});
  executor.parallel_for(count, kSectorsAtOnce / 8, [&](std::size_t begin, std::size_t end) {
    Decompressor decompressor;
    for (std::size_t i = begin; i < end; ++i) results[i] = decompressor.decode(records[i], map.config);
  });
  std::size_t bricks{0};
  for (const Result<std::size_t>& result : results) {
    if (!result) return result.error();
    bricks += *result;
  }
  return bricks;
}

}  // namespace

Status save_map(const TsdfSnapshot& map, const std::filesystem::path& path, const Executor& executor) {
  SACCADE_TRY(AtomicFile file, AtomicFile::create(path));
  Status written = write_map(map, executor, [&](std::span<const std::byte> bytes) { return file.write(bytes); });
  if (!written) {
    Error error = written.error();
    if (error.code == Errc::invalid_argument) error.context = path.string() + ": " + error.context;
    return error;
  }
  return file.commit();
}

Result<TsdfSnapshot> load_map(const std::filesystem::path& path, const Executor& executor) {
  SACCADE_TRY(const Bytes bytes, read_file(path));
  Result<TsdfSnapshot> map = decode_map(bytes, executor);
  if (map) return map;
  Error error = map.error();
  error.context = path.string();
  return error;
}

Result<Bytes> encode_map(const TsdfSnapshot& map, const Executor& executor) {
  Bytes file;
  SACCADE_CHECK(write_map(map, executor, [&](std::span<const std::byte> bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
    return Status{};
  }));
  return file;
}

Result<TsdfSnapshot> decode_map(std::span<const std::byte> file, const Executor& executor) {
  ByteReader reader{file};
  SACCADE_TRY(const FixedHeader header, read_header(reader));
  TsdfSnapshot map;
  SACCADE_TRY(map.config, config_of(header));
  std::optional<Index3> previous;
  std::uint64_t bricks{0};
  for (std::uint64_t left = header.sectors; left > 0;) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left, kSectorsAtOnce));
    SACCADE_TRY(const std::size_t read, read_batch(reader, count, previous, executor, map));
    bricks += read;
    left -= count;
  }
  if (reader.left() > 0) return damaged(reader.offset(), "there are bytes after the last sector");
  if (bricks != header.bricks) return damaged(0, "the header's number of bricks is not what the file holds");
  return map;
}

}  // namespace saccade

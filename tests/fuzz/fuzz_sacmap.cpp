// SPDX-License-Identifier: Apache-2.0
// Feeds the reader of .sacmap files. The first byte of the input chooses: the file as it is, the file with the
// checksums of its header and first sector made right, or the bricks of one sector before compression with theirs.
// Whatever is accepted must be saved and loaded again as an equal map.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "saccade/io/files/crc32.hpp"
#include "saccade/io/maps/internal/sacmap_bricks.hpp"
#include "saccade/io/maps/sacmap.hpp"

namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kHeaderBytes{104};
constexpr std::size_t kSectorHeaderBytes{24};

void require(bool condition) {
  if (!condition) std::abort();
}

void repair(Bytes& file, std::size_t offset, std::size_t size) {
  if (file.size() < offset + size + 4) return;
  const std::uint32_t crc = saccade::crc32(std::span{file}.subspan(offset, size));
  std::memcpy(&file[offset + size], &crc, sizeof crc);
}

void repair_first_sector(Bytes& file) {
  constexpr std::size_t kOffset{kHeaderBytes + 4};
  constexpr std::size_t kData{kOffset + kSectorHeaderBytes + 4};
  if (file.size() < kData) return;
  const auto size = static_cast<std::uint32_t>(file.size() - kData);
  const std::uint32_t crc = saccade::crc32(std::span{file}.subspan(kData));
  std::memcpy(&file[kOffset + 16], &size, sizeof size);
  std::memcpy(&file[kOffset + 20], &crc, sizeof crc);
  repair(file, kOffset, kSectorHeaderBytes);
}

void check_map(const Bytes& file) {
  const auto map = saccade::decode_map(file);
  if (!map) return;
  const auto again = saccade::encode_map(*map);
  require(again.ok());
  const auto loaded = saccade::decode_map(*again);
  require(loaded.ok() && loaded->grid == map->grid);
}

/// Makes the checksum of every brick right, as far as their sizes can be followed.
void repair_bricks(Bytes& bytes) {
  using namespace saccade::sacmap;
  for (std::size_t at = 0; at + kBrickHeaderBytes <= bytes.size();) {
    const auto kind = static_cast<int>(bytes[at + 2]);
    const bool colored = bytes[at + 3] != std::byte{0};
    const std::size_t size = kind == 2 ? kFreeBytes : kind == 3 ? kDenseBytes + (colored ? kColorBytes : 0) : 0;
    if (at + kBrickHeaderBytes + size > bytes.size()) return;
    const std::span all{bytes};
    const std::uint32_t crc = saccade::crc32(all.subspan(at, 4), all.subspan(at + kBrickHeaderBytes, size));
    std::memcpy(&bytes[at + 4], &crc, sizeof crc);
    at += kBrickHeaderBytes + size;
  }
}

void check_bricks(Bytes bytes) {
  repair_bricks(bytes);
  saccade::Sector sector;
  const auto count = saccade::sacmap::read_bricks(bytes, saccade::TsdfConfig{}, sector);
  if (!count) return;
  Bytes again;
  saccade::sacmap::append_bricks(sector, again);
  require(again == bytes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto* first = reinterpret_cast<const std::byte*>(data);
  Bytes input(first + 1, first + size);
  switch (data[0] % 3) {
    case 0: check_map(input); break;
    case 1:
      repair(input, 0, kHeaderBytes);
      repair_first_sector(input);
      check_map(input);
      break;
    default: check_bricks(std::move(input)); break;
  }
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/sector_store.hpp"

#include "saccade/map/internal/sector_bytes.hpp"

namespace saccade {
namespace {

StoredSector::Summary summary_of(const Sector& sector) {
  StoredSector::Summary summary;
  for (int i = 0; i < kSectorBricks; ++i) {
    const BrickRef& brick = sector.bricks[static_cast<std::size_t>(i)];
    summary.known.assign(i, !brick.is_unknown());
    switch (brick.kind()) {
      case BrickKind::unknown: break;
      case BrickKind::constant_free: ++summary.constant_free_bricks; break;
      case BrickKind::free: ++summary.free_bricks; break;
      case BrickKind::dense: ++summary.dense_bricks; break;
    }
  }
  summary.memory_bytes = memory_bytes(sector);
  return summary;
}

}  // namespace

Result<std::shared_ptr<const StoredSector>> StoredSector::write(std::shared_ptr<SectorStore> store,
                                                                const Sector& sector) {
  SACCADE_TRY(const StoredPlace place, store->write(encode_sector(sector)));
  return std::shared_ptr<const StoredSector>{
      std::make_shared<StoredSector>(std::move(store), place, summary_of(sector))};
}

Result<SectorRef> StoredSector::read() const {
  SACCADE_TRY(const std::vector<std::byte> bytes, store_->read(place_));
  SectorRef ref = SectorRef::make();
  SACCADE_CHECK(decode_sector(bytes, ref.writable()));
  ref.set_stored(shared_from_this());
  return ref;
}

std::size_t memory_bytes(const Sector& sector) {
  std::size_t bytes = sizeof(Sector) + sizeof(std::pair<const Index3, SectorRef>) + 2 * sizeof(void*);
  for (const BrickRef& brick : sector.bricks) bytes += brick.heap_bytes();
  return bytes;
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#pragma once
// SectorStore: where sectors go that are not in memory. StoredSector: one sector there.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/map/brick.hpp"

namespace saccade {

/// Place of some bytes in a store, for which it is a name.
struct StoredPlace {
  std::uint64_t offset{0};
  std::uint32_t stored_bytes{0};  ///< taken in the store
  std::uint32_t bytes{0};         ///< as they were written
  std::uint32_t checksum{0};
};

/// Keeps bytes until they are released. Thesis §2.2.2: the CPU's memory behind the GPU's volume; here the disk behind
/// the memory. Several threads at once may call any of these.
class SectorStore {
 public:
  SectorStore() = default;
  SectorStore(const SectorStore&) = delete;
  SectorStore& operator=(const SectorStore&) = delete;
  virtual ~SectorStore() = default;

  /// Answers io_failure (a full disk …) with the place and what to do; nothing is kept then.
  [[nodiscard]] virtual Result<StoredPlace> write(std::span<const std::byte> bytes) = 0;
  /// Returns the bytes as they were written, to the bit. Answers io_failure, and corrupt_data where they are not.
  [[nodiscard]] virtual Result<std::vector<std::byte>> read(const StoredPlace& place) = 0;
  virtual void release(const StoredPlace& place) noexcept = 0;
};

/// Content of one sector in a store. It never changes: a sector that is written and goes out again is stored anew. The
/// store keeps it as long as a handle does, so that snapshots read the content of their time.
class StoredSector : public std::enable_shared_from_this<StoredSector> {
 public:
  /// What is known without reading.
  struct Summary {
    Mask512 known;  ///< bricks with a known voxel
    std::size_t constant_free_bricks{0};
    std::size_t free_bricks{0};
    std::size_t dense_bricks{0};
    std::size_t memory_bytes{0};  ///< heap bytes once it is in memory
  };

  /// Writes a sector. Errors: those of SectorStore::write. O(bytes of the sector).
  [[nodiscard]] static Result<std::shared_ptr<const StoredSector>> write(std::shared_ptr<SectorStore> store,
                                                                         const Sector& sector);
  StoredSector(std::shared_ptr<SectorStore> store, const StoredPlace& place, const Summary& summary)
      : store_{std::move(store)}, place_{place}, summary_{summary} {}
  StoredSector(const StoredSector&) = delete;
  StoredSector& operator=(const StoredSector&) = delete;
  ~StoredSector() { store_->release(place_); }

  /// Reads the sector: content and summaries equal to the bit, and stored() is this. Errors: those of
  /// SectorStore::read; corrupt_data for bytes that are no sector.
  [[nodiscard]] Result<SectorRef> read() const;
  [[nodiscard]] const Summary& summary() const { return summary_; }
  [[nodiscard]] std::size_t stored_bytes() const { return place_.stored_bytes; }

 private:
  std::shared_ptr<SectorStore> store_;
  StoredPlace place_;
  Summary summary_;
};

/// Returns the heap bytes of a sector in memory, as TsdfGrid::usage counts them. O(bricks).
[[nodiscard]] std::size_t memory_bytes(const Sector& sector);

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#pragma once
// MemoryStore: a SectorStore in memory that counts, and fails when it is told to.

#include <cstddef>
#include <map>
#include <mutex>
#include <vector>

#include "saccade/map/sector_store.hpp"

namespace saccade::test {

class MemoryStore final : public SectorStore {
 public:
  [[nodiscard]] Result<StoredPlace> write(std::span<const std::byte> bytes) override {
    const std::scoped_lock lock{mutex_};
    if (writes_left == 0) return Error{Errc::io_failure, "the store is full", "memory"};
    if (writes_left > 0) --writes_left;
    ++writes;
    const StoredPlace place{next_++, static_cast<std::uint32_t>(bytes.size()), static_cast<std::uint32_t>(bytes.size()),
                            0};
    kept_.emplace(place.offset, std::vector<std::byte>{bytes.begin(), bytes.end()});
    return place;
  }
  [[nodiscard]] Result<std::vector<std::byte>> read(const StoredPlace& place) override {
    const std::scoped_lock lock{mutex_};
    if (fails_reads) return Error{Errc::corrupt_data, "the store is damaged", "memory"};
    ++reads;
    std::vector<std::byte> bytes = kept_.at(place.offset);
    if (cuts_reads) bytes.pop_back();
    return bytes;
  }
  void release(const StoredPlace& place) noexcept override {
    const std::scoped_lock lock{mutex_};
    kept_.erase(place.offset);
  }
  [[nodiscard]] std::size_t kept() const {
    const std::scoped_lock lock{mutex_};
    return kept_.size();
  }

  int writes_left{-1};  ///< fails once they are used up; negative: never
  bool fails_reads{false};
  bool cuts_reads{false};
  std::size_t writes{0};
  std::size_t reads{0};

 private:
  mutable std::mutex mutex_;
  std::map<std::uint64_t, std::vector<std::byte>> kept_;
  std::uint64_t next_{0};
};

}  // namespace saccade::test

// SPDX-License-Identifier: Apache-2.0
#pragma once
// SpillFile: a SectorStore in one file on the disk.

#include <cstddef>
#include <filesystem>
#include <memory>

#include "saccade/io/files/file_io.hpp"
#include "saccade/map/sector_store.hpp"

namespace saccade {

/// Keeps sectors in one nameless file of a folder, compressed by zstd, each with a CRC-32. Room that is released is
/// used again. The file is there for this process alone: the system frees it when the process ends, however it ends.
/// Its bytes are in the machine's order.
class SpillFile final : public SectorStore {
 public:
  /// Makes the file; removes what a process left that was killed while it made its own. Answers io_failure naming the
  /// folder, where it is not there or cannot be written.
  [[nodiscard]] static Result<std::shared_ptr<SpillFile>> create(const std::filesystem::path& folder);
  ~SpillFile() override;

  /// Answers io_failure naming the folder: a full disk …
  [[nodiscard]] Result<StoredPlace> write(std::span<const std::byte> bytes) override;
  /// Answers io_failure, and corrupt_data where the checksum or the size is not what was written.
  [[nodiscard]] Result<std::vector<std::byte>> read(const StoredPlace& place) override;
  void release(const StoredPlace& place) noexcept override;

  /// Returns the length of the file, which is the most that was in it at one time, and what reuse lost.
  [[nodiscard]] std::size_t file_bytes() const;
  /// Returns the file's descriptor, for tests that damage it.
  [[nodiscard]] int descriptor() const { return file_.get(); }

 private:
  struct Parts;
  SpillFile(std::filesystem::path folder, Descriptor file);
  [[nodiscard]] Error failure(Errc code, const std::string& what) const;
  [[nodiscard]] Status write_at(std::span<const std::byte> bytes, std::uint64_t offset) const;
  [[nodiscard]] Result<std::vector<std::byte>> read_at(const StoredPlace& place) const;

  std::filesystem::path folder_;
  Descriptor file_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/maps/spill_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "saccade/io/files/crc32.hpp"
#include "saccade/io/files/leftovers.hpp"
#include "saccade/io/maps/internal/context_pool.hpp"
#include "saccade/io/maps/internal/file_room.hpp"

namespace saccade {
namespace {

constexpr int kSpillLevel{-3};  // a fast level of zstd
constexpr const char* kName{"map-pages"};

}  // namespace

struct SpillFile::Parts {
  ContextPool<ZSTD_CCtx, &ZSTD_createCCtx, &ZSTD_freeCCtx> compressors;
  ContextPool<ZSTD_DCtx, &ZSTD_createDCtx, &ZSTD_freeDCtx> decompressors;
  mutable std::mutex mutex;
  FileRoom room;
  std::uint64_t longest{0};
};

SpillFile::SpillFile(std::filesystem::path folder, Descriptor file)
    : folder_{std::move(folder)}, file_{std::move(file)}, parts_{std::make_unique<Parts>()} {}
SpillFile::~SpillFile() = default;

Result<std::shared_ptr<SpillFile>> SpillFile::create(const std::filesystem::path& folder) {
  const std::filesystem::path shown = folder.empty() ? std::filesystem::path{"."} : folder;
  remove_leftovers(shown / kName);
  const std::filesystem::path name = shown / make_temporary_name(kName);
  Descriptor file{::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600)};
  if (file.get() < 0) {
    return Error{Errc::io_failure,
                 std::string{"cannot make a file for parts of the map in this folder: "} + std::strerror(errno) +
                     "; choose a folder that can be written",
                 shown.string()};
  }
  ::flock(file.get(), LOCK_EX | LOCK_NB);
  ::unlink(name.c_str());  // what has no name is gone with the process
  return std::shared_ptr<SpillFile>{new SpillFile{shown, std::move(file)}};
}

Result<StoredPlace> SpillFile::write(std::span<const std::byte> bytes) {
  std::vector<std::byte> packed(ZSTD_compressBound(bytes.size()));
  auto compressor = parts_->compressors.take();
  const std::size_t size =
      ZSTD_compressCCtx(compressor.get(), packed.data(), packed.size(), bytes.data(), bytes.size(), kSpillLevel);
  parts_->compressors.give_back(std::move(compressor));
  SACCADE_EXPECTS(ZSTD_isError(size) == 0);
  packed.resize(size);
  StoredPlace place{0, static_cast<std::uint32_t>(size), static_cast<std::uint32_t>(bytes.size()), crc32(packed)};
  {
    const std::scoped_lock lock{parts_->mutex};
    place.offset = parts_->room.take(size);
    parts_->longest = std::max(parts_->longest, parts_->room.end());
  }
  Status written = write_at(packed, place.offset);
  if (written) return place;
  release(place);
  return written.error();
}

Result<std::vector<std::byte>> SpillFile::read(const StoredPlace& place) {
  SACCADE_TRY(const std::vector<std::byte> packed, read_at(place));
  const std::string damaged = "the file with parts of the map is damaged at byte " + std::to_string(place.offset) +
                              "; check the disk, and fuse again";
  if (crc32(packed) != place.checksum) return failure(Errc::corrupt_data, damaged);
  std::vector<std::byte> bytes(place.bytes);
  auto decompressor = parts_->decompressors.take();
  const std::size_t size =
      ZSTD_decompressDCtx(decompressor.get(), bytes.data(), bytes.size(), packed.data(), packed.size());
  parts_->decompressors.give_back(std::move(decompressor));
  if (ZSTD_isError(size) != 0 || size != bytes.size()) return failure(Errc::corrupt_data, damaged);
  return bytes;
}

void SpillFile::release(const StoredPlace& place) noexcept {
  const std::scoped_lock lock{parts_->mutex};
  parts_->room.give_back(place.offset, place.stored_bytes);
}

std::size_t SpillFile::file_bytes() const {
  const std::scoped_lock lock{parts_->mutex};
  return static_cast<std::size_t>(parts_->longest);
}

Error SpillFile::failure(Errc code, const std::string& what) const { return {code, what, folder_.string()}; }

Status SpillFile::write_at(std::span<const std::byte> bytes, std::uint64_t offset) const {
  while (!bytes.empty()) {
    const ssize_t put = ::pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) {
      return failure(Errc::io_failure, std::string{"cannot write parts of the map to this folder: "} +
                                           std::strerror(put < 0 ? errno : ENOSPC) +
                                           "; make room, choose another folder, or allow the map more memory");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(put));
    offset += static_cast<std::uint64_t>(put);
  }
  return {};
}

Result<std::vector<std::byte>> SpillFile::read_at(const StoredPlace& place) const {
  std::vector<std::byte> bytes(place.stored_bytes);
  std::size_t done{0};
  while (done < bytes.size()) {
    const ssize_t got =
        ::pread(file_.get(), bytes.data() + done, bytes.size() - done, static_cast<off_t>(place.offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      return failure(Errc::io_failure, std::string{"cannot read parts of the map from this folder: "} +
                                           std::strerror(errno) + "; check the disk, and fuse again");
    }
    if (got == 0) return failure(Errc::corrupt_data, "the file with parts of the map was cut short; fuse again");
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

}  // namespace saccade

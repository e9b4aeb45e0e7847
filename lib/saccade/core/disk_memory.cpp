// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/disk_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace saccade {
namespace {

/// A file without a name.
class NamelessFile {
 public:
  explicit NamelessFile(const std::filesystem::path& folder) {
    std::string name = (folder / "saccade-XXXXXX").string();
    descriptor_ = mkostemp(name.data(), O_CLOEXEC);
    if (descriptor_ >= 0) unlink(name.c_str());
  }
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;
  ~NamelessFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_{-1};
};

std::string reason(int number) { return std::generic_category().message(number); }

}  // namespace

Result<std::shared_ptr<const DiskMemory>> DiskMemory::in(std::filesystem::path folder) {
  if (NamelessFile{folder}.descriptor() < 0) {
    return Error{Errc::io_failure, "no file can be made in this folder: " + reason(errno), folder.string()};
  }
  return std::shared_ptr<const DiskMemory>{new DiskMemory{std::move(folder)}};
}

void* DiskMemory::allocate(std::size_t bytes) const {
  if (bytes == 0) return nullptr;
  const auto full = [&](int number) {
    return DiskFull{folder_.string() + ": no room for " + std::to_string((bytes >> 20U) + 1) +
                    " MiB: " + reason(number)};
  };
  const NamelessFile file{folder_};
  if (file.descriptor() < 0) throw full(errno);
  const int reserved = posix_fallocate(file.descriptor(), 0, static_cast<off_t>(bytes));  // or writing might fail
  if (reserved != 0) throw full(reserved);
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file.descriptor(), 0);
  if (memory == MAP_FAILED) throw full(errno);
  return memory;
}

void DiskMemory::release(void* memory, std::size_t bytes) noexcept {
  if (memory != nullptr) munmap(memory, bytes);
}

}  // namespace saccade

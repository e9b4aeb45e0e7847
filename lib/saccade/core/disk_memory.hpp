// SPDX-License-Identifier: Apache-2.0
#pragma once
// DiskMemory: room for arrays larger than memory. DiskVector: a vector that may lie there.

#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/core/uninitialized_vector.hpp"

namespace saccade {

/// There is no room on disk for an array.
class DiskFull : public std::bad_alloc {
 public:
  explicit DiskFull(std::string why) : why_{std::move(why)} {}
  [[nodiscard]] const char* what() const noexcept override { return why_.c_str(); }

 private:
  std::string why_;
};

/// Arrays as files of a folder, mapped into memory: the system keeps the pages in use in memory and writes the others
/// to disk. The files have no names, so that nothing is left when the program ends, however it ends.
class DiskMemory {
 public:
  /// Takes a folder. io_failure where no such file can be made in it.
  [[nodiscard]] static Result<std::shared_ptr<const DiskMemory>> in(std::filesystem::path folder);

  /// Returns bytes that have no value yet. Throws DiskFull. Their room on disk is reserved at once.
  [[nodiscard]] void* allocate(std::size_t bytes) const;
  static void release(void* memory, std::size_t bytes) noexcept;

 private:
  explicit DiskMemory(std::filesystem::path folder) : folder_{std::move(folder)} {}
  std::filesystem::path folder_;
};

/// Allocates as UnsetAllocator, or on disk.
template <class T>
struct DiskAllocator : UnsetAllocator<T> {
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;
  using is_always_equal = std::false_type;
  template <class U>
  struct rebind {
    using other = DiskAllocator<U>;
  };

  DiskAllocator() = default;
  explicit DiskAllocator(std::shared_ptr<const DiskMemory> in) : disk{std::move(in)} {}
  template <class U>
  DiskAllocator(const DiskAllocator<U>& other) : disk{other.disk} {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] T* allocate(std::size_t count) {
    return disk ? static_cast<T*>(disk->allocate(count * sizeof(T))) : UnsetAllocator<T>::allocate(count);
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    disk ? DiskMemory::release(memory, count * sizeof(T)) : UnsetAllocator<T>::deallocate(memory, count);
  }
  template <class U>
  [[nodiscard]] bool operator==(const DiskAllocator<U>& other) const {
    return disk == other.disk;
  }

  std::shared_ptr<const DiskMemory> disk;  ///< null: in memory
};

/// UninitializedVector that may lie on disk.
template <class T>
using DiskVector = std::vector<T, DiskAllocator<T>>;

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#pragma once
// Compute: memory and kernels of a device. HostCompute runs the kernels in loops on the host, so that tests and
// machines without a GPU execute the same source. Buffer: an array in a device's memory.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "saccade/core/executor.hpp"
#include "saccade/core/result.hpp"
#include "saccade/cuda/internal/kernel.hpp"

namespace saccade::internal::cuda {

/// Context of the errors that mean: the device has too little room. Work on a part of the map may succeed where these
/// come; no other error of a device says so.
inline constexpr const char* kNoRoom{"memory of the GPU"};
[[nodiscard]] inline bool is_no_room(const Error& error) { return error.context == kNoRoom; }

/// A device's memory and kernels. One thread at a time.
class Compute {
 public:
  Compute() = default;
  Compute(const Compute&) = delete;
  Compute& operator=(const Compute&) = delete;
  virtual ~Compute() = default;

  /// Tells whether the device is gone for good, with its memory: every later call fails.
  [[nodiscard]] virtual bool is_lost() const { return false; }

  /// Returns memory of undefined content; is_no_room where it does not suffice.
  [[nodiscard]] virtual Result<void*> allocate(std::size_t bytes) = 0;
  virtual void release(void* memory) noexcept = 0;
  [[nodiscard]] virtual Status copy_in(void* to, const void* from, std::size_t bytes) = 0;
  [[nodiscard]] virtual Status copy_out(void* to, const void* from, std::size_t bytes) = 0;
  [[nodiscard]] virtual Status copy_within(void* to, const void* from, std::size_t bytes) = 0;
  [[nodiscard]] virtual Status fill(void* memory, std::uint8_t value, std::size_t bytes) = 0;
  /// Starts a kernel. Kernels and copies run in the order in which they were started.
  [[nodiscard]] virtual Status launch(const KernelEntry& kernel, std::size_t blocks, const void* arguments) = 0;
  /// Waits until everything that was started has ended.
  [[nodiscard]] virtual Status finish() = 0;
};

template <class Kernel>
[[nodiscard]] Status launch(Compute& compute, std::size_t blocks, const typename Kernel::Arguments& arguments) {
  return blocks == 0 ? Status{} : compute.launch(kernel_entry<Kernel>(), blocks, &arguments);
}

/// Runs blocks in parallel on the host, and the threads of a block one after the other.
class HostCompute final : public Compute {
 public:
  /// @param memory_bytes  limit of what may be allocated at a time.
  /// @param order         order of a block's threads and of the blocks: 0 by index, else one for each number.
  explicit HostCompute(Executor executor, std::size_t memory_bytes = ~std::size_t{0}, std::uint32_t order = 0)
      : executor_{std::move(executor)}, memory_bytes_{memory_bytes}, order_{order} {}
  [[nodiscard]] Result<void*> allocate(std::size_t bytes) override;
  void release(void* memory) noexcept override;
  [[nodiscard]] Status copy_in(void* to, const void* from, std::size_t bytes) override;
  [[nodiscard]] Status copy_out(void* to, const void* from, std::size_t bytes) override;
  [[nodiscard]] Status copy_within(void* to, const void* from, std::size_t bytes) override;
  [[nodiscard]] Status fill(void* memory, std::uint8_t value, std::size_t bytes) override;
  [[nodiscard]] Status launch(const KernelEntry& kernel, std::size_t blocks, const void* arguments) override;
  [[nodiscard]] Status finish() override { return {}; }

 private:
  Executor executor_;
  std::size_t memory_bytes_;
  std::size_t used_bytes_{0};
  std::uint32_t order_;
};

/// Array in a device's memory; grows, and never shrinks but by free(). The Compute must outlive it.
template <class T>
class Buffer {
 public:
  explicit Buffer(Compute& compute) : compute_{&compute} {}
  Buffer(Buffer&& other) noexcept
      : compute_{other.compute_},
        data_{std::exchange(other.data_, nullptr)},
        capacity_{std::exchange(other.capacity_, 0)} {}
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(compute_, other.compute_);
    std::swap(data_, other.data_);
    std::swap(capacity_, other.capacity_);
    return *this;
  }
  ~Buffer() {
    if (data_ != nullptr) compute_->release(data_);
  }

  [[nodiscard]] T* data() const { return data_; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }
  /// Gives the memory back.
  void free() noexcept { const Buffer old{std::move(*this)}; }
  /// Makes room for `count` elements; keeps the first `keep` of them.
  [[nodiscard]] Status reserve(std::size_t count, std::size_t keep = 0) {
    if (count <= capacity_) return {};
    SACCADE_TRY(void* const memory, compute_->allocate(count * sizeof(T)));
    Buffer grown{*compute_};
    grown.data_ = static_cast<T*>(memory);
    grown.capacity_ = count;
    if (keep > 0) SACCADE_CHECK(compute_->copy_within(grown.data_, data_, keep * sizeof(T)));
    *this = std::move(grown);
    return {};
  }
  [[nodiscard]] Status fill(std::uint8_t value, std::size_t count) {
    return count == 0 ? Status{} : compute_->fill(data_, value, count * sizeof(T));
  }
  /// Copies elements from the host, with room for them.
  [[nodiscard]] Status assign(std::span<const T> elements) {
    SACCADE_CHECK(reserve(elements.size()));
    return elements.empty() ? Status{} : compute_->copy_in(data_, elements.data(), elements.size_bytes());
  }
  /// Copies the first elements to the host.
  [[nodiscard]] Status read(std::span<T> elements) const {
    return elements.empty() ? Status{} : compute_->copy_out(elements.data(), data_, elements.size_bytes());
  }

 private:
  Compute* compute_;
  T* data_{nullptr};
  std::size_t capacity_{0};
};

}  // namespace saccade::internal::cuda

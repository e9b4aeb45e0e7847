// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <cstring>

#include "saccade/cuda/internal/compute.hpp"

namespace saccade::internal::cuda {
namespace {

constexpr std::size_t kHeader{64};  // holds a block's size; keeps its alignment

}  // namespace

Result<void*> HostCompute::allocate(std::size_t bytes) {
  void* const memory = bytes > memory_bytes_ - used_bytes_ ? nullptr : std::aligned_alloc(kHeader, [&] {
    return (bytes + 2 * kHeader - 1) / kHeader * kHeader;
  }());
  if (memory == nullptr) {
    return Error{Errc::unavailable, "the device has no room for " + std::to_string(bytes) + " bytes more", kNoRoom};
  }
  std::memcpy(memory, &bytes, sizeof(bytes));
  used_bytes_ += bytes;
  return static_cast<std::byte*>(memory) + kHeader;
}

void HostCompute::release(void* memory) noexcept {
  std::byte* const block = static_cast<std::byte*>(memory) - kHeader;
  std::size_t bytes{0};
  std::memcpy(&bytes, block, sizeof(bytes));
  used_bytes_ -= bytes;
  std::free(block);
}

Status HostCompute::copy_in(void* to, const void* from, std::size_t bytes) {
  std::memcpy(to, from, bytes);
  return {};
}
Status HostCompute::copy_out(void* to, const void* from, std::size_t bytes) {
  std::memcpy(to, from, bytes);
  return {};
}
Status HostCompute::copy_within(void* to, const void* from, std::size_t bytes) {
  std::memcpy(to, from, bytes);
  return {};
}
Status HostCompute::fill(void* memory, std::uint8_t value, std::size_t bytes) {
  std::memset(memory, value, bytes);
  return {};
}

Status HostCompute::launch(const KernelEntry& kernel, std::size_t blocks, const void* arguments) {
  constexpr std::size_t kBlocksAtATime{16};
  executor_.parallel_for(blocks, kBlocksAtATime, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) {
      const std::size_t next = order_ % 2 == 0 ? block : blocks - 1 - block;
      // Each block and launch in its own order: the launches of a kernel differ in nothing else.
      const std::uint32_t order = order_ == 0 ? 0 : order_ + static_cast<std::uint32_t>(next) * 7U + 1U;
      kernel.run_block(arguments, static_cast<std::uint32_t>(next), order);
    }
  });
  return {};
}

}  // namespace saccade::internal::cuda

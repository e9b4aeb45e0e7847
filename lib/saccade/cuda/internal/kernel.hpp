// SPDX-License-Identifier: Apache-2.0
#pragma once
// Kernels as plain structs that run on the host and on the device, and what they may use of either.
//
// A kernel has `Arguments` (trivially copyable), `Shared` (the block's memory), `kName`, `kThreads` (of a block),
// `kBlocksPerUnit` (blocks that shall fit a multiprocessor at a time, which limits registers), `kPhases`, and
// run<phase>(arguments, shared, thread). All threads of a block end a phase before the next begins, so that phases take
// the place of barriers: on the host, a phase is a loop over the threads.

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "saccade/core/host_device.hpp"

namespace saccade::internal::cuda {

/// A thread and its block.
struct Thread {
  std::uint32_t block;
  std::uint32_t index;
};

template <class T>
SACCADE_HD inline T atomic_add(T& value, T by) {
  return __atomic_fetch_add(&value, by, __ATOMIC_RELAXED);
}
template <class T>
SACCADE_HD inline void atomic_or(T& value, T bits) {
  __atomic_fetch_or(&value, bits, __ATOMIC_RELAXED);
}

template <class Kernel, int kPhase = 0, class Run>
SACCADE_HD inline void for_each_phase(const Run& run) {
  if constexpr (kPhase < Kernel::kPhases) {
    run(std::integral_constant<int, kPhase>{});
    for_each_phase<Kernel, kPhase + 1>(run);
  }
}

/// A kernel's name on the device, and one block of it on the host.
struct KernelEntry {
  const char* name;
  unsigned threads;
  std::size_t argument_bytes;
  void (*run_block)(const void* arguments, std::uint32_t block);
};

template <class Kernel>
void run_block(const void* arguments, std::uint32_t block) {
  const auto& of_kernel = *static_cast<const typename Kernel::Arguments*>(arguments);
  typename Kernel::Shared shared;
  for_each_phase<Kernel>([&](auto phase) {
    for (std::uint32_t index = 0; index < Kernel::kThreads; ++index) {
      Kernel::template run<decltype(phase)::value>(of_kernel, shared, Thread{block, index});
    }
  });
}

template <class Kernel>
[[nodiscard]] KernelEntry kernel_entry() {
  static_assert(std::is_trivially_copyable_v<typename Kernel::Arguments> && sizeof(typename Kernel::Arguments) <= 4096);
  return {Kernel::kName, Kernel::kThreads, sizeof(typename Kernel::Arguments), &run_block<Kernel>};
}

}  // namespace saccade::internal::cuda

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
  void (*run_block)(const void* arguments, std::uint32_t block, std::uint32_t order);
};

/// Tells which of `count` threads, a power of two, comes next in a phase. @param order 0: by index; else another order
/// for each number and phase, since a GPU promises none.
[[nodiscard]] constexpr std::uint32_t thread_in_order(std::uint32_t next, std::uint32_t count, std::uint32_t order,
                                                      std::uint32_t phase) {
  if (order == 0) return next;
  const std::uint32_t mixed = (order + phase) * 0x9E3779B9U;
  return ((next * (mixed >> 8U | 1U)) ^ mixed >> 20U) & (count - 1);  // each step maps the threads one to one
}

template <class Kernel>
void run_block(const void* arguments, std::uint32_t block, std::uint32_t order) {
  static_assert((Kernel::kThreads & (Kernel::kThreads - 1)) == 0);
  const auto& of_kernel = *static_cast<const typename Kernel::Arguments*>(arguments);
  typename Kernel::Shared shared;
  for_each_phase<Kernel>([&](auto phase) {
    for (std::uint32_t next = 0; next < Kernel::kThreads; ++next) {
      const std::uint32_t index = thread_in_order(next, Kernel::kThreads, order, decltype(phase)::value);
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

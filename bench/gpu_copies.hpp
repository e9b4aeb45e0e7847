// SPDX-License-Identifier: Apache-2.0
#pragma once
// CopyRates: what a device's memory and its link to the host carry. LeastBytes: what a call has to move at least, and
// its share of that.

#include <cstdint>
#include <string>

#include "saccade/cuda/gpu_map.hpp"
#include "saccade/cuda/internal/compute.hpp"

namespace saccade::bench {

/// Rates of plain copies, in 10⁹ bytes a second.
struct CopyRates {
  double to_gpu_gbs{0.0};    ///< from pageable memory of the host, as the maps send
  double from_gpu_gbs{0.0};  ///< to such memory
  double memory_gbs{0.0};    ///< the device's memory: a copy within it reads and writes each byte, and both count
};

/// Times copies, and prints "copies". The median of some rounds.
[[nodiscard]] Result<CopyRates> check_copies(internal::cuda::Compute& device, bool quick);

/// Bytes that a call moves at least, each counted once, whatever caches do.
struct LeastBytes {
  double sent{0.0};    ///< over the link to the device
  double read{0.0};    ///< over the link from the device
  double memory{0.0};  ///< read from, or written to, the device's memory

  LeastBytes& operator+=(const LeastBytes& other);
};
/// Returns what a map sent and read between two calls of GpuMap::traffic.
[[nodiscard]] LeastBytes link_bytes(const GpuTraffic& before, const GpuTraffic& after);

/// Returns a member of a JSON object, "least": these bytes; what of them a second in the device's memory, and as a
/// share of its rate; and the share of the time that copies over the link would take at its rates.
[[nodiscard]] std::string share_of_rates(const CopyRates& rates, const LeastBytes& bytes, double took_ms);

}  // namespace saccade::bench

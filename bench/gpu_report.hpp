// SPDX-License-Identifier: Apache-2.0
#pragma once
// GpuCheck: the device and the results that the parts of bench_gpu_check share.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gpu_copies.hpp"
#include "gpu_device.hpp"
#include "saccade/cuda/internal/gpu_map_impl.hpp"
#include "saccade/map/raycast.hpp"

namespace saccade::bench {

/// Arguments of every part.
struct GpuCheck {
  bool emulated{false};
  bool quick{false};
  std::shared_ptr<internal::cuda::Compute> device;
  CopyRates rates{};
};

/// Makes a map on the one device, with no more than some of its memory.
[[nodiscard]] inline GpuMap open(const GpuCheck& check, const TsdfConfig& config,
                                 std::size_t memory_bytes = kAllMemory) {
  return internal::cuda::GpuMapMaker::make(config, std::make_unique<BorrowedCompute>(check.device, memory_bytes));
}

/// Ends the program on an error.
template <class T>
T need(Result<T> result) {
  if (result.ok()) return std::move(result).value();
  std::fprintf(stderr, "gpu_check: %s\n", result.error().to_string().c_str());
  std::exit(1);
}
inline void need(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "gpu_check: %s\n", status.error().to_string().c_str());
  std::exit(1);
}

[[nodiscard]] inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

[[nodiscard]] inline const char* text_of(bool value) { return value ? "true" : "false"; }

/// Returns members of a JSON object: what is asked of a time, and whether that is met.
[[nodiscard]] inline std::string limit(double took_ms, double asked_ms) {
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "\"asked_ms\": %.1f, \"met\": %s", asked_ms, text_of(took_ms <= asked_ms));
  return text.data();
}

[[nodiscard]] inline int different_pixels(const SurfaceView& a, const SurfaceView& b) {
  int different{0};
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    different += a.depth.data()[i] != b.depth.data()[i] || a.normals.data()[i] != b.normals.data()[i] ? 1 : 0;
  }
  return different;
}

}  // namespace saccade::bench

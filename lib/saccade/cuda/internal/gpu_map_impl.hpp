// SPDX-License-Identifier: Apache-2.0
#pragma once
// GpuMap::Impl: the parts of a GpuMap, made on any device.

#include <memory>
#include <optional>
#include <string>

#include "saccade/cuda/gpu_map.hpp"
#include "saccade/cuda/internal/gpu_fusion.hpp"
#include "saccade/cuda/internal/gpu_gain.hpp"
#include "saccade/cuda/internal/gpu_raycast.hpp"
#include "saccade/cuda/internal/metered_compute.hpp"
#include "saccade/cuda/internal/paged_bricks.hpp"
#include "saccade/cuda/internal/surface_on_device.hpp"

namespace saccade {

/// Members in the order of their lives: buffers go before the device does.
class GpuMap::Impl {
 public:
  Impl(const TsdfConfig& config, std::unique_ptr<internal::cuda::Compute> device, std::string name)
      : backend{std::move(name)}, compute{std::move(device)}, bricks{compute, config, [this] { free_scratch(); }} {}

  std::string backend;
  internal::cuda::MeteredCompute compute;
  internal::cuda::PagedBricks bricks;
  internal::cuda::GpuFusion fusion{compute};
  internal::cuda::GpuGain gain{compute};
  internal::cuda::GpuRaycast raycast{compute};
  internal::cuda::SurfaceOnDevice surface{compute};
  bool is_fusing{false};         ///< the buffers of the fusion are in use
  std::optional<Error> problem;  ///< last error after which the CPU had to go on
  bool told_loss{false};         ///< it was the loss of the device

  /// Gives back the buffers of all work but that at hand.
  void free_scratch() {
    if (!is_fusing) fusion.free_buffers();
    gain.free_buffers();
    raycast.free_buffers();
    surface.free_buffers();
  }

  /// Calls work() with the bricks of a box on the device; again without the buffers of other work, and then with these
  /// bricks alone, where memory was short. Work that the device cannot do at all must be refused before.
  template <class Work>
  auto with_bricks(const IndexBox& needed, const Work& work) -> decltype(work()) {
    SACCADE_CHECK(bricks.bring_in(needed));
    auto result = work();
    if (result.ok() || !internal::cuda::is_no_room(result.error())) return result;
    free_scratch();
    result = work();
    if (result.ok() || !internal::cuda::is_no_room(result.error()) || bricks.is_paged_to(needed)) return result;
    SACCADE_CHECK(bricks.note_too_much());
    SACCADE_CHECK(bricks.page_to(needed));
    return work();
  }

  /// Takes note of an error of the device on its way to the caller. What the caller did wrong is none.
  template <class T>
  T noted(T result) {
    if (result.ok() || result.error().code == Errc::invalid_argument || told_loss) return result;
    problem = result.error();
    told_loss = bricks.is_lost();
    return result;
  }
};

namespace internal::cuda {

/// Makes maps on devices that a test or a benchmark provides.
struct GpuMapMaker {
  [[nodiscard]] static GpuMap make(const TsdfConfig& config, std::unique_ptr<Compute> device) {
    return GpuMap{std::make_unique<GpuMap::Impl>(config, std::move(device), "cuda emulated")};
  }
};

}  // namespace internal::cuda

}  // namespace saccade

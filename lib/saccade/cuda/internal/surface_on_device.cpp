// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/internal/surface_on_device.hpp"

#include <algorithm>
#include <array>

namespace saccade::internal::cuda {

SurfaceOnDevice::SurfaceOnDevice(Compute& compute)
    : compute_{compute},
      states_{compute},
      roles_{compute},
      squared_{compute},
      shares_{compute},
      count_{compute},
      exposed_{compute},
      lines_{compute},
      cameras_m_{compute},
      visible_{compute} {}

Status SurfaceOnDevice::check(std::uint64_t ticket) const {
  if (ticket != 0 && ticket == ticket_) return {};
  return Error{Errc::invalid_argument, "the device holds the states of another volume by now", "cuda"};
}

Result<std::uint64_t> SurfaceOnDevice::read_states(const BrickStore& bricks, double voxel_size_m, const IndexBox& box,
                                                   std::span<VoxelState> states) {
  ticket_ = 0;
  SACCADE_EXPECTS(static_cast<double>(states.size()) == box.count());
  SACCADE_CHECK(states_.reserve(states.size()));
  StatesArguments a{};
  a.map = bricks.view();
  const IndexBox met = parents(box);
  const Index3 size = met.size();
  a.bricks = {met.lo, static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y),
              static_cast<std::uint32_t>(size.z)};
  a.lo = box.lo;
  a.size = box.size();
  a.states = states_.data();
  SACCADE_CHECK(launch<ReadStates>(compute_, a.bricks.count(), a));
  static_assert(sizeof(VoxelState) == 1);
  SACCADE_CHECK(states_.read({reinterpret_cast<std::uint8_t*>(states.data()), states.size()}));
  volume_ = {box.lo, box.size(), voxel_size_m, states_.data()};
  return ticket_ = ++tickets_;
}

Result<std::vector<ExposedVoxel>> SurfaceOnDevice::exposed(std::uint64_t ticket, const ExposureTask& task) {
  SACCADE_CHECK(check(ticket));
  const auto voxels = static_cast<std::size_t>(volume_.count());
  const auto layers = static_cast<std::size_t>((volume_.size.z + 1) / 2);
  const std::size_t cells = static_cast<std::size_t>(task.cell_layer) * layers;
  const std::uint16_t farthest = *std::max_element(task.squared, task.squared + cells);
  SACCADE_CHECK(roles_.assign({task.roles, voxels}));
  SACCADE_CHECK(squared_.assign({task.squared, cells}));
  SACCADE_CHECK(shares_.assign({task.beside_shares, std::size_t{farthest} + 1}));
  ExposureArguments a{};
  a.task = task;
  a.task.volume = volume_;
  a.task.roles = roles_.data();
  a.task.squared = squared_.data();
  a.task.beside_shares = shares_.data();
  constexpr std::size_t kLeast{1 << 16};
  SACCADE_CHECK(exposed_.reserve(kLeast));
  std::array<std::uint32_t, 1> count{};
  for (;;) {
    SACCADE_CHECK(count_.assign(std::array<std::uint32_t, 1>{}));
    a.count = count_.data();
    a.exposed = exposed_.data();
    a.room = static_cast<std::uint32_t>(exposed_.capacity());
    SACCADE_CHECK(launch<ExposeVoxels>(compute_, blocks_for<ExposeVoxels>(voxels), a));
    SACCADE_CHECK(count_.read(count));
    if (count[0] <= exposed_.capacity()) break;
    SACCADE_CHECK(exposed_.reserve(count[0]));
  }
  std::vector<ExposedVoxel> exposed(count[0]);
  SACCADE_CHECK(exposed_.read(exposed));
  std::sort(exposed.begin(), exposed.end(),
            [](const ExposedVoxel& one, const ExposedVoxel& other) { return one.voxel < other.voxel; });
  return exposed;
}

Result<std::vector<std::uint8_t>> SurfaceOnDevice::in_sight(std::uint64_t ticket, std::span<const LineOfSight> lines,
                                                            std::span<const Eigen::Vector3d> cameras_m,
                                                            double through_m) {
  SACCADE_CHECK(check(ticket));
  std::vector<std::uint8_t> visible(lines.size());
  if (lines.empty()) return visible;
  static_assert(sizeof(LineOfSight) == 2 * sizeof(std::uint32_t) && sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  SACCADE_CHECK(lines_.assign({&lines.front().voxel, 2 * lines.size()}));
  SACCADE_CHECK(cameras_m_.assign({cameras_m.front().data(), 3 * cameras_m.size()}));
  SACCADE_CHECK(visible_.reserve(lines.size()));
  SACCADE_CHECK(launch<TraceSights>(compute_, blocks_for<TraceSights>(lines.size()),
                                    {volume_, lines_.data(), cameras_m_.data(), through_m,
                                     static_cast<std::uint32_t>(lines.size()), visible_.data()}));
  SACCADE_CHECK(visible_.read(visible));
  return visible;
}

void SurfaceOnDevice::free_buffers() noexcept {
  ticket_ = 0;
  states_.free();
  roles_.free();
  squared_.free();
  shares_.free();
  count_.free();
  exposed_.free();
  lines_.free();
  cameras_m_.free();
  visible_.free();
}

}  // namespace saccade::internal::cuda

// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/internal/gpu_alignment.hpp"

#include <array>
#include <span>
#include <vector>

#include "saccade/cuda/internal/brick_store.hpp"
#include "saccade/tracking/internal/align_loop.hpp"

namespace saccade::internal::cuda {
namespace {

/// Puts the sums of a chunk into the normal equations, as the CPU does.
NormalEquations equations_of(std::span<const double> sums) {
  NormalEquations equations;
  std::size_t term{0};
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) equations.JtJ(j, i) = sums[term++];
    equations.Jtr(i) = sums[term++];
  }
  equations.squared_residuals = sums[term];
  return equations;
}

}  // namespace

Status Planes::assign(const PointImage& image) {
  std::vector<float> all;
  all.reserve(4 * image.z.size());
  for (const Image<float>* plane : {&image.z, &image.nx, &image.ny, &image.nz}) {
    all.insert(all.end(), plane->data(), plane->data() + plane->size());
  }
  return memory_.assign(all);
}

LevelPoints Planes::level(int width, int height, int stride) const {
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(width) * height;
  const float* const z = memory_.data();
  const auto over = [stride](int pixels) { return (pixels + stride - 1) / stride; };
  return {z, z + size, z + 2 * size, z + 3 * size, over(width), over(height), stride};
}

Result<IcpResult> GpuAlignment::align(const PointImage& measured, const PointImage& model, const PinholeCamera& camera,
                                      const Pose& T_model_camera_start, const IcpConfig& config) {
  SACCADE_CHECK(config.validate());
  SACCADE_CHECK(measured_.assign(measured));
  SACCADE_CHECK(model_.assign(model));
  const Alignment alignment{model, camera, {config.max_distance_m, config.max_normal_angle_rad}};
  const auto linearize = [&](const Pose& T_model_camera, int stride) {
    PairingTask task = alignment.task(T_model_camera);
    task.model = model_.level(camera.width, camera.height, 1);
    task.measured = measured_.level(camera.width, camera.height, stride);
    return sums_of(task, camera.width);
  };
  return align_by(linearize, measured, model, camera, T_model_camera_start, config);
}

Result<NormalEquations> GpuAlignment::sums_of(const PairingTask& task, int measured_width) {
  const std::size_t pixels =
      static_cast<std::size_t>(task.measured.width) * static_cast<std::size_t>(task.measured.height);
  AlignArguments a{};
  a.task = task;
  a.measured_width = measured_width;
  a.rows_per_chunk = static_cast<int>(kRowsPerChunk);
  a.chunks = (task.measured.height + a.rows_per_chunk - 1) / a.rows_per_chunk;
  const std::size_t sums = static_cast<std::size_t>(a.chunks) * kPairTerms;
  SACCADE_CHECK(terms_.reserve(pixels * kPairTerms));
  SACCADE_CHECK(lane_sums_.reserve(sums * kPairLanes));
  SACCADE_CHECK(chunk_sums_.reserve(sums));
  SACCADE_CHECK(pairs_.assign(std::array<std::uint32_t, 1>{0}));
  a.terms = terms_.data();
  a.lane_sums = lane_sums_.data();
  a.chunk_sums = chunk_sums_.data();
  a.pairs = pairs_.data();
  SACCADE_CHECK(launch<PairPixels>(compute_, blocks_for<PairPixels>(pixels), a));
  SACCADE_CHECK(launch<SumLanes>(compute_, blocks_for<SumLanes>(sums * kPairLanes), a));
  SACCADE_CHECK(launch<SumChunks>(compute_, blocks_for<SumChunks>(sums), a));
  std::vector<double> of_chunks(sums);
  std::array<std::uint32_t, 1> pairs{};
  SACCADE_CHECK(chunk_sums_.read(of_chunks));
  SACCADE_CHECK(pairs_.read(pairs));
  NormalEquations equations;
  for (std::size_t first = 0; first < sums; first += kPairTerms) {
    equations += equations_of(std::span{of_chunks}.subspan(first, kPairTerms));
  }
  equations.pairs = pairs[0];
  return equations;
}

}  // namespace saccade::internal::cuda

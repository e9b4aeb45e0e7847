// SPDX-License-Identifier: Apache-2.0
#pragma once
// SACCADE_HD marks per-voxel and per-ray functions that run on the host and, where CUDA compiles them, on the device.

#if defined(__clang__) && defined(__CUDA__)
#define SACCADE_HD __attribute__((host)) __attribute__((device))
#elif defined(__CUDACC__)
#define SACCADE_HD __host__ __device__
#else
#define SACCADE_HD
#endif

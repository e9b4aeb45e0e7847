// SPDX-License-Identifier: Apache-2.0
#pragma once
// Driver: the few functions of CUDA's driver library that the back end calls, found at run time. No toolkit is needed.

#include <cstddef>
#include <string>

#include "saccade/core/result.hpp"

namespace saccade::internal::cuda {

using DriverResult = int;  ///< CUresult; 0 is success
using DeviceHandle = int;
using DeviceAddress = unsigned long long;
using ContextHandle = struct CUctx_st*;
using ModuleHandle = struct CUmod_st*;
using FunctionHandle = struct CUfunc_st*;
using StreamHandle = struct CUstream_st*;

/// Meaning of a result of the driver for the work at hand.
enum class DriverFault {
  none,
  no_room,  ///< the GPU's memory does not suffice; all that it holds is intact
  lost,     ///< the GPU, or the context with all its memory, is gone for good
  other,    ///< the call alone failed
};
[[nodiscard]] DriverFault fault_of(DriverResult result);

/// Functions of libcuda.so.1 by their names there. The parameters are those of the driver API, versions 11.0 to 13.
struct Driver {
  DriverResult (*cuInit)(unsigned flags);
  DriverResult (*cuDriverGetVersion)(int* version);
  DriverResult (*cuDeviceGetCount)(int* count);
  DriverResult (*cuDeviceGet)(DeviceHandle* device, int ordinal);
  DriverResult (*cuDeviceGetName)(char* name, int length, DeviceHandle device);
  DriverResult (*cuDeviceTotalMem_v2)(std::size_t* bytes, DeviceHandle device);
  DriverResult (*cuDeviceGetAttribute)(int* value, int attribute, DeviceHandle device);
  DriverResult (*cuDevicePrimaryCtxRetain)(ContextHandle* context, DeviceHandle device);
  DriverResult (*cuDevicePrimaryCtxRelease_v2)(DeviceHandle device);
  DriverResult (*cuCtxPushCurrent_v2)(ContextHandle context);
  DriverResult (*cuCtxPopCurrent_v2)(ContextHandle* context);
  DriverResult (*cuModuleLoadDataEx)(ModuleHandle* module, const void* image, unsigned options, int* names,
                                     void** values);
  DriverResult (*cuModuleUnload)(ModuleHandle module);
  DriverResult (*cuModuleGetFunction)(FunctionHandle* function, ModuleHandle module, const char* name);
  DriverResult (*cuFuncGetAttribute)(int* value, int attribute, FunctionHandle function);
  DriverResult (*cuMemAlloc_v2)(DeviceAddress* address, std::size_t bytes);
  DriverResult (*cuMemFree_v2)(DeviceAddress address);
  DriverResult (*cuMemGetInfo_v2)(std::size_t* free_bytes, std::size_t* total_bytes);
  DriverResult (*cuMemcpyHtoD_v2)(DeviceAddress to, const void* from, std::size_t bytes);
  DriverResult (*cuMemcpyDtoH_v2)(void* to, DeviceAddress from, std::size_t bytes);
  DriverResult (*cuMemcpyDtoD_v2)(DeviceAddress to, DeviceAddress from, std::size_t bytes);
  DriverResult (*cuMemsetD8_v2)(DeviceAddress address, unsigned char value, std::size_t bytes);
  DriverResult (*cuLaunchKernel)(FunctionHandle function, unsigned grid_x, unsigned grid_y, unsigned grid_z,
                                 unsigned block_x, unsigned block_y, unsigned block_z, unsigned shared_bytes,
                                 StreamHandle stream, void** parameters, void** extra);
  DriverResult (*cuCtxSynchronize)();
  DriverResult (*cuGetErrorString)(DriverResult status, const char** text);
  DriverResult (*cuFuncLoad)(FunctionHandle function);  ///< since 12.4; nullptr in older drivers

  /// Returns the library's functions, loaded once per process; unavailable, with the reason, where there is no driver.
  [[nodiscard]] static Result<const Driver*> load();
  /// Turns a result of the driver into a Status that names what failed; is_no_room where memory did not suffice.
  [[nodiscard]] Status check(DriverResult status, const std::string& action) const;
};

}  // namespace saccade::internal::cuda

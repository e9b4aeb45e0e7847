// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/internal/driver.hpp"

#include <dlfcn.h>

#include "saccade/cuda/internal/compute.hpp"

namespace saccade::internal::cuda {
namespace {

constexpr const char* kLibrary{"libcuda.so.1"};
constexpr DriverResult kSuccess{0};

/// The library's functions, or why there are none. The library stays loaded.
struct Loaded {
  Driver driver{};
  std::string problem;
};

Loaded load_driver() {
  Loaded loaded;
  void* const library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const why = dlerror();  // a library that lacks another, say, is there and does not load
    loaded.problem = "no NVIDIA driver is installed (" + std::string{kLibrary} + " does not load" +
                     (why != nullptr ? ": " + std::string{why} : std::string{}) + ")";
    return loaded;
  }
  const auto find = [&](auto& function, const char* name) {
    void* const address = dlsym(library, name);
    if (address == nullptr) {
      if (loaded.problem.empty()) loaded.problem = std::string{kLibrary} + " lacks " + name + "; update the driver";
      return;
    }
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(address);
  };
  Driver& d = loaded.driver;
#define SACCADE_FIND(name) find(d.name, #name)
  SACCADE_FIND(cuInit);
  SACCADE_FIND(cuDriverGetVersion);
  SACCADE_FIND(cuDeviceGetCount);
  SACCADE_FIND(cuDeviceGet);
  SACCADE_FIND(cuDeviceGetName);
  SACCADE_FIND(cuDeviceTotalMem_v2);
  SACCADE_FIND(cuDeviceGetAttribute);
  SACCADE_FIND(cuDevicePrimaryCtxRetain);
  SACCADE_FIND(cuDevicePrimaryCtxRelease_v2);
  SACCADE_FIND(cuCtxPushCurrent_v2);
  SACCADE_FIND(cuCtxPopCurrent_v2);
  SACCADE_FIND(cuModuleLoadDataEx);
  SACCADE_FIND(cuModuleUnload);
  SACCADE_FIND(cuModuleGetFunction);
  SACCADE_FIND(cuFuncGetAttribute);
  SACCADE_FIND(cuMemAlloc_v2);
  SACCADE_FIND(cuMemFree_v2);
  SACCADE_FIND(cuMemGetInfo_v2);
  SACCADE_FIND(cuMemcpyHtoD_v2);
  SACCADE_FIND(cuMemcpyDtoH_v2);
  SACCADE_FIND(cuMemcpyDtoD_v2);
  SACCADE_FIND(cuMemsetD8_v2);
  SACCADE_FIND(cuLaunchKernel);
  SACCADE_FIND(cuCtxSynchronize);
  SACCADE_FIND(cuGetErrorString);
#undef SACCADE_FIND
  d.cuFuncLoad = reinterpret_cast<decltype(d.cuFuncLoad)>(dlsym(library, "cuFuncLoad"));
  if (!loaded.problem.empty()) return loaded;
  if (const Status started = d.check(d.cuInit(0), "starting the NVIDIA driver"); !started.ok()) {
    loaded.problem = started.error().message;
  }
  return loaded;
}

}  // namespace

Result<const Driver*> Driver::load() {
  static const Loaded loaded = load_driver();
  if (!loaded.problem.empty()) return Error{Errc::unavailable, loaded.problem, "cuda"};
  return &loaded.driver;
}

DriverFault fault_of(DriverResult result) {
  switch (result) {
    case kSuccess: return DriverFault::none;
    case 2: return DriverFault::no_room;  // CUDA_ERROR_OUT_OF_MEMORY
    case 4:                               // DEINITIALIZED
    case 46:                              // DEVICE_UNAVAILABLE
    case 214:                             // ECC_UNCORRECTABLE
    case 219:                             // INVALID_GRAPHICS_CONTEXT
    case 220:                             // NVLINK_UNCORRECTABLE
    case 226:                             // CONTAINED
    case 700:                             // ILLEGAL_ADDRESS
    case 701:                             // LAUNCH_OUT_OF_RESOURCES: no kernel of ours asks for more than another time
    case 702:                             // LAUNCH_TIMEOUT
    case 704:                             // PEER_ACCESS_ALREADY_ENABLED: another owner meddles with the context
    case 709:                             // CONTEXT_IS_DESTROYED
    case 710:                             // ASSERT
    case 714:                             // HARDWARE_STACK_ERROR
    case 715:                             // ILLEGAL_INSTRUCTION
    case 716:                             // MISALIGNED_ADDRESS
    case 717:                             // INVALID_ADDRESS_SPACE
    case 718:                             // INVALID_PC
    case 719:                             // LAUNCH_FAILED
    case 721:                             // TENSOR_MEMORY_LEAK
    case 810:                             // MPS_CLIENT_TERMINATED
    case 911:                             // EXTERNAL_DEVICE
    case 999: return DriverFault::lost;   // UNKNOWN
    default: return DriverFault::other;
  }
}

Status Driver::check(DriverResult result, const std::string& action) const {
  if (result == kSuccess) return {};
  const char* text = nullptr;
  const bool known = cuGetErrorString(result, &text) == kSuccess && text != nullptr;
  return Error{Errc::unavailable,
               action + " failed: " + (known ? std::string{text} : "error " + std::to_string(result)),
               fault_of(result) == DriverFault::no_room ? kNoRoom : "cuda"};
}

}  // namespace saccade::internal::cuda

// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/internal/driver.hpp"

#include <dlfcn.h>

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
    loaded.problem = "no NVIDIA driver is installed (" + std::string{kLibrary} + " was not found)";
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

Status Driver::check(DriverResult result, const std::string& action) const {
  if (result == kSuccess) return {};
  const char* text = nullptr;
  const bool known = cuGetErrorString(result, &text) == kSuccess && text != nullptr;
  return Error{Errc::unavailable,
               action + " failed: " + (known ? std::string{text} : "error " + std::to_string(result)), "cuda"};
}

}  // namespace saccade::internal::cuda

// SPDX-License-Identifier: Apache-2.0
// The GPU's driver as the back end calls it, by a driver that is made up: what its errors mean, and what is asked of
// it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>

#include "saccade/cuda/internal/all_kernels.hpp"
#include "saccade/cuda/internal/cuda_compute.hpp"
#include "saccade/cuda/internal/driver.hpp"

namespace saccade::internal::cuda {
namespace {

constexpr int kIllegalAddress{700};
constexpr int kOutOfMemory{2};
constexpr int kInvalidValue{1};

/// State of the made-up driver, by which its functions, which are plain ones, answer.
struct Fake {
  int capability{90};
  int push_result{0};
  int allocate_result{0};
  int copy_result{0};
  int load_result{0};
  int pushed{0};
  int popped{0};
  int retained{0};
  int released{0};
  int copies{0};
  int launched{0};
  int loaded_modules{0};
  int allocated{0};
  bool broken{false};       // the context, for all who share it: a kernel has gone wrong there
  int outside_of_turns{0};  // calls while no one had turned to the context, or it was gone
  std::set<std::string> found;
  std::set<std::string> asked;   // for its registers
  std::set<std::string> loaded;  // by cuFuncLoad
};
Fake fake;

/// As the driver's calls in the context answer: it is the current one, and not broken.
int in_context(int result) {
  fake.outside_of_turns += fake.pushed == fake.popped || fake.retained == fake.released ? 1 : 0;
  fake.broken = fake.broken || result == kIllegalAddress;
  return fake.broken ? kIllegalAddress : result;
}

/// Names stand for functions.
FunctionHandle handle_of(const std::string& name) {
  return reinterpret_cast<FunctionHandle>(const_cast<std::string*>(&*fake.found.insert(name).first));
}
const std::string& name_behind(FunctionHandle function) { return *reinterpret_cast<const std::string*>(function); }

Driver made_up_driver(bool with_load) {
  fake = {};
  Driver d{};
  d.cuDriverGetVersion = [](int* version) { return *version = 13000, 0; };
  d.cuDeviceGetCount = [](int* count) { return *count = 1, 0; };
  d.cuDeviceGet = [](DeviceHandle* device, int) { return *device = 0, 0; };
  d.cuDeviceGetName = [](char* name, int length, DeviceHandle) {
    return std::snprintf(name, static_cast<std::size_t>(length), "Made up"), 0;
  };
  d.cuDeviceTotalMem_v2 = [](std::size_t* bytes, DeviceHandle) { return *bytes = 1000, 0; };
  d.cuDeviceGetAttribute = [](int* value, int attribute, DeviceHandle) {
    *value = attribute == 75 ? fake.capability / 10 : fake.capability % 10;
    return 0;
  };
  d.cuDevicePrimaryCtxRetain = [](ContextHandle* context, DeviceHandle) {
    ++fake.retained;
    return *context = nullptr, 0;
  };
  d.cuDevicePrimaryCtxRelease_v2 = [](DeviceHandle) { return ++fake.released, 0; };  // the last one ends the context
  d.cuCtxPushCurrent_v2 = [](ContextHandle) {
    fake.pushed += fake.push_result == 0 ? 1 : 0;
    return fake.push_result;
  };
  d.cuCtxPopCurrent_v2 = [](ContextHandle*) { return ++fake.popped, 0; };
  d.cuModuleLoadDataEx = [](ModuleHandle* module, const void*, unsigned options, int* names, void** values) {
    *module = fake.load_result == 0 ? reinterpret_cast<ModuleHandle>(&fake) : nullptr;
    if (options == 2 && names[0] == 5 && names[1] == 6 && fake.load_result != 0)
      std::snprintf(static_cast<char*>(values[0]), reinterpret_cast<std::size_t>(values[1]), "line 7: no such thing");
    fake.loaded_modules += fake.load_result == 0 ? 1 : 0;
    return in_context(fake.load_result);
  };
  d.cuModuleUnload = [](ModuleHandle) { return --fake.loaded_modules, in_context(0); };
  d.cuModuleGetFunction = [](FunctionHandle* function, ModuleHandle, const char* name) {
    return *function = handle_of(name), 0;
  };
  d.cuFuncGetAttribute = [](int* value, int attribute, FunctionHandle function) {
    if (attribute == 4) fake.asked.insert(name_behind(function));
    return *value = 40, 0;
  };
  if (with_load) d.cuFuncLoad = [](FunctionHandle function) { return fake.loaded.insert(name_behind(function)), 0; };
  d.cuMemAlloc_v2 = [](DeviceAddress* address, std::size_t bytes) {
    const int result = in_context(fake.allocate_result);
    if (result != 0) return result;
    ++fake.allocated;
    *address = reinterpret_cast<DeviceAddress>(std::malloc(bytes));
    return 0;
  };
  d.cuMemFree_v2 = [](DeviceAddress address) {
    --fake.allocated;
    return std::free(reinterpret_cast<void*>(address)), in_context(0);
  };
  d.cuMemcpyHtoD_v2 = [](DeviceAddress, const void*, std::size_t) {
    return ++fake.copies, in_context(fake.copy_result);
  };
  d.cuLaunchKernel = [](FunctionHandle, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned,
                        StreamHandle, void**, void**) { return ++fake.launched, in_context(0); };
  d.cuCtxSynchronize = [] { return in_context(0); };
  d.cuGetErrorString = [](DriverResult, const char** text) { return *text = "so it is", 0; };
  return d;
}

std::set<std::string> all_kernels() {
#define SACCADE_NAME(name, Kernel) #name,
  return {SACCADE_ALL_KERNELS(SACCADE_NAME)};
#undef SACCADE_NAME
}

TEST(CudaDriver, ErrorsAreToldApart) {
  EXPECT_EQ(fault_of(0), DriverFault::none);
  EXPECT_EQ(fault_of(kOutOfMemory), DriverFault::no_room);
  for (const int lost :
       {4, 46, 214, 219, 220, 226, 700, 701, 702, 704, 709, 710, 714, 715, 716, 717, 718, 719, 721, 810, 911, 999}) {
    EXPECT_EQ(fault_of(lost), DriverFault::lost) << lost;
  }
  for (const int other : {1, 3, 100, 101, 200, 218, 400, 500, 703, 720, 801}) {
    EXPECT_EQ(fault_of(other), DriverFault::other) << other;
  }
}

TEST(CudaDriver, EveryKernelIsLoadedBeforeAnythingRuns) {
  for (const bool with_load : {false, true}) {
    const Driver driver = made_up_driver(with_load);
    ASSERT_TRUE(open_by(driver, "some text").ok());
    EXPECT_EQ(fake.found, all_kernels());
    EXPECT_EQ(fake.asked, all_kernels());
    EXPECT_EQ(fake.loaded, with_load ? all_kernels() : std::set<std::string>{});
    EXPECT_EQ(fake.launched, 0);
    EXPECT_EQ(fake.pushed, fake.popped);
    EXPECT_EQ(fake.released, 1);
  }
}

TEST(CudaDriver, TooLittleMemoryIsNoLoss) {
  const Driver driver = made_up_driver(true);
  const auto compute = open_by(driver, "some text").value();
  fake.allocate_result = kOutOfMemory;
  const auto memory = compute->allocate(77);
  ASSERT_FALSE(memory.ok());
  EXPECT_TRUE(is_no_room(memory.error())) << memory.error().to_string();
  EXPECT_NE(memory.error().message.find("77 bytes"), std::string::npos);
  EXPECT_FALSE(compute->is_lost());
  fake.allocate_result = 0;
  Buffer<int> buffer{*compute};
  EXPECT_TRUE(buffer.reserve(3).ok());
  fake.copy_result = kInvalidValue;
  const Status copied = compute->copy_in(nullptr, nullptr, 0);
  EXPECT_FALSE(copied.ok() || is_no_room(copied.error()) || compute->is_lost());
}

TEST(CudaDriver, ALostGpuIsNotAskedAgain) {
  const Driver driver = made_up_driver(true);
  const auto compute = open_by(driver, "some text").value();
  fake.copy_result = kIllegalAddress;
  EXPECT_FALSE(compute->copy_in(nullptr, nullptr, 0).ok());
  EXPECT_TRUE(compute->is_lost());
  fake.copy_result = 0;
  const Status later = compute->copy_in(nullptr, nullptr, 0);
  EXPECT_EQ(later.error().code, Errc::unavailable);
  EXPECT_NE(later.error().message.find("lost"), std::string::npos);
  EXPECT_FALSE(compute->allocate(1).ok());
  EXPECT_FALSE(compute->finish().ok());
  EXPECT_EQ(fake.copies, 1);
}

/// Every compute retains the one context that a program has on a GPU.
TEST(CudaDriver, TwoAtOnceShareAContext) {
  const Driver driver = made_up_driver(true);
  auto first = open_by(driver, "some text").value();
  auto second = open_by(driver, "some text").value();
  EXPECT_EQ(fake.retained, 2);
  EXPECT_EQ(fake.loaded_modules, 2);
  {
    Buffer<int> of_first{*first};
    Buffer<int> of_second{*second};
    for (std::size_t size = 1; size < 4; ++size) {  // by turns, each with memory of its own
      ASSERT_TRUE(of_first.reserve(size).ok());
      ASSERT_TRUE(of_second.reserve(size).ok());
      EXPECT_NE(of_first.data(), of_second.data());
      EXPECT_EQ(fake.allocated, 2);
      EXPECT_TRUE(first->launch(kernel_entry<SumChunks>(), 1, nullptr).ok());
      EXPECT_TRUE(second->copy_in(of_second.data(), nullptr, 0).ok());
      EXPECT_TRUE(first->finish().ok());
      EXPECT_TRUE(second->launch(kernel_entry<SumLanes>(), 1, nullptr).ok());
      EXPECT_EQ(fake.pushed, fake.popped);
    }
  }
  EXPECT_EQ(fake.launched, 6);
  EXPECT_EQ(fake.allocated, 0);
  first.reset();
  EXPECT_EQ(fake.released, 1);
  EXPECT_EQ(fake.loaded_modules, 1);
  const auto memory = second->allocate(1);
  ASSERT_TRUE(memory.ok()) << "the other one holds the context";
  second->release(memory.value());
  second.reset();
  EXPECT_EQ(fake.released, 2);
  EXPECT_EQ(fake.loaded_modules, 0);
  EXPECT_EQ(fake.pushed, fake.popped);
  EXPECT_EQ(fake.outside_of_turns, 0);
}

TEST(CudaDriver, ALossThatTwoShareIsToldToEach) {
  const Driver driver = made_up_driver(true);
  auto first = open_by(driver, "some text").value();
  auto second = open_by(driver, "some text").value();
  void* const of_second = second->allocate(3).value();
  fake.copy_result = kIllegalAddress;
  EXPECT_FALSE(first->copy_in(nullptr, nullptr, 0).ok());
  fake.copy_result = 0;
  EXPECT_TRUE(first->is_lost());
  EXPECT_FALSE(second->is_lost()) << "the driver has not been asked";
  const Status told = second->finish();
  EXPECT_EQ(told.error().code, Errc::unavailable);
  EXPECT_NE(told.error().message.find("so it is"), std::string::npos) << "by the driver: " << told.error().message;
  EXPECT_TRUE(second->is_lost());
  EXPECT_NE(second->finish().error().message.find("lost before"), std::string::npos);
  EXPECT_FALSE(second->allocate(1).ok());
  first.reset();
  second->release(of_second);
  second.reset();
  EXPECT_EQ(fake.copies, 1);
  EXPECT_EQ(fake.allocated, 0);
  EXPECT_EQ(fake.loaded_modules, 0);
  EXPECT_EQ(fake.retained, fake.released);
  EXPECT_EQ(fake.pushed, fake.popped);
  EXPECT_EQ(fake.outside_of_turns, 0);
}

/// A fault of one compute alone leaves the other as it was.
TEST(CudaDriver, ALossOfOneIsNotTheOthers) {
  const Driver driver = made_up_driver(true);
  const auto first = open_by(driver, "some text").value();
  const auto second = open_by(driver, "some text").value();
  fake.push_result = kIllegalAddress;
  EXPECT_FALSE(first->finish().ok());
  fake.push_result = 0;
  EXPECT_TRUE(first->is_lost());
  EXPECT_TRUE(second->finish().ok());
  EXPECT_TRUE(second->copy_in(nullptr, nullptr, 0).ok());
  EXPECT_FALSE(second->is_lost());
  EXPECT_FALSE(first->finish().ok());
  EXPECT_EQ(fake.pushed, fake.popped);
  EXPECT_EQ(fake.outside_of_turns, 0);
}

TEST(CudaDriver, AContextThatCannotBeTurnedToIsAnErrorOfTheCall) {
  const Driver driver = made_up_driver(true);
  {
    const auto compute = open_by(driver, "some text").value();
    fake.push_result = kInvalidValue;
    const Status failed = compute->copy_in(nullptr, nullptr, 0);
    EXPECT_NE(failed.error().message.find("turning to the GPU"), std::string::npos) << failed.error().message;
    EXPECT_FALSE(compute->finish().ok());
    EXPECT_FALSE(compute->is_lost());
    fake.push_result = kIllegalAddress;
    EXPECT_FALSE(compute->fill(nullptr, 0, 0).ok());
    EXPECT_TRUE(compute->is_lost());
  }
  EXPECT_EQ(fake.copies, 0) << "nothing goes to the context of another";
  EXPECT_EQ(fake.pushed, fake.popped);
}

TEST(CudaDriver, AGpuThatIsTooOldIsAbsent) {
  const Driver driver = made_up_driver(true);
  for (const int capability : {52, 61, 62}) {
    fake.capability = capability;
    for (const Error& error : {open_by(driver, "some text").error(), describe_by(driver).error()}) {
      EXPECT_EQ(error.code, Errc::unavailable);
      EXPECT_NE(error.message.find("Made up) is too old"), std::string::npos) << error.message;
      EXPECT_NE(error.message.find("7.0"), std::string::npos) << error.message;
    }
  }
  EXPECT_EQ(fake.retained, 0);
  for (const int capability : {70, 75, 120}) {
    fake.capability = capability;
    EXPECT_EQ(describe_by(driver).value().compute_major, capability / 10);
  }
}

TEST(CudaDriver, WhatTheCompilerSaysIsPassedOn) {
  const Driver driver = made_up_driver(true);
  fake.load_result = 218;  // CUDA_ERROR_INVALID_PTX
  const auto opened = open_by(driver, "some text");
  ASSERT_FALSE(opened.ok());
  EXPECT_NE(opened.error().message.find("line 7: no such thing"), std::string::npos) << opened.error().message;
  EXPECT_EQ(fake.released, 1);
}

}  // namespace
}  // namespace saccade::internal::cuda

// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/internal/cuda_compute.hpp"

#include <array>
#include <map>
#include <string>
#include <utility>

#include "saccade/cuda/internal/driver.hpp"

namespace saccade::internal::cuda {
namespace {

constexpr int kComputeMajor{75};  // CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR
constexpr int kComputeMinor{76};

Error without_kernels() {
  return {Errc::unavailable,
          "this build has no kernels: no clang++ that compiles CUDA was found when it was configured", "cuda"};
}

Result<DeviceHandle> first_device(const Driver& driver) {
  int count{0};
  SACCADE_CHECK(driver.check(driver.cuDeviceGetCount(&count), "counting the GPUs"));
  if (count == 0) return Error{Errc::unavailable, "the NVIDIA driver finds no GPU", "cuda"};
  DeviceHandle device{0};
  SACCADE_CHECK(driver.check(driver.cuDeviceGet(&device, 0), "opening the GPU"));
  return device;
}

class CudaCompute final : public Compute {
 public:
  CudaCompute(const Driver& driver, DeviceHandle device, ContextHandle context)
      : driver_{driver}, device_{device}, context_{context} {}
  ~CudaCompute() override {
    if (module_ != nullptr) {
      const Current current{*this};
      driver_.cuModuleUnload(module_);
    }
    driver_.cuDevicePrimaryCtxRelease_v2(device_);
  }
  CudaCompute(const CudaCompute&) = delete;
  CudaCompute& operator=(const CudaCompute&) = delete;

  [[nodiscard]] Status load(const std::string& ptx) {
    const Current current{*this};
    return driver_.check(driver_.cuModuleLoadDataEx(&module_, ptx.c_str(), 0, nullptr, nullptr),
                         "compiling the kernels for the GPU");
  }

  [[nodiscard]] Result<void*> allocate(std::size_t bytes) override {
    const Current current{*this};
    DeviceAddress address{0};
    SACCADE_CHECK(driver_.check(driver_.cuMemAlloc_v2(&address, std::max<std::size_t>(bytes, 1)),
                                "taking " + std::to_string(bytes) + " bytes of the GPU's memory"));
    return reinterpret_cast<void*>(address);  // NOLINT(performance-no-int-to-ptr): an address of the device
  }
  void release(void* memory) noexcept override {
    const Current current{*this};
    driver_.cuMemFree_v2(address_of(memory));
  }
  [[nodiscard]] Status copy_in(void* to, const void* from, std::size_t bytes) override {
    const Current current{*this};
    return driver_.check(driver_.cuMemcpyHtoD_v2(address_of(to), from, bytes), "copying to the GPU");
  }
  [[nodiscard]] Status copy_out(void* to, const void* from, std::size_t bytes) override {
    const Current current{*this};
    return driver_.check(driver_.cuMemcpyDtoH_v2(to, address_of(from), bytes), "copying from the GPU");
  }
  [[nodiscard]] Status copy_within(void* to, const void* from, std::size_t bytes) override {
    const Current current{*this};
    return driver_.check(driver_.cuMemcpyDtoD_v2(address_of(to), address_of(from), bytes), "copying on the GPU");
  }
  [[nodiscard]] Status fill(void* memory, std::uint8_t value, std::size_t bytes) override {
    const Current current{*this};
    return driver_.check(driver_.cuMemsetD8_v2(address_of(memory), value, bytes), "clearing memory of the GPU");
  }
  [[nodiscard]] Status launch(const KernelEntry& kernel, std::size_t blocks, const void* arguments) override {
    constexpr std::size_t kMostBlocks{0x7FFFFFFF};
    if (blocks > kMostBlocks) return Error{Errc::unsupported, "too much work for one kernel", "cuda"};
    const Current current{*this};
    SACCADE_TRY(const FunctionHandle function, function_of(kernel.name));
    // The driver copies the arguments before it returns.
    std::array<void*, 1> parameters{const_cast<void*>(arguments)};
    return driver_.check(driver_.cuLaunchKernel(function, static_cast<unsigned>(blocks), 1, 1, kernel.threads, 1, 1, 0,
                                                nullptr, parameters.data(), nullptr),
                         std::string{"starting "} + kernel.name);
  }
  [[nodiscard]] Status finish() override {
    const Current current{*this};
    return driver_.check(driver_.cuCtxSynchronize(), "a kernel on the GPU");
  }

 private:
  /// Makes the device's context the calling thread's while it lives.
  class Current {
   public:
    explicit Current(const CudaCompute& compute) : driver_{compute.driver_} {
      driver_.cuCtxPushCurrent_v2(compute.context_);
    }
    ~Current() {
      ContextHandle popped{nullptr};
      driver_.cuCtxPopCurrent_v2(&popped);
    }
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    const Driver& driver_;
  };

  static DeviceAddress address_of(const void* memory) { return reinterpret_cast<DeviceAddress>(memory); }
  [[nodiscard]] Result<FunctionHandle> function_of(const char* name) {
    FunctionHandle& function = functions_[name];
    if (function == nullptr) {
      SACCADE_CHECK(driver_.check(driver_.cuModuleGetFunction(&function, module_, name),
                                  std::string{"finding the kernel "} + name));
    }
    return function;
  }

  const Driver& driver_;
  DeviceHandle device_;
  ContextHandle context_;
  ModuleHandle module_{nullptr};
  std::map<std::string, FunctionHandle> functions_;
};

}  // namespace

std::string with_blocks_per_unit(std::string_view ptx, std::string_view kernel, unsigned blocks) {
  constexpr std::string_view kLimit{".minnctapersm "};
  std::string text{ptx};
  const std::size_t entry = text.find(".entry " + std::string{kernel} + "(");
  const std::size_t limit = entry == std::string::npos ? entry : text.find(kLimit, entry);
  if (limit == std::string::npos) return text;
  const std::size_t begin = limit + kLimit.size();
  return text.replace(begin, text.find('\n', begin) - begin, std::to_string(blocks));
}

Result<std::unique_ptr<Compute>> open_cuda(std::string_view ptx) {
  if (ptx.empty()) return without_kernels();
  SACCADE_TRY(const Driver* const driver, Driver::load());
  SACCADE_TRY(const DeviceHandle device, first_device(*driver));
  ContextHandle context{nullptr};
  SACCADE_CHECK(driver->check(driver->cuDevicePrimaryCtxRetain(&context, device), "starting the GPU"));
  auto compute = std::make_unique<CudaCompute>(*driver, device, context);
  SACCADE_CHECK(compute->load(std::string{ptx}));
  return std::unique_ptr<Compute>{std::move(compute)};
}

Result<CudaDevice> describe_cuda() {
  if (kernel_ptx().empty()) return without_kernels();
  SACCADE_TRY(const Driver* const driver, Driver::load());
  SACCADE_TRY(const DeviceHandle device, first_device(*driver));
  CudaDevice described;
  std::array<char, 256> name{};
  SACCADE_CHECK(driver->check(driver->cuDeviceGetName(name.data(), static_cast<int>(name.size()) - 1, device),
                              "asking for the GPU's name"));
  described.name = name.data();
  SACCADE_CHECK(driver->check(driver->cuDeviceTotalMem_v2(&described.memory_bytes, device), "asking for its memory"));
  SACCADE_CHECK(driver->check(driver->cuDeviceGetAttribute(&described.compute_major, kComputeMajor, device),
                              "asking for its compute capability"));
  SACCADE_CHECK(driver->check(driver->cuDeviceGetAttribute(&described.compute_minor, kComputeMinor, device),
                              "asking for its compute capability"));
  SACCADE_CHECK(driver->check(driver->cuDriverGetVersion(&described.driver_version), "asking for its driver"));
  described.ptx_target = ptx_target();
  return described;
}

}  // namespace saccade::internal::cuda

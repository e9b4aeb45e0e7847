// SPDX-License-Identifier: Apache-2.0
#include "saccade/cuda/internal/cuda_compute.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

#include "saccade/cuda/internal/all_kernels.hpp"
#include "saccade/cuda/internal/driver.hpp"

namespace saccade::internal::cuda {
namespace {

constexpr int kComputeMajor{75};  // CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR
constexpr int kComputeMinor{76};
constexpr int kFunctionRegisters{4};  // CU_FUNC_ATTRIBUTE_NUM_REGS
constexpr int kJitErrorLog{5};        // CU_JIT_ERROR_LOG_BUFFER
constexpr int kJitErrorLogBytes{6};   // CU_JIT_ERROR_LOG_BUFFER_SIZE_BYTES

Error without_kernels() {
  return {Errc::unavailable,
          "this build has no kernels: no clang++ that compiles CUDA was found when it was configured", "cuda"};
}

/// Capability that the PTX asks for, as major · 10 + minor; 0 where it names none.
int capability_of_ptx() {
  const std::string_view target = ptx_target();
  const std::size_t digits = target.find_first_of("0123456789");
  return digits == std::string_view::npos ? 0 : std::atoi(std::string{target.substr(digits)}.c_str());
}

Result<std::string> name_of(const Driver& driver, DeviceHandle device) {
  std::array<char, 256> name{};
  SACCADE_CHECK(driver.check(driver.cuDeviceGetName(name.data(), static_cast<int>(name.size()) - 1, device),
                             "asking for the GPU's name"));
  return std::string{name.data()};
}

struct Capability {
  int major{0};
  int minor{0};
};
Result<Capability> capability_of(const Driver& driver, DeviceHandle device) {
  Capability found;
  SACCADE_CHECK(driver.check(driver.cuDeviceGetAttribute(&found.major, kComputeMajor, device),
                             "asking for its compute capability"));
  SACCADE_CHECK(driver.check(driver.cuDeviceGetAttribute(&found.minor, kComputeMinor, device),
                             "asking for its compute capability"));
  return found;
}

/// Returns the first GPU, if the kernels run on it: what is too old is absent, rather than a failure later.
Result<DeviceHandle> first_device(const Driver& driver) {
  int count{0};
  SACCADE_CHECK(driver.check(driver.cuDeviceGetCount(&count), "counting the GPUs"));
  if (count == 0) return Error{Errc::unavailable, "the NVIDIA driver finds no GPU", "cuda"};
  DeviceHandle device{0};
  SACCADE_CHECK(driver.check(driver.cuDeviceGet(&device, 0), "opening the GPU"));
  SACCADE_TRY(const Capability has, capability_of(driver, device));
  const int needed = capability_of_ptx();
  if (has.major * 10 + has.minor >= needed) return device;
  SACCADE_TRY(const std::string name, name_of(driver, device));
  const auto text = [](int major, int minor) { return std::to_string(major) + "." + std::to_string(minor); };
  return Error{Errc::unavailable,
               "the GPU (" + name + ") is too old: its compute capability is " + text(has.major, has.minor) +
                   ", and the kernels need " + text(needed / 10, needed % 10),
               "cuda"};
}

class CudaCompute final : public Compute {
 public:
  CudaCompute(const Driver& driver, DeviceHandle device, ContextHandle context)
      : driver_{driver}, device_{device}, context_{context} {}
  ~CudaCompute() override {
    if (module_ != nullptr) {
      const Current current{*this};
      if (current.status().ok()) driver_.cuModuleUnload(module_);
    }
    driver_.cuDevicePrimaryCtxRelease_v2(device_);
  }
  CudaCompute(const CudaCompute&) = delete;
  CudaCompute& operator=(const CudaCompute&) = delete;

  /// Compiles the kernels and puts all of them onto the GPU. Without that, a driver puts a kernel there when it is
  /// first started (since 12.2), which takes memory: a full GPU could not be emptied by kernels that never ran.
  [[nodiscard]] Status load(const std::string& ptx) {
    const Current current{*this};
    if (!current.status().ok()) return current.status().error();
    SACCADE_CHECK(compile(ptx));
#define SACCADE_LOAD(name, Kernel) SACCADE_CHECK(load_kernel(Kernel::kName));
    SACCADE_ALL_KERNELS(SACCADE_LOAD)
#undef SACCADE_LOAD
    return {};
  }

  [[nodiscard]] bool is_lost() const override { return lost_; }
  [[nodiscard]] Result<void*> allocate(std::size_t bytes) override {
    DeviceAddress address{0};
    SACCADE_CHECK(call("taking " + std::to_string(bytes) + " bytes of the GPU's memory",
                       [&] { return driver_.cuMemAlloc_v2(&address, std::max<std::size_t>(bytes, 1)); }));
    return reinterpret_cast<void*>(address);  // NOLINT(performance-no-int-to-ptr): an address of the device
  }
  void release(void* memory) noexcept override {
    const Current current{*this};
    if (current.status().ok()) driver_.cuMemFree_v2(address_of(memory));
  }
  [[nodiscard]] Status copy_in(void* to, const void* from, std::size_t bytes) override {
    return call("copying to the GPU", [&] { return driver_.cuMemcpyHtoD_v2(address_of(to), from, bytes); });
  }
  [[nodiscard]] Status copy_out(void* to, const void* from, std::size_t bytes) override {
    return call("copying from the GPU", [&] { return driver_.cuMemcpyDtoH_v2(to, address_of(from), bytes); });
  }
  [[nodiscard]] Status copy_within(void* to, const void* from, std::size_t bytes) override {
    return call("copying on the GPU", [&] { return driver_.cuMemcpyDtoD_v2(address_of(to), address_of(from), bytes); });
  }
  [[nodiscard]] Status fill(void* memory, std::uint8_t value, std::size_t bytes) override {
    return call("clearing memory of the GPU", [&] { return driver_.cuMemsetD8_v2(address_of(memory), value, bytes); });
  }
  [[nodiscard]] Status launch(const KernelEntry& kernel, std::size_t blocks, const void* arguments) override {
    constexpr std::size_t kMostBlocks{0x7FFFFFFF};
    if (blocks > kMostBlocks) return Error{Errc::unsupported, "too much work for one kernel", "cuda"};
    const auto function = functions_.find(kernel.name);
    if (function == functions_.end())
      return Error{Errc::unavailable, std::string{"there is no kernel "} + kernel.name, "cuda"};
    // The driver copies the arguments before it returns.
    std::array<void*, 1> parameters{const_cast<void*>(arguments)};
    return call(kernel.name, [&] {
      return driver_.cuLaunchKernel(function->second, static_cast<unsigned>(blocks), 1, 1, kernel.threads, 1, 1, 0,
                                    nullptr, parameters.data(), nullptr);
    });
  }
  [[nodiscard]] Status finish() override {
    return call("a kernel on the GPU", [&] { return driver_.cuCtxSynchronize(); });
  }

 private:
  /// Makes the device's context the calling thread's while it lives, or says why it cannot.
  class Current {
   public:
    explicit Current(CudaCompute& compute)
        : driver_{compute.driver_},
          pushed_{compute.checked(driver_.cuCtxPushCurrent_v2(compute.context_), "turning to the GPU")} {}
    ~Current() {
      ContextHandle popped{nullptr};
      if (pushed_.ok()) driver_.cuCtxPopCurrent_v2(&popped);
    }
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;
    [[nodiscard]] const Status& status() const { return pushed_; }

   private:
    const Driver& driver_;
    Status pushed_;
  };

  static DeviceAddress address_of(const void* memory) { return reinterpret_cast<DeviceAddress>(memory); }

  /// Calls the driver with the device's context. Once the GPU is lost, the driver is left alone.
  template <class Function>
  [[nodiscard]] Status call(const std::string& action, const Function& function) {
    if (lost_) return Error{Errc::unavailable, action + " failed: the GPU was lost before", "cuda"};
    const Current current{*this};
    if (!current.status().ok()) return current.status().error();
    return checked(function(), action);
  }
  /// As Driver::check; remembers the loss of the GPU.
  [[nodiscard]] Status checked(DriverResult result, const std::string& action) {
    lost_ = lost_ || fault_of(result) == DriverFault::lost;
    return driver_.check(result, action);
  }

  [[nodiscard]] Status compile(const std::string& ptx) {
    std::array<char, 4096> log{};
    std::array<int, 2> options{kJitErrorLog, kJitErrorLogBytes};
    std::array<void*, 2> values{log.data(), reinterpret_cast<void*>(log.size())};  // NOLINT: a size, by value
    const Status compiled =
        checked(driver_.cuModuleLoadDataEx(&module_, ptx.c_str(), static_cast<unsigned>(options.size()), options.data(),
                                           values.data()),
                "compiling the kernels for the GPU");
    if (compiled.ok() || log[0] == '\0') return compiled;
    log.back() = '\0';
    Error error = compiled.error();
    error.message += "; the driver's compiler says: " + std::string{log.data()};
    return error;
  }
  /// Finds a kernel, and asks for its registers: for that, the driver has to load it.
  [[nodiscard]] Status load_kernel(const char* name) {
    FunctionHandle function{nullptr};
    const std::string action = std::string{"loading the kernel "} + name;
    SACCADE_CHECK(checked(driver_.cuModuleGetFunction(&function, module_, name), action));
    int registers{0};
    SACCADE_CHECK(checked(driver_.cuFuncGetAttribute(&registers, kFunctionRegisters, function), action));
    if (driver_.cuFuncLoad != nullptr) SACCADE_CHECK(checked(driver_.cuFuncLoad(function), action));
    functions_[name] = function;
    return {};
  }

  const Driver& driver_;
  DeviceHandle device_;
  ContextHandle context_;
  ModuleHandle module_{nullptr};
  bool lost_{false};
  std::map<std::string, FunctionHandle, std::less<>> functions_;
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
  return open_by(*driver, ptx);
}

Result<std::unique_ptr<Compute>> open_by(const Driver& driver, std::string_view ptx) {
  SACCADE_TRY(const DeviceHandle device, first_device(driver));
  ContextHandle context{nullptr};
  SACCADE_CHECK(driver.check(driver.cuDevicePrimaryCtxRetain(&context, device), "starting the GPU"));
  auto compute = std::make_unique<CudaCompute>(driver, device, context);
  SACCADE_CHECK(compute->load(std::string{ptx}));
  return std::unique_ptr<Compute>{std::move(compute)};
}

Result<CudaDevice> describe_cuda() {
  if (kernel_ptx().empty()) return without_kernels();
  SACCADE_TRY(const Driver* const driver, Driver::load());
  return describe_by(*driver);
}

Result<CudaDevice> describe_by(const Driver& driver) {
  SACCADE_TRY(const DeviceHandle device, first_device(driver));
  CudaDevice described;
  SACCADE_TRY(described.name, name_of(driver, device));
  SACCADE_TRY(const Capability capability, capability_of(driver, device));
  described.compute_major = capability.major;
  described.compute_minor = capability.minor;
  SACCADE_CHECK(driver.check(driver.cuDeviceTotalMem_v2(&described.memory_bytes, device), "asking for its memory"));
  SACCADE_CHECK(driver.check(driver.cuDriverGetVersion(&described.driver_version), "asking for its driver"));
  described.ptx_target = ptx_target();
  return described;
}

}  // namespace saccade::internal::cuda

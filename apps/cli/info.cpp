// SPDX-License-Identifier: Apache-2.0
// saccade info: versions, processor and back ends; with a file or folder, what is in it.
#include <png.h>
#include <tbb/version.h>
#include <zlib.h>
#include <zstd.h>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <fstream>
#include <sstream>
#include <thread>

#include "context.hpp"
#include "info_files.hpp"
#include "saccade/core/simd.hpp"
#include "saccade/core/version.hpp"
#include "saccade/cuda/device.hpp"
#include "saccade/devices/programs.hpp"
#include "saccade/loops/pose_graph.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

#define SACCADE_TEXT_IMPL(x) #x
#define SACCADE_TEXT(x) SACCADE_TEXT_IMPL(x)

std::string compiler() {
#if defined(__clang__)
  return std::string{"clang "} + __clang_version__;
#else
  return std::string{"g++ "} + __VERSION__;
#endif
}

std::string processor() {
  std::ifstream file{"/proc/cpuinfo"};
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

/// Vector extensions that the processor offers.
std::vector<std::string> vector_extensions() {
  std::vector<std::string> found;
#if defined(__x86_64__)
  const auto add = [&found](bool has, const char* name) {
    if (has) found.emplace_back(name);
  };
  add(__builtin_cpu_supports("sse4.2") != 0, "sse4.2");
  add(__builtin_cpu_supports("avx2") != 0, "avx2");
  add(__builtin_cpu_supports("fma") != 0, "fma");
  add(__builtin_cpu_supports("avx512f") != 0, "avx512f");
#elif defined(__aarch64__)
  found.emplace_back("neon");
#endif
  return found;
}

json dependencies() {
  return {{"eigen", SACCADE_TEXT(EIGEN_WORLD_VERSION) "." SACCADE_TEXT(EIGEN_MAJOR_VERSION) "." SACCADE_TEXT(
                        EIGEN_MINOR_VERSION)},
          {"onetbb", TBB_runtime_version()},
          {"nlohmann-json", SACCADE_TEXT(NLOHMANN_JSON_VERSION_MAJOR) "." SACCADE_TEXT(
                                NLOHMANN_JSON_VERSION_MINOR) "." SACCADE_TEXT(NLOHMANN_JSON_VERSION_PATCH)},
          {"cli11", CLI11_VERSION},
          {"zstd", ZSTD_versionString()},
          {"libpng", PNG_LIBPNG_VER_STRING},
          {"zlib", zlibVersion()}};
}

/// Where the programs of devices over ROS are; null: not there.
json ros_json() {
  json found = json::object();
  for (const RosProgram& version : kRosPrograms) {
    const fs::path path = find_program(version.program);
    found[std::string{version.program}] = path.empty() ? json{} : json{path.string()};
  }
  return found;
}

/// The GPU, or why the CUDA back end cannot be used.
json cuda_json() {
  const auto device = cuda_device();
  if (!device) return {{"absent_because", device.error().message}};
  return {{"device", device->name},
          {"memory_bytes", device->memory_bytes},
          {"compute_capability", std::to_string(device->compute_major) + "." + std::to_string(device->compute_minor)},
          {"driver_version", device->driver_version},
          {"ptx_target", device->ptx_target}};
}

/// "NVIDIA H200, 139.8 GiB, compute capability 9.0, kernels as PTX for sm_70", or "absent: …"
std::string cuda_text(const json& found) {
  if (found.contains("absent_because")) return "absent: " + found["absent_because"].get<std::string>();
  constexpr double kGibibyte{1024.0 * 1024.0 * 1024.0};
  return found["device"].get<std::string>() + ", " + fixed(found["memory_bytes"].get<double>() / kGibibyte, 1) +
         " GiB, compute capability " + found["compute_capability"].get<std::string>() + ", kernels as PTX for " +
         found["ptx_target"].get<std::string>();
}

/// The solver that closing loops needs; null: not in this build.
json loops_json() {
  const std::string solver = pose_graph_solver();
  return solver.empty() ? json{} : json(solver);
}

json program_json(const Executor& executor) {
  return {{"compiler", compiler()},
          {"processor", processor()},
          {"vector_extensions", vector_extensions()},
          {"simd_target", simd_target()},
          {"simd_targets", simd_targets()},
          {"cores", std::thread::hardware_concurrency()},
          {"backends", {{"sequential", true}, {"tbb", true}, {"cuda", cuda_device().ok()}}},
          {"backend", executor.backend_name()},
          {"cuda", cuda_json()},
          {"ros", ros_json()},
          {"loops", loops_json()},
          {"dependencies", dependencies()}};
}

/// "ROS 1 (saccade-ros1); absent: ROS 2 (saccade-ros2, which needs …)"
std::string ros_text(const json& found) {
  std::string present;
  std::string absent;
  for (const RosProgram& version : kRosPrograms) {
    const bool has = !found[std::string{version.program}].is_null();
    std::string text = std::string{version.name} + " (" + std::string{version.program};
    text += has ? ")" : ", which needs " + std::string{version.packages} + " when saccade is built)";
    std::string& list = has ? present : absent;
    list += (list.empty() ? "" : ", ") + text;
  }
  const std::string missing = absent.empty() ? "" : "absent: " + absent;
  return present + (present.empty() || absent.empty() ? "" : "; ") + missing;
}

std::string program_text(const json& about) {
  std::ostringstream text;
  const Summary summary{text};
  summary.line("saccade", version());
  summary.line("compiler", about["compiler"].get<std::string>());
  std::string extensions;
  for (const json& name : about["vector_extensions"]) extensions += " " + name.get<std::string>();
  summary.line("processor",
               about["processor"].get<std::string>() + " (" + about["cores"].dump() + " cores;" + extensions + ")");
  summary.line("SIMD", about["simd_target"].get<std::string>());
  std::string present;
  std::string absent;
  for (const auto& [name, has] : about["backends"].items()) (has.get<bool>() ? present : absent) += " " + name;
  summary.line("back ends", present.substr(1) + (absent.empty() ? "" : "; absent:" + absent));
  summary.line("GPU", cuda_text(about["cuda"]));
  summary.line("devices", ros_text(about["ros"]));
  summary.line("loops", about["loops"].is_null() ? "absent: ceres (libceres-dev, when saccade is built)"
                                                 : about["loops"].get<std::string>());
  std::string versions;
  for (const auto& [name, version] : about["dependencies"].items()) {
    versions += (versions.empty() ? "" : ", ") + name + " " + version.get<std::string>();
  }
  summary.line("libraries", versions);
  return text.str();
}

std::string text_of(const Description& described) {
  std::ostringstream text;
  const Summary summary{text};
  for (const auto& [name, value] : described.lines) summary.line(name, value);
  return text.str();
}

class Info final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"info", "shows versions, processor and back ends, or the content of a file or folder"};
  }

  void declare(Options& options) override {
    options.value(
        "subject", subject_, "FILE|FOLDER",
        "a map, cloud, mesh, array, bag, session, campaign, result, arm, scene, cell or hand's trajectory, or "
        "the folder of a run or of RGB-D frames");
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    json result = program_json(context.executor());
    if (subject_.empty()) return Outcome{.result = result, .text = program_text(result)};
    SACCADE_TRY(const Description described, describe_file(subject_, context.executor()));
    result.update(described.result);
    return Outcome{.result = std::move(result), .text = text_of(described)};
  }

 private:
  fs::path subject_;
};

}  // namespace

void add_info(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Info>(program, global, action);
}

}  // namespace saccade::cli

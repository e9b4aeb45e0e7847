// SPDX-License-Identifier: Apache-2.0
// saccade info: versions, processor and back ends; with a map or a run, what is in it.
#include <png.h>
#include <tbb/version.h>
#include <zlib.h>
#include <zstd.h>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <fstream>
#include <iostream>
#include <memory>
#include <thread>

#include "add_value.hpp"
#include "command.hpp"
#include "exit_status.hpp"
#include "json_output.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/core/simd.hpp"
#include "saccade/devices/programs.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
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

json program_json(const Executor& executor) {
  return {{"compiler", compiler()},
          {"processor", processor()},
          {"vector_extensions", vector_extensions()},
          {"simd_target", simd_target()},
          {"simd_targets", simd_targets()},
          {"cores", std::thread::hardware_concurrency()},
          {"backends", {{"sequential", true}, {"tbb", true}, {"cuda", false}}},
          {"backend", executor.backend_name()},
          {"ros", ros_json()},
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

json saved_map_json(const TsdfSnapshot& map) {
  const TsdfGrid::Usage usage = map.grid.usage();
  std::size_t occupied = 0;
  std::size_t known = 0;
  for (const Index3& key : map.grid.sorted_sectors()) {
    for (const BrickRef& brick : map.grid.find(key)->bricks) {
      occupied += static_cast<std::size_t>(brick.occupied_mask().count());
      known += static_cast<std::size_t>(kBrickVoxels - brick.unknown_mask().count());
    }
  }
  const IndexBox sectors = map.grid.sector_bounds();
  const double sector_m = kSectorVoxelEdge * map.config.voxel_size_m;
  const auto corner = [sector_m](const Index3& i) { return json{i.x * sector_m, i.y * sector_m, i.z * sector_m}; };
  json result{{"voxel_size_m", map.config.voxel_size_m},
              {"truncation_m", map.config.truncation_m()},
              {"max_weight", map.config.max_weight},
              {"free_weight", map.config.free_weight},
              {"clearing_percent", map.config.clearing_percent},
              {"color", map.config.color},
              {"workspace", nullptr},
              {"bounds_m", {{"min", corner(sectors.lo)}, {"max", corner(sectors.hi)}}},
              {"sectors", usage.sectors},
              {"bricks", usage.bricks()},
              {"constant_free_bricks", usage.constant_free_bricks},
              {"free_bricks", usage.free_bricks},
              {"dense_bricks", usage.dense_bricks},
              {"bytes", usage.bytes},
              {"occupied_voxels", occupied},
              {"empty_voxels", known - occupied}};
  if (const auto& w = map.config.workspace) {
    result["workspace"] = {{"min", {w->min.x(), w->min.y(), w->min.z()}},
                           {"max", {w->max.x(), w->max.y(), w->max.z()}}};
  }
  return result;
}

void print_program(const json& about) {
  const Summary summary{std::cout};
  summary.line("saccade", SACCADE_VERSION);
  summary.line("compiler", about["compiler"].get<std::string>());
  std::string extensions;
  for (const json& name : about["vector_extensions"]) extensions += " " + name.get<std::string>();
  summary.line("processor",
               about["processor"].get<std::string>() + " (" + about["cores"].dump() + " cores;" + extensions + ")");
  summary.line("SIMD", about["simd_target"].get<std::string>());
  std::string present;
  std::string absent;
  for (const auto& [name, has] : about["backends"].items()) (has.get<bool>() ? present : absent) += " " + name;
  summary.line("back ends", present.substr(1) + "; absent:" + absent);
  summary.line("devices", ros_text(about["ros"]));
  std::string versions;
  for (const auto& [name, version] : about["dependencies"].items()) {
    versions += (versions.empty() ? "" : ", ") + name + " " + version.get<std::string>();
  }
  summary.line("libraries", versions);
}

std::string corner_text(const json& corner) {
  return "(" + fixed(corner[0].get<double>(), 2) + ", " + fixed(corner[1].get<double>(), 2) + ", " +
         fixed(corner[2].get<double>(), 2) + ")";
}

void print_map(const fs::path& path, const json& map) {
  const Summary summary{std::cout};
  summary.line("map", path.string());
  summary.line("voxels", millimetres(map["voxel_size_m"].get<double>()) + ", truncated at " +
                             millimetres(map["truncation_m"].get<double>()));
  summary.line("within", corner_text(map["bounds_m"]["min"]) + " to " + corner_text(map["bounds_m"]["max"]) + " m");
  summary.line("occupied", map["occupied_voxels"].dump() + " voxels");
  summary.line("empty", map["empty_voxels"].dump() + " voxels");
  summary.line("bricks", map["bricks"].dump() + ": " + map["dense_bricks"].dump() + " dense, " +
                             map["free_bricks"].dump() + " free, " + map["constant_free_bricks"].dump() +
                             " constant free");
  summary.line("memory", mebibytes(map["bytes"].get<std::size_t>()));
}

/// run.json as far as people want it; the document itself is in the JSON result.
Result<json> read_run(const fs::path& path) {
  SACCADE_TRY(json run, read_json(path));
  if (run.is_object() && run.value("schema", json{}) == kJsonSchema && run.contains("result")) return run;
  return Error{Errc::corrupt_data, "is not a result of saccade", path.string()};
}

void print_run(const json& run) {
  const Summary summary{std::cout};
  const json& result = run["result"];
  summary.line("command", run.value("command", json{}).dump());
  for (const char* name : {"tracking", "frames", "lost", "depth_residual_m", "trajectory_error_m"}) {
    if (result.contains(name)) summary.line(name, result[name].dump());
  }
}

Result<json> describe(const fs::path& path, const Executor& executor, bool print) {
  std::error_code ignored;
  const bool is_run = fs::is_directory(path, ignored);
  if (is_run && !fs::exists(path / "run.json", ignored) && !fs::exists(path / "map.sacmap", ignored)) {
    return Error{Errc::not_found, "holds neither run.json nor map.sacmap; name a map or the folder of a run",
                 path.string()};
  }
  json result = json::object();
  if (is_run && fs::exists(path / "run.json", ignored)) {
    SACCADE_TRY(result["run"], read_run(path / "run.json"));
    if (print) print_run(result["run"]);
  }
  const fs::path map_path = is_run ? path / "map.sacmap" : path;
  SACCADE_TRY(const TsdfSnapshot map, load_map(map_path, executor));
  result["map"] = saved_map_json(map);
  if (print) print_map(map_path, result["map"]);
  return result;
}

Result<int> run_info(const fs::path& subject, const GlobalOptions& global) {
  const Stopwatch stopwatch;
  const Executor executor = global.executor();
  const bool print = !global.json_to_stdout();
  json result = program_json(executor);
  if (subject.empty()) {
    if (print) print_program(result);
  } else {
    SACCADE_TRY(const json content, describe(subject, executor, print));
    result.update(content);
  }
  SACCADE_CHECK(write_result("info", global, executor, {{"total", stopwatch.elapsed_ms()}}, std::move(result)));
  return static_cast<int>(ExitStatus::done);
}

}  // namespace

void add_info(CLI::App& program, const GlobalOptions& global, Action& action) {
  CLI::App* command = program.add_subcommand("info", "versions, processor and back ends; what is in a map or a run");
  auto subject = std::make_shared<fs::path>();
  add_value(*command, "subject", *subject, "MAP|RUN", "a saved map (.sacmap) or the folder of a run");
  command->callback(
      [subject, &global, &action] { action = [subject, &global] { return run_info(*subject, global); }; });
}

}  // namespace saccade::cli

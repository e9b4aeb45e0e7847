// SPDX-License-Identifier: Apache-2.0
#pragma once
// Benchmark: a published protocol of view planning as data: objects, sensor, view space, stopping, measure, and the
// figures that publications state. plan_benchmark expands one into scenes and settings for a campaign. What is stated
// where, and what differs: docs/guides/benchmark.md, decision 0044.

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "saccade/trial/surface_coverage.hpp"

namespace saccade {

/// Mesh that a protocol names, and that the user has to bring.
struct BenchmarkMesh {
  std::string object;  ///< what it shows: of several files that show one object, the first that is there is used
  std::string file;    ///< name in the folder
  std::string md5;     ///< checksum, 32 hexadecimal digits
  std::string from;    ///< where the right file is to be had
  UpAxis up{UpAxis::z};
};

/// Figure of a publication.
struct PublishedFigure {
  std::string method;
  double views{0.0};     ///< the first one included
  double coverage{0.0};  ///< share
  int year{0};           ///< 0: not known
  std::string source;
  std::string object;   ///< what was measured
  std::string differs;  ///< between that protocol and this run
  /// BenchmarkMesh::object, where one of the protocol's objects was measured, and no other.
  std::optional<std::string> measured{};
};

/// Where the views of a protocol come from.
enum class ViewSpace : std::uint8_t {
  shell,       ///< random views between a cube and a sphere around the object (ShellViewsConfig)
  hemisphere,  ///< views spread evenly over the upper half of a sphere
  own,         ///< every strategy generates its own
};

struct Benchmark {
  std::string name{};
  int version{1};  ///< raised when the same command comes to give other figures
  std::string text{};
  std::vector<BenchmarkMesh> meshes{};
  std::vector<std::string> stand_ins{};  ///< used without meshes: names of stand_in()
  std::vector<std::string> scenes{};     ///< scenes of find_scene() instead of single objects
  bool on_table{false};                  ///< false: the object floats, and is seen from all around
  /// Distance from an object's middle to its farthest point, to which it is scaled.
  double object_radius_m{0.1};
  bool true_size{false};  ///< meshes keep their size, in metres; stand-ins are scaled nevertheless
  ViewSpace views{ViewSpace::hemisphere};
  std::size_t candidates{32};
  std::size_t starts{1};         ///< first views that each object is begun from
  std::size_t views_in_all{10};  ///< the first included; 0: as many as budget, after the scene's own scan
  std::size_t budget{5};         ///< views after the scan, for scenes of their own
  PinholeCamera camera{};
  double voxel_size_m{0.004};
  bool noise{false};
  std::optional<CoverageRule> rule{};  ///< none: coverage of docs/reference/metrics.md
  std::string robot{"free"};
  std::vector<std::string> strategies{};
  std::vector<PublishedFigure> published{};
  std::string not_published{};  ///< why there are no published figures beside ours, where there are none

  [[nodiscard]] bool has_own_scenes() const { return !scenes.empty(); }
};

/// Returns all protocols, in the order in which they are listed.
[[nodiscard]] std::span<const Benchmark> benchmarks();
/// Finds a protocol. Answers invalid_argument with the known names, and the nearest of them.
[[nodiscard]] Result<Benchmark> find_benchmark(std::string_view name);

/// Where the objects of a campaign come from. Published figures are about the first kind alone.
enum class ObjectSource : std::uint8_t { published, stand_ins, own };
inline constexpr auto kObjectSourceNames = make_names<ObjectSource>(
    {{ObjectSource::published, "published"}, {ObjectSource::stand_ins, "stand-ins"}, {ObjectSource::own, "own"}});

/// Scenes and settings of a campaign that runs a protocol.
struct BenchmarkPlan {
  std::vector<Scene> scenes;  ///< one per object and first view: "figure", or "figure@12" for the first view 12
  ObjectSource objects{ObjectSource::published};
  SimulatedRunConfig run;  ///< all but strategy, seed and arm
};

/// Says whether a plan of a protocol is about the very object that a published figure is of, and about no other.
[[nodiscard]] bool has_same_object(const Benchmark& benchmark, const BenchmarkPlan& plan,
                                   const PublishedFigure& figure);

/// Expands a protocol. Objects are scaled and put where it says.
/// @param objects  folder with the protocol's meshes; those that are there are used. nullopt: stand-ins.
/// @return not_found for a folder with none of them, naming all and where they are to be had; invalid_argument for one
/// with another checksum, naming both; errors of read_any_mesh and find_scene.
[[nodiscard]] Result<BenchmarkPlan> plan_benchmark(const Benchmark& benchmark,
                                                   const std::optional<std::filesystem::path>& objects);

/// Expands a protocol, with other meshes than it names. Objects are called after their files.
/// @param config  `scale` matters where the protocol leaves objects their size
/// @return invalid_argument for files whose names their folders do not tell apart, for a protocol with scenes of its
/// own, and for an object whose size check_object_size refuses where the protocol leaves it; errors of
/// read_upright_mesh.
[[nodiscard]] Result<BenchmarkPlan> plan_benchmark(const Benchmark& benchmark,
                                                   std::span<const std::filesystem::path> own_meshes,
                                                   const MeshSceneConfig& config);

/// Shares after the first view, the first two …, as many as the protocol has views. A run that ended early goes on
/// with its last ones.
struct BenchmarkCurve {
  std::vector<CoverageShares> after;
  std::size_t taken{0};  ///< views of the run, the first included
};
/// Measures runs of one scene. `views` has the poses of each run after the first view. Expects a protocol with a rule.
/// Errors: those of SurfaceCoverage::build. Equal on every thread count.
[[nodiscard]] Result<std::vector<BenchmarkCurve>> measure_benchmark(const Benchmark& benchmark, const RayScene& scene,
                                                                    const SimulatedRunConfig& run,
                                                                    std::span<const std::vector<Pose>> views,
                                                                    const Executor& executor);

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#pragma once
// RunOptions: how a simulated exploration goes, as the command line says it.

#include "options.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/trial/simulated_run.hpp"

namespace CLI {
class App;
}

namespace saccade::cli {

struct RunOptions {
  SimulatedRunConfig run;

  // As they were given, before they are checked together.
  std::string distances{"0.8"};
  std::optional<double> min_gain;    ///< nullopt: what goes with the strategy
  std::optional<int> gain_width_px;  ///< nullopt: what `run` has
  CameraOptions camera;
  bool sensor_given{false};  ///< --sensor; else the noise is that of the camera, where it has one
};

/// Adds --max-views, --min-gain, --good-enough, --rivals, --gain-width, --radius, --voxel-size, --no-noise, --sensor
/// and the camera's options.
/// @param min_gain  what the default of --min-gain is, for --help.
void add_run_options(CLI::App& command, RunOptions& options, const std::string& min_gain);
/// Adds --lookahead, --objective and --frame-on-way, for what chooses among views.
void add_foresight_options(CLI::App& command, RunOptions& options);
/// Adds --mesh-scale and --mesh-up.
void add_mesh_options(CLI::App& command, MeshSceneConfig& mesh);
/// After parsing: throws a usage error for frames on the way of a camera that flies.
void check_foresight(const RunOptions& options, const std::string& robot);
/// After parsing: fills `run` but for its strategy, threshold and seed, and throws a usage error for what makes no
/// sense.
void check_run_options(RunOptions& options);
/// Views are chosen among all voxels of the workspace: there must be some, and not more than a memory holds. Answers
/// invalid_argument with the scene's name.
[[nodiscard]] Status check_workspace(const Scene& scene, double voxel_size_m);
/// "50 rays for attention, …"
[[nodiscard]] std::string min_gain_by_strategy();
/// Sets the strategy of `run`, and the threshold that goes with it unless one was given.
void choose_strategy(RunOptions& options, const NamedPlanner& strategy);
/// Says that the simulated camera has the image of one sensor and the noise of another; empty: it has not.
[[nodiscard]] std::string mixed_camera(const RunOptions& options);
/// Returns the name of the simulated camera's noise, for people.
[[nodiscard]] std::string noise_name(const SimulatedRunConfig& run);

}  // namespace saccade::cli

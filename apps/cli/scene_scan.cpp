// SPDX-License-Identifier: Apache-2.0
// saccade scene scan: the cloud of a simulated laser scanner, with the true label of every point.
#include "scene_scan.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <bit>
#include <cmath>

#include "context.hpp"
#include "options.hpp"
#include "saccade/io/clouds/label_io.hpp"
#include "saccade/scene/laser_scan.hpp"
#include "saccade/scene/scene_yaml.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

PcdFile pcd_of(const PointCloud& cloud) {
  PcdFile pcd;
  constexpr std::array<const char*, 3> kPlace{"x", "y", "z"};
  for (Eigen::Index k = 0; k < 3; ++k) {
    std::vector<float> values;
    values.reserve(cloud.positions_m.size());
    for (const Eigen::Vector3f& p : cloud.positions_m) values.push_back(p[k]);
    pcd.table.add<float>(kPlace[static_cast<std::size_t>(k)], values);
  }
  std::vector<float> packed;  // as PCL packs them
  packed.reserve(cloud.colors.size());
  for (const Eigen::Vector3f& color : cloud.colors) {
    std::uint32_t bits = 0;
    for (Eigen::Index k = 0; k < 3; ++k) {
      bits = (bits << 8U) | static_cast<std::uint32_t>(std::lround(255.0F * color[k]));
    }
    packed.push_back(std::bit_cast<float>(bits));
  }
  pcd.table.add<float>("rgb", packed);
  pcd.width = cloud.positions_m.size();
  return pcd;
}

class SceneScan final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {.name = "scan",
            .description = "scans a scene with a simulated laser scanner: a cloud with the true label of every point",
            .result_name = "scene"};
  }

  void declare(Options& options) override {
    options.value("scene", scene_, "SCENE", "room:SEED, street:SEED, or any other scene").required();
    options
        .value("--out", out_, "FILE",
               "the cloud, with the field label (.pcd, .ply, .txt, .csv), or its labels alone (.npy, .label)")
        .required();
    options.value("--names", names_, "FILE", "what the labels mean, as .json, else as text");
    options.group()
        .add_option_function<std::vector<std::string>>(
            "--station",
            [this](const std::vector<std::string>& texts) {
              for (const std::string& text : texts) config_.stations_m.push_back(parse_point("--station", text));
            },
            "place of the scanner, metres; may be given again; without it, where the scene's first views are from")
        ->type_name("X,Y,Z");
    options.angle("--step", config_.step_rad, "angle between rays, both ways");
    options.value("--range-noise", config_.range_noise_m, "METRES", "standard deviation of the range");
    options.value("--color-noise", config_.color_noise, "SHARE", "standard deviation of a colour channel");
  }

  void check(const GlobalOptions& /*global*/) override {
    LaserScanConfig tried = config_;
    if (tried.stations_m.empty()) tried.stations_m.emplace_back(Eigen::Vector3d::Zero());
    require_ok(tried.validate(), "--station, --step or noise");
    require_ok(check_labels_path(out_), "--out");
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    SACCADE_CHECK(check_output(out_, "--out", {}));
    SACCADE_CHECK(check_output(names_, "--names", {out_}));
    SACCADE_TRY(Scene scene, find_scene(scene_));
    if (config_.stations_m.empty()) {
      for (const Pose& pose : scene.scan) config_.stations_m.emplace_back(pose.translation());
    }
    if (config_.stations_m.empty()) {
      return Error{Errc::invalid_argument, "the scene has no first views; say --station X,Y,Z", scene_};
    }
    config_.seed = context.seed();
    SACCADE_TRY(const RayScene rays, RayScene::build(std::move(scene)));
    SACCADE_TRY(const LaserScan scan, scan_by_laser(rays, config_, context.executor(), context.progress()));
    if (scan.labels.empty()) {
      return Error{Errc::invalid_argument, "the scanner sees nothing from its stations", scene_};
    }
    std::vector<std::size_t> points(scan.names.size());
    for (const std::uint32_t label : scan.labels) ++points[label];
    std::vector<NamedLabel> names;
    json labels = json::array();
    for (std::size_t label = 1; label < scan.names.size(); ++label) {
      if (points[label] == 0) continue;
      NamedLabel named;
      named.number = static_cast<std::uint32_t>(label);
      named.name = scan.names[label];
      named.points = points[label];
      labels.push_back({{"number", label}, {"name", named.name}, {"points", named.points}});
      names.push_back(std::move(named));
    }
    SACCADE_CHECK(write_labels(out_, CloudFile{pcd_of(scan.cloud)}, scan.labels, names));
    if (!names_.empty()) {
      SACCADE_CHECK(names_.extension() == ".json" ? write_label_names_json(names_, names)
                                                  : write_label_names_text(names_, names));
    }
    std::string text = std::to_string(scan.labels.size()) + " points of " + std::to_string(names.size()) +
                       " segments, from " + std::to_string(config_.stations_m.size()) +
                       (config_.stations_m.size() == 1 ? " station, in " : " stations, in ") + out_.string() + "\n";
    return Outcome{.result = {{"scene", rays.scene().name},
                              {"points", scan.labels.size()},
                              {"stations", config_.stations_m.size()},
                              {"labels", std::move(labels)}},
                   .text = std::move(text)};
  }

 private:
  std::string scene_;
  std::filesystem::path out_;
  std::filesystem::path names_;
  LaserScanConfig config_;
};

}  // namespace

std::unique_ptr<Command> make_scene_scan() { return std::make_unique<SceneScan>(); }

}  // namespace saccade::cli

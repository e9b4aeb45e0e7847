// SPDX-License-Identifier: Apache-2.0
// saccade nbv: ranks view poses by what they would show of a region in a saved map.
#include <array>
#include <cmath>
#include <iomanip>
#include <optional>
#include <set>
#include <sstream>
#include <tuple>

#include "compute_backend.hpp"
#include "context.hpp"
#include "length_options.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/report/view_picture.hpp"
#include "saccade/views/view_gain.hpp"
#include "saccade/views/view_sphere.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 2> kViewFiles{"views.json", "views.png"};
constexpr double kDefaultRadius_m{0.2};

struct NbvOptions {
  std::filesystem::path map;
  std::optional<Eigen::Vector3d> poi;
  std::optional<double> radius_m;
  std::optional<Box> box;
  bool forget{false};
  std::filesystem::path poses_file;
  CameraOptions camera;
  ViewSphereConfig sphere;
  std::optional<Eigen::Vector3d> up;  ///< default: world z
  GainConfig gain;
  std::optional<Box> workspace;
  ComputeBackend backend{ComputeBackend::cpu};
  std::size_t top{10};
  bool all{false};

  [[nodiscard]] Region region() const {
    if (box) return *box;
    return Sphere{*poi, radius_m.value_or(kDefaultRadius_m)};
  }
  [[nodiscard]] Eigen::Vector3d center() const { return box ? Eigen::Vector3d{0.5 * (box->min + box->max)} : *poi; }
};

/// Candidates: from the view sphere, whose angles are then known, or from a file.
struct Candidates {
  std::vector<Pose> poses;
  std::vector<ViewCandidate> sphere;  ///< empty when they came from a file
};

/// Turns the candidates about the sphere's centre, so that what was up (world z) points along `up`.
void turn_upwards(std::vector<ViewCandidate>& candidates, const Eigen::Vector3d& center, const Eigen::Vector3d& up) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  const Pose T_turn = Eigen::Translation3d{center} * turn * Eigen::Translation3d{-center};
  for (ViewCandidate& candidate : candidates) candidate.T_world_camera = T_turn * candidate.T_world_camera;
}

Result<Candidates> make_candidates(const NbvOptions& options) {
  Candidates candidates;
  if (options.poses_file.empty()) {
    SACCADE_TRY(candidates.sphere, view_sphere(options.center(), options.sphere));
    if (options.up) turn_upwards(candidates.sphere, options.center(), *options.up);
    candidates.poses = poses_of(candidates.sphere);
  } else {
    SACCADE_TRY(candidates.poses, read_poses(options.poses_file));
  }
  return candidates;
}

/// The map as the views are to be judged in: nothing of this goes back to the file.
Result<TsdfSnapshot> prepare_map(const NbvOptions& options, const Executor& executor) {
  SACCADE_TRY(TsdfSnapshot loaded, load_map(options.map, executor));
  if (options.workspace) loaded.config.workspace = options.workspace;
  if (!options.forget) return loaded;
  TsdfMap map{std::move(loaded)};
  SACCADE_CHECK(map.forget(options.region()));
  return map.snapshot();
}

json region_json(const NbvOptions& options) {
  if (const auto& box = options.box) {
    return {{"kind", "box"}, {"min_m", point_json(box->min)}, {"max_m", point_json(box->max)}};
  }
  return {{"kind", "sphere"},
          {"center_m", point_json(*options.poi)},
          {"radius_m", options.radius_m.value_or(kDefaultRadius_m)}};
}

json view_json(const OrderedView& view, const Candidates& candidates) {
  json entry{{"gain", view.gain}, {"index", view.index}, {"T_world_camera", pose_to_json(view.T_world_camera)}};
  if (!candidates.sphere.empty()) {
    const ViewCandidate& on_sphere = candidates.sphere[view.index];
    entry["radius_m"] = on_sphere.radius_m;
    entry["longitude_rad"] = on_sphere.longitude_rad;
    entry["latitude_rad"] = on_sphere.latitude_rad;
    entry["roll_rad"] = on_sphere.roll_rad;
  }
  return entry;
}

json result_json(const NbvOptions& options, const Candidates& candidates, const GainResult& gains,
                 const std::vector<OrderedView>& ranked, std::size_t shown) {
  json views = json::array();
  for (std::size_t i = 0; i < shown; ++i) views.push_back(view_json(ranked[i], candidates));
  return {{"map", options.map.string()},
          {"region", region_json(options)},
          {"forgotten", options.forget},
          {"sensor", camera_to_json(options.gain.sensor)},
          {"tilt_rad", options.gain.tilt_rad},
          {"count", kGainCountNames.of(options.gain.count)},
          {"unknown_outside", kUnknownOutsideNames.of(options.gain.unknown_outside)},
          {"candidates", candidates.poses.size()},
          {"evaluated", gains.gains.size()},
          {"backend", gains.backend},
          {"rays_total", gains.rays_total},
          {"rays_cast", gains.rays_cast},
          {"ms", {{"prepare", gains.prepare_ms}, {"evaluate", gains.evaluate_ms}}},
          {"views", std::move(views)}};
}

/// Views of the printed table, by their places in the ranking: of each position on the sphere the best roll, and none
/// without gain.
struct TableRows {
  std::vector<std::size_t> ranks;
  std::size_t other_rolls{0};   ///< left out beside the best one
  std::size_t without_gain{0};  ///< only where the table would go on with them
};

TableRows table_rows(const Candidates& candidates, const std::vector<OrderedView>& ranked, std::size_t most) {
  std::set<std::tuple<double, double, double>> positions_um;
  TableRows rows;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    if (ranked[i].gain == 0) {
      if (rows.ranks.size() < most) rows.without_gain = ranked.size() - i;
      break;
    }
    const bool is_full = rows.ranks.size() == most;
    if (!candidates.sphere.empty()) {
      const Eigen::Array3d at_um = (1e6 * ranked[i].T_world_camera.translation()).array().round();
      const std::tuple position_um{at_um.x(), at_um.y(), at_um.z()};
      const bool is_other_roll =
          is_full ? positions_um.contains(position_um) : !positions_um.insert(position_um).second;
      rows.other_rolls += is_other_roll ? 1 : 0;
      if (is_other_roll) continue;
    }
    if (!is_full) rows.ranks.push_back(i);
  }
  return rows;
}

/// Says which views the table leaves out; empty where it has all that were asked for.
std::string unlisted_text(const TableRows& rows) {
  std::string text;
  if (rows.other_rolls > 0) text = std::to_string(rows.other_rolls) + " other rolls of these positions";
  if (rows.without_gain > 0) {
    text += (text.empty() ? "" : ", ") + std::to_string(rows.without_gain) + " of gain 0";
  }
  return text.empty() ? text : "views left out: " + text + " (--all --json FILE has all)\n";
}

std::string table_of(const NbvOptions& options, const Candidates& candidates, const GainResult& gains,
                     const std::vector<OrderedView>& ranked, std::size_t most) {
  std::ostringstream text;
  text << "rank      gain  ";
  if (!candidates.sphere.empty()) text << "longitude  latitude   roll  ";
  text << "position (m)\n";
  const TableRows rows = table_rows(candidates, ranked, most);
  for (const std::size_t i : rows.ranks) {
    const OrderedView& view = ranked[i];
    text << std::right << std::setw(4) << i + 1 << std::setw(10) << view.gain << "  ";
    if (!candidates.sphere.empty()) {
      const ViewCandidate& on_sphere = candidates.sphere[view.index];
      text << std::setw(8) << fixed(to_deg(on_sphere.longitude_rad), 0) << "°" << std::setw(9)
           << fixed(to_deg(on_sphere.latitude_rad), 0) << "°" << std::setw(6) << fixed(to_deg(on_sphere.roll_rad), 0)
           << "°  ";
    }
    const Eigen::Vector3d p = view.T_world_camera.translation();
    for (int axis = 0; axis < 3; ++axis) text << std::setw(8) << fixed(p[axis], 3);
    text << '\n';
  }
  text << unlisted_text(rows);
  const char* unit = options.gain.count == GainCount::rays ? "rays" : "distinct voxels";
  text << "gain: " << unit << " that would end in unknown space of the region; " << gains.gains.size() << " poses in "
       << fixed(gains.prepare_ms + gains.evaluate_ms, 0) << " ms, " << gains.rays_cast << " rays cast one by one\n";
  return text.str();
}

Status write_picture(const NbvOptions& options, const RunFolder& out, const TsdfSnapshot& map,
                     const std::vector<OrderedView>& ranked, const Executor& executor) {
  SACCADE_CHECK(out.remove(std::span{kViewFiles}.first(1)));
  std::vector<ScoredPose> scored;
  for (const OrderedView& view : ranked) scored.push_back({view.T_world_camera, static_cast<double>(view.gain)});
  ViewPictureConfig picture;
  picture.best = options.top;  // with --all as well: hundreds would hide each other
  picture.sensor = options.gain.sensor;
  picture.overview.up = options.up.value_or(Eigen::Vector3d::UnitZ());
  picture.gain_unit = kGainCountNames.of(options.gain.count);
  return write_png(out / "views.png", view_picture(map, options.region(), scored, executor, picture));
}

/// Says why every gain is 0, and which option helps.
std::string advice_without_gain(const NbvOptions& options, NoGain reason) {
  std::string text{"no view shows anything unknown of the region: every gain is 0; "};
  text += advice(reason);
  if (reason == NoGain::nothing_unknown && !options.forget) text += " (--forget)";
  if (reason == NoGain::cameras_in_unknown || reason == NoGain::cameras_blocked) text += " (--workspace)";
  return text;
}

class Nbv final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override { return {"nbv", "ranks view poses for a region in a saved map"}; }

  void declare(Options& options) override {
    options.value("map", nbv_.map, "MAP", "saved map (.sacmap)").required();
    declare_region(options);
    declare_candidates(options);
    declare_gain(options);
    options.choice("--backend", nbv_.backend, kComputeBackendNames,
                   "where views are evaluated; a GPU pays where one map is asked often");
    options.value("--top", nbv_.top, "N", "views to print and to write").whole_number();
    options.flag("--all", nbv_.all, "print and write all views");
    options.folder({.help = "folder for views.json and views.png",
                    .files = {kViewFiles.begin(), kViewFiles.end()},
                    .document = kViewFiles.front()});
    options.flag("--no-pictures{false}", pictures_, "draw no picture");
  }

  void check(const GlobalOptions& /*global*/) override {
    if (nbv_.poi.has_value() == nbv_.box.has_value()) usage_error("--poi", "give either --poi or --box");
    if (nbv_.box && nbv_.radius_m) usage_error("--radius", "goes with --poi, not with --box");
    if (nbv_.radius_m) require_length(*nbv_.radius_m, "--radius");
    if (nbv_.top == 0) usage_error("--top", "must be at least 1");
    nbv_.gain.sensor = nbv_.camera.camera(nbv_.gain.sensor);
    require_ok(nbv_.gain.validate(), "the sensor");
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    SACCADE_TRY(const Candidates candidates, make_candidates(nbv_));
    context.stage("loading the map");
    SACCADE_TRY(const TsdfSnapshot map, prepare_map(nbv_, context.executor()));
    context.lap("load");
    std::optional<Error> problem;
    SACCADE_TRY(const GainResult gains,
                evaluate_views_on(nbv_.backend, map, nbv_.region(), candidates.poses, nbv_.gain, context.executor(),
                                  context.stage("evaluating views"), problem));
    if (problem) context.bar().warn("the GPU failed: " + problem->message + "; the CPU did its work");
    const std::vector<OrderedView> ranked = order_views(gains.gains, candidates.poses);
    context.lap("evaluate");
    const std::size_t shown = nbv_.all ? ranked.size() : std::min(nbv_.top, ranked.size());
    std::string text = table_of(nbv_, candidates, gains, ranked, shown);
    if (const RunFolder* out = context.folder()) {
      context.stage("drawing");
      if (pictures_) SACCADE_CHECK(write_picture(nbv_, *out, map, ranked, context.executor()));
      text += "results: " + context.out().string() + "\n";
    }
    return Outcome{.result = result_json(nbv_, candidates, gains, ranked, shown), .text = std::move(text)}.empty_if(
        ranked.front().gain == 0, advice_without_gain(nbv_, gains.no_gain));
  }

 private:
  void declare_region(Options& options) {
    options.point("--poi", nbv_.poi, "point of interest: the centre of the region and of the view sphere, metres");
    options.value("--radius", nbv_.radius_m, "METRES", "radius of the region around --poi, metres (default: 0.2)");
    options.box("--box", nbv_.box, "box region, instead of --poi and --radius");
    options.flag("--forget", nbv_.forget, "set the region back to unknown first (the file stays as it is)");
    options.box("--workspace", nbv_.workspace, "box outside of which nothing counts as unknown, instead of the map's");
  }

  void declare_candidates(Options& options) {
    options.value("--poses", nbv_.poses_file, "FILE",
                  "candidate poses (TUM, matrices, JSON), instead of the view sphere");
    options.lengths("--distance", nbv_.sphere.radii_m,
                    "radius of the view sphere, metres; several separated by commas (default: 0.8)");
    options.direction("--up", nbv_.up, "direction up in the map's world: the pole of the view sphere (default: 0,0,1)");
  }

  void declare_gain(Options& options) {
    add_camera_options(options.group(), nbv_.camera, true);
    options.choice("--count", nbv_.gain.count, kGainCountNames, "count rays, or the distinct voxels that they end in");
    options.choice("--unknown-outside", nbv_.gain.unknown_outside, kUnknownOutsideNames,
                   "effect of unknown voxels outside the region on a ray");
    options.angle("--tilt", nbv_.gain.tilt_rad, "the sensor will be tilted up and down by this angle, degrees");
  }

  NbvOptions nbv_;
  bool pictures_{true};
};

}  // namespace

void add_nbv(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Nbv>(program, global, action);
}

}  // namespace saccade::cli

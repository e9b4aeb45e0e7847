// SPDX-License-Identifier: Apache-2.0
// saccade cell check: starts the devices of a cell, shows what they deliver, and says what is wrong.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "cell_options.hpp"
#include "context.hpp"
#include "explore_devices.hpp"
#include "saccade/arm/arm_silhouette.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/report/depth_picture.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

/// What is found out of one cell, line by line.
class CellCheck {
 public:
  CellCheck(const ExploreOptions& options, Scene scene) : options_{options}, scene_{std::move(scene)} {}

  void run(const std::filesystem::path& out) {
    check_arm();
    check_joints();
    check_scan();
    check_camera(out);
    check_hand();
  }

  [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& lines() const { return lines_; }
  [[nodiscard]] const std::vector<Error>& problems() const { return problems_; }
  [[nodiscard]] json result() const {
    json problems = json::array();
    for (const Error& problem : problems_) problems.push_back(problem.to_string());
    json result = found_;
    result["cell"] = scene_.name;
    result["problems"] = std::move(problems);
    return result;
  }

 private:
  void say(std::string name, std::string text) { lines_.emplace_back(std::move(name), std::move(text)); }
  void wrong(const char* name, const Error& problem) {
    say(name, "wrong: " + problem.to_string());
    problems_.push_back(problem);
  }

  void check_arm() {
    if (!options_.has_arm()) return say("arm", options_.robot_command.empty() ? "none" : "plans for itself");
    auto read = read_described_arm(options_);
    if (!read) return wrong("arm", read.error());
    arm_ = std::move((*read)->arm);
    const auto ik = InverseKinematics::create(*arm_);
    found_["arm"] = arm_->name();
    say("arm", arm_->name() + ", " + std::to_string(arm_->dof()) + " joints, inverse kinematics " +
                   (ik ? std::string{to_string(ik->method())} : ik.error().to_string()));
    for (const std::string& choice : (*read)->choices) say("", choice);
    found_["arm_choices"] = (*read)->choices;
  }

  void check_joints() {
    if (!arm_) return;
    std::shared_ptr<JointController> joints;
    const bool real = !options_.joints_command.empty();
    if (real) {
      auto started = ProgramJoints::start(joints_config(options_, *arm_));
      if (!started) return wrong("joints", started.error());
      joints = *std::move(started);
    }
    auto planned = planned_arm(*arm_, scene_, options_.run, options_.arm, std::move(joints));
    if (!planned) return wrong("joints", planned.error());
    robot_.emplace(*std::move(planned));
    const Configuration q = *robot_->configuration();
    found_["q"] = std::vector<double>{q.begin(), q.end()};
    std::string text = real ? "stand at" : "simulated, stand at";
    for (const double value : q) text += " " + fixed(value, 3);
    const Eigen::Vector3d p = robot_->T_world_camera().translation();
    say("joints",
        text + "; the camera is at (" + fixed(p.x(), 3) + ", " + fixed(p.y(), 3) + ", " + fixed(p.z(), 3) + ") m");
  }

  void check_scan() {
    if (!robot_ || scene_.scan.empty()) return;
    // What is unknown is no obstacle to a scan, for which the arm's way is set free.
    ExploreOptions known = options_;
    known.arm.obstacles.unknown_is_obstacle = false;
    known.arm.start = robot_->configuration();
    auto planned = planned_arm(*arm_, scene_, known.run, known.arm);
    if (!planned) return wrong("scan", planned.error());
    RefusalCounts refused;
    std::size_t reached = 0;
    double motion_s = 0.0;
    for (const Pose& pose : scene_.scan) {
      const auto motion = planned->plan(std::span{&pose, 1});
      if (!motion) return wrong("scan", motion.error());
      if (!motion->motion) {
        refused.add(motion->refusal.value_or(Refusal::declined));
        continue;
      }
      ++reached;
      motion_s += motion->motion->trajectory.duration_s();
      static_cast<void>(planned->place(motion->motion->trajectory.end()));
    }
    found_["scan"] = {{"poses", scene_.scan.size()}, {"reached", reached}, {"motion_s", motion_s}};
    say("scan", std::to_string(reached) + " of " + std::to_string(scene_.scan.size()) + " poses, " +
                    fixed(motion_s, 1) + " s of motion" + (refused.total() > 0 ? "; " + in_words(refused) : ""));
    if (reached == 0) {
      problems_.push_back(
          {Errc::invalid_argument, "not one pose of the scan can be reached (" + in_words(refused) + ")", scene_.name});
    }
  }

  void check_camera(const std::filesystem::path& out) {
    if (options_.camera_command.empty()) return say("camera", "simulated");
    auto camera = ProgramCamera::start(program_config(options_, options_.camera_command, options_.cell.camera));
    if (!camera) return wrong("camera", camera.error());
    const Pose T_world_camera = robot_                ? robot_->T_world_camera()
                                : scene_.scan.empty() ? Pose::Identity()
                                                      : scene_.scan.front();
    const Stopwatch watch;
    auto frame = camera->capture(T_world_camera);
    if (!frame) return wrong("camera", frame.error());
    const double ms = watch.elapsed_ms();
    const PinholeCamera& intrinsics = camera->intrinsics();
    const auto returns = std::count_if(frame->depth.pixels().begin(), frame->depth.pixels().end(),
                                       [](float depth) { return depth > 0.0F; });
    const double share = static_cast<double>(returns) / static_cast<double>(frame->depth.size());
    found_["camera"] = {{"intrinsics", camera_to_json(intrinsics)}, {"frame_ms", ms}, {"returns", share}};
    say("camera", std::to_string(intrinsics.width) + " × " + std::to_string(intrinsics.height) +
                      " pixels, a frame in " + fixed(ms, 0) + " ms, depth in " + fixed(100.0 * share, 1) +
                      " % of them" + (frame->time_s ? "" : ", without a time stamp"));
    if (returns == 0) problems_.push_back({Errc::corrupt_data, "the frame has no depth at all", "camera"});
    ColorImage picture = depth_picture(frame->depth, depth_scale(frame->depth));
    if (robot_) draw_arm(intrinsics, frame->depth, picture);
    if (out.empty()) return;
    const Status written = write_png(out / "camera.png", picture);
    if (!written) return wrong("picture", written.error());
    say("picture", (out / "camera.png").string());
  }

  /// Lays the arm's own silhouette over the picture of the frame.
  void draw_arm(const PinholeCamera& intrinsics, const DepthImage& measured, ColorImage& picture) {
    const auto silhouette = ArmSilhouette::create(*arm_, intrinsics);
    if (!silhouette) return wrong("mount", silhouette.error());
    const DepthImage arm = silhouette->depth(*robot_->configuration());
    std::size_t covered = 0;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < arm.size(); ++i) {
      if (!(arm.data()[i] > 0.0F)) continue;
      ++covered;
      if (measured.data()[i] > 0.0F && std::abs(measured.data()[i] - arm.data()[i]) < 0.03F) ++seen;
      for (std::uint8_t& channel : picture.data()[i]) channel = static_cast<std::uint8_t>(128 + channel / 2);
    }
    const double share = static_cast<double>(covered) / static_cast<double>(arm.size());
    found_["arm_in_picture"] = share;
    std::string text = fixed(100.0 * share, 1) + " % of the picture is the arm";
    if (covered > 0) {
      text += ", where the frame has its depth in " +
              fixed(100.0 * static_cast<double>(seen) / static_cast<double>(covered), 0) + " %";
    }
    say("mount", text);
  }

  void check_hand() {
    const std::string& command = options_.cell.hand.command;
    if (command.empty()) return;
    auto hand = ProgramHand::start(program_config(options_, command, options_.cell.hand));
    if (!hand) return wrong("hand", hand.error());
    const auto sample = (*hand)->next();
    if (!sample) return wrong("hand", sample.error());
    if (!*sample) return say("hand", "no samples");
    const Eigen::Vector3d& p = (*sample)->position_m;
    found_["hand"] = {{"time_s", (*sample)->time_s}, {"seen", p.allFinite()}};
    say("hand", p.allFinite() ? "at (" + fixed(p.x(), 3) + ", " + fixed(p.y(), 3) + ", " + fixed(p.z(), 3) + ") m"
                              : "not in view");
  }

  const ExploreOptions& options_;
  Scene scene_;
  std::optional<ArmModel> arm_;
  std::optional<PlannedArm> robot_;
  std::vector<std::pair<std::string, std::string>> lines_;
  std::vector<Error> problems_;
  json found_;
};

class CellCheckCommand final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {.name = "check",
            .description = "starts each device of a cell, and shows what it delivers",
            .result_name = "cell check"};
  }

  void declare(Options& options) override {
    options.value("cell", cell_.scene, "CELL", "a cell's YAML file (docs/reference/cell.md)").required();
    options.folder({.help = "folder for a picture of a frame, with the arm in it",
                    .files = {"camera.png"},
                    .opened_by_command = true});
    add_arm_options(options.group(), cell_);
    add_device_options(options.group(), cell_);
  }

  void check(const GlobalOptions& global) override {
    check_device_options(cell_);
    if (cell_.robot.empty()) cell_.robot = "free";
    check_arm_options(cell_, global);
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    if (cell_.cell_problem) return *cell_.cell_problem;
    SACCADE_TRY(Scene scene, find_scene(cell_.scene));
    SACCADE_CHECK(context.open_folder());
    CellCheck check{cell_, std::move(scene)};
    check.run(context.out());
    std::ostringstream text;
    for (const auto& [name, line] : check.lines()) text << std::left << std::setw(9) << name << line << '\n';
    Outcome outcome{.result = check.result(), .text = text.str()};
    const std::size_t count = check.problems().size();
    if (count == 0) return outcome;
    return std::move(outcome).empty_if(true, std::to_string(count) + (count == 1 ? " thing is" : " things are") +
                                                 " wrong: " + check.problems().front().to_string());
  }

 private:
  ExploreOptions cell_;
};

class CellCommands final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override { return {"cell", "checks the devices of a real cell"}; }
  [[nodiscard]] std::vector<std::unique_ptr<Command>> parts() const override {
    std::vector<std::unique_ptr<Command>> parts;
    parts.push_back(std::make_unique<CellCheckCommand>());
    return parts;
  }
};

}  // namespace

void add_cell(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<CellCommands>(program, global, action);
}

}  // namespace saccade::cli

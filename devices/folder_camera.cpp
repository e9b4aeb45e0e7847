// SPDX-License-Identifier: Apache-2.0
// A recorded folder of RGB-D frames as a camera of Saccade.
//
//   saccade-folder-camera FOLDER [--in-order] [--layout NAME] [--intrinsics FX,FY,CX,CY] [--poses FILE] [--color 0|1]
//                         [--min-range M] [--max-range M]
//
// The answer is the frame that was taken nearest to the pose asked for, and where it was taken; half a metre counts as
// much as one radian. With --in-order frames come one after the other. A frame taken more than 0.5 m away is an error.
// Layouts and the other options are those of `saccade fuse`.
#include <algorithm>
#include <iomanip>
#include <limits>
#include <sstream>

#include "camera_program.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"

namespace {

using namespace saccade;
using devices::Options;
using devices::Shot;

constexpr double kFarthest_m{0.5};  // Saccade rejects frames from farther away
constexpr double kMetresPerRadian{0.5};

/// Returns the value, or throws its error.
template <class T>
T wanted(Result<T> result) {
  if (!result) throw std::runtime_error{result.error().to_string()};
  return *std::move(result);
}

template <class Bytes>
void append(std::string& bytes, const Bytes& pixels) {
  const auto more = std::as_bytes(std::span{pixels});
  bytes.append(reinterpret_cast<const char*>(more.data()), more.size());
}

struct Taken {
  std::size_t position{0};
  std::optional<Pose> T_world_camera;
};

class FolderCamera final : public devices::DeviceCamera {
 public:
  explicit FolderCamera(const Options& options) : folder_{options.text("")}, in_order_{options.has("--in-order")} {
    if (folder_.empty()) throw std::runtime_error{"which folder? saccade-folder-camera FOLDER"};
    source_ = wanted(open_rgbd_folder(folder_, config_of(options)));
    std::string why;
    for (std::size_t i = 0; i < *source_->size(); ++i) {
      const Result<Pose> pose = source_->pose_at(i);
      if (pose) {
        frames_.push_back({i, *pose});
      } else if (in_order_) {
        frames_.push_back({i, std::nullopt});
      } else {
        why = pose.error().to_string();
      }
    }
    if (frames_.empty()) throw std::runtime_error{"no frame of " + folder_ + " has a pose; the last: " + why};
  }

  [[nodiscard]] nlohmann::json hello() const override {
    const PinholeCamera& c = source_->camera();
    return devices::camera_hello(c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.min_range_m, c.max_range_m, "float32_m",
                                 source_->info().has_color ? "rgb8" : "none");
  }

  [[nodiscard]] Shot capture(const nlohmann::json& T_world_camera) override {
    const Pose asked = wanted(pose_from_json(T_world_camera));
    const Taken& taken = in_order_ ? next() : nearest(asked);
    if (taken.T_world_camera && distance_m(asked, *taken.T_world_camera) > kFarthest_m) refuse(asked, taken);
    const Frame frame = wanted(source_->at(taken.position));
    Shot shot;
    append(shot.bytes, frame.depth.pixels());
    if (source_->info().has_color) {
      append(shot.bytes, frame.color.value_or(ColorImage{frame.depth.width(), frame.depth.height()}).pixels());
    }
    if (taken.T_world_camera) shot.T_world_camera = pose_to_json(*taken.T_world_camera);
    shot.time_s = frame.time_s;
    return shot;
  }

 private:
  [[nodiscard]] static RgbdFolderConfig config_of(const Options& options) {
    RgbdFolderConfig config;
    if (options.has("--layout")) {
      std::string name = options.text("--layout");
      std::replace(name.begin(), name.end(), '-', '_');  // as `saccade fuse` writes it
      const auto layout = kRgbdLayoutNames.find(name);
      if (!layout) throw std::runtime_error{"--layout must be " + kRgbdLayoutNames.listed()};
      config.layout = *layout;
    }
    if (options.has("--intrinsics")) config.intrinsics = wanted(parse_intrinsics(options.text("--intrinsics")));
    if (options.has("--poses")) config.poses_file = options.text("--poses");
    if (options.has("--min-range")) config.min_range_m = options.number("--min-range", 0.0);
    if (options.has("--max-range")) config.max_range_m = options.number("--max-range", 0.0);
    config.read_color = options.number("--color", 1.0) > 0.0;
    config.require_poses = false;
    return config;
  }

  static double distance_m(const Pose& a, const Pose& b) { return (a.translation() - b.translation()).norm(); }

  [[nodiscard]] const Taken& next() {
    if (played_ == frames_.size()) {
      throw std::runtime_error{"all " + std::to_string(frames_.size()) + " frames of " + folder_ + " were played"};
    }
    return frames_[played_++];
  }

  [[nodiscard]] const Taken& nearest(const Pose& asked) const {
    const auto far = [&](const Taken& taken) {
      const Pose& pose = *taken.T_world_camera;
      return distance_m(asked, pose) + kMetresPerRadian * rotation_angle_rad(asked.inverse() * pose);
    };
    const auto close = [&](const Taken& taken) { return distance_m(asked, *taken.T_world_camera) <= kFarthest_m; };
    const Taken* best = &frames_.front();
    for (const Taken& taken : frames_) {
      if (std::pair{!close(taken), far(taken)} < std::pair{!close(*best), far(*best)}) best = &taken;
    }
    return *best;
  }

  [[noreturn]] void refuse(const Pose& asked, const Taken& taken) const {
    Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Array3d high = -low;
    for (const Taken& each : frames_) {
      if (!each.T_world_camera) continue;
      low = low.min(each.T_world_camera->translation().array());
      high = high.max(each.T_world_camera->translation().array());
    }
    std::ostringstream text;
    text << std::fixed << std::setprecision(2) << (in_order_ ? "the next" : "the nearest") << " frame, number "
         << taken.position << ", was taken " << distance_m(asked, *taken.T_world_camera)
         << " m from the pose asked for, more than " << kFarthest_m << " m; " << folder_ << " has " << frames_.size()
         << " frames, taken at x " << low.x() << " to " << high.x() << ", y " << low.y() << " to " << high.y() << ", z "
         << low.z() << " to " << high.z() << " m";
    throw std::runtime_error{text.str()};
  }

  std::string folder_;
  bool in_order_;
  std::unique_ptr<RgbdFolderSource> source_;
  std::vector<Taken> frames_;
  std::size_t played_{0};
};

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options{argc, argv, {"--in-order"}};
    options.only({"", "--in-order", "--layout", "--intrinsics", "--poses", "--color", "--min-range", "--max-range"});
    return devices::run_camera([&] { return std::make_unique<FolderCamera>(options); });
  } catch (const std::exception& e) {
    std::cerr << "saccade-folder-camera: " << e.what() << '\n';
    return 1;
  }
}

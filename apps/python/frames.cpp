// SPDX-License-Identifier: Apache-2.0
// Recorded RGB-D frames: folders of PNGs, bags of ROS, MCAP files.
#include <mutex>

#include "arrays.hpp"
#include "saccade/io/bags/bags.hpp"
#include "saccade/sensor/gap_filling.hpp"

namespace saccade::python {
namespace {

/// Frame as arrays.
struct FrameArrays {
  std::size_t index{0};
  std::string name;
  std::optional<double> time_s;
  py::object depth;
  py::object color;
  py::object T_world_camera;
};

/// Frames that are read on request. Python threads may call it concurrently: they wait for each other.
class FrameFolder {
 public:
  FrameFolder(std::unique_ptr<RgbdFolderSource> source, std::optional<GapFilling> gaps)
      : content_{std::make_shared<Content>()} {
    content_->source = std::move(source);
    content_->gaps = gaps;
  }

  [[nodiscard]] std::size_t size() const { return content_->source->size().value_or(0); }
  [[nodiscard]] const RgbdFolderSource& source() const { return *content_->source; }

  [[nodiscard]] FrameArrays at(std::size_t position) const {
    const auto read = [&]() -> Result<Frame> {
      const py::gil_scoped_release released;
      const std::scoped_lock lock{content_->mutex};
      SACCADE_TRY(Frame frame, content_->source->at(position));
      if (!content_->gaps) content_->gaps = choose_gap_filling(first_depth(frame));
      frame.depth = fill_gaps(frame.depth, *content_->gaps);
      return frame;
    };
    const Frame frame = take(read());
    FrameArrays arrays{frame.index, frame.name, frame.time_s, from_depth(frame.depth), py::none(), py::none()};
    if (frame.color) arrays.color = from_color(*frame.color);
    if (frame.T_world_camera) arrays.T_world_camera = from_pose(*frame.T_world_camera);
    return arrays;
  }

 private:
  struct Content {
    std::mutex mutex;
    std::unique_ptr<RgbdFolderSource> source;
    std::optional<GapFilling> gaps;
  };

  /// Returns the first readable depth, whichever frame is requested first: it determines the gap filling, as in the
  /// program.
  [[nodiscard]] DepthImage first_depth(const Frame& asked) const {
    for (std::size_t i = 0; i < size(); ++i) {
      auto frame = content_->source->at(i);
      if (frame) return std::move(frame->depth);
    }
    return asked.depth;
  }

  std::shared_ptr<Content> content_;
};

/// Iterator over the frames. An unreadable frame raises, and the next call continues after it.
struct FrameIterator {
  FrameFolder frames;
  std::size_t position{0};
};

struct TopicNames {
  std::string depth, info, color, world_frame;
};

Result<std::unique_ptr<RgbdFolderSource>> open_source(const std::string& path, const RgbdFolderConfig& config,
                                                      const TopicNames& topics) {
  if (is_bag(path)) {
    return open_bag_frames(path, {config, topics.depth, topics.info, topics.color, topics.world_frame});
  }
  if (!topics.depth.empty() || !topics.info.empty() || !topics.color.empty() || !topics.world_frame.empty()) {
    return Error{Errc::invalid_argument, "topics and world_frame are for bags of ROS and MCAP files; this is neither",
                 path};
  }
  return open_rgbd_folder(path, config);
}

FrameFolder open_frames(const std::string& path, const std::string& layout, const std::optional<PinholeCamera>& camera,
                        const std::optional<std::string>& poses, std::optional<double> depth_scale,
                        const std::optional<std::string>& mask, std::optional<double> min_range_m,
                        std::optional<double> max_range_m, std::optional<int> fill_gaps_px, bool read_color,
                        bool require_poses, std::size_t first, std::size_t every, std::optional<std::size_t> count,
                        const TopicNames& topics) {
  RgbdFolderConfig config;
  config.layout = value_of(kRgbdLayoutWords, layout, "layout");
  if (camera) {
    const PinholeCamera& c = *camera;
    config.intrinsics =
        Intrinsics{c.fx, c.fy, c.cx, c.cy, c.width, c.height, c.min_range_m, c.max_range_m, std::nullopt};
  }
  if (depth_scale) config.encoding = DepthEncoding{*depth_scale, false};
  if (poses) config.poses_file = *poses;
  if (mask) config.mask_file = *mask;
  config.min_range_m = min_range_m;
  config.max_range_m = max_range_m;
  config.read_color = read_color;
  config.require_poses = require_poses;
  config.first = first;
  config.every_nth = every;
  config.count = count;
  std::optional<GapFilling> gaps;
  if (fill_gaps_px) {
    gaps = GapFilling{*fill_gaps_px};
    take(gaps->validate());
  }
  auto source = [&] {
    const py::gil_scoped_release released;
    return open_source(path, config, topics);
  }();
  return {take(std::move(source)), gaps};
}

FrameArrays frame_at(const FrameFolder& frames, py::ssize_t index) {
  const auto size = static_cast<py::ssize_t>(frames.size());
  if (index < -size || index >= size) {
    throw py::index_error{"there are " + std::to_string(size) + " frames, none at " + std::to_string(index)};
  }
  return frames.at(static_cast<std::size_t>(index < 0 ? index + size : index));
}

std::string text_of_frames(const FrameFolder& frames) {
  const RgbdFolderInfo& info = frames.source().info();
  const std::string kind = info.is_bag ? "bag" : std::string{kRgbdLayoutWords.of(info.layout)};
  return py::str("<saccade.Frames: {} frames, {}, poses: {}, color: {}>")
      .format(frames.size(), kind, info.has_poses, info.has_color);
}

}  // namespace

void bind_frames(py::module_& module) {
  py::class_<FrameArrays>(module, "Frame", "A recorded frame; depth and colour share the camera.")
      .def_readonly("depth", &FrameArrays::depth,
                    "H x W float32, metres along z; 0 or NaN: no return; d < 0: seen free up to |d|.")
      .def_readonly("color", &FrameArrays::color, "H x W x 3 uint8, or None.")
      .def_readonly("T_world_camera", &FrameArrays::T_world_camera, "4 x 4 float64, or None.")
      .def_readonly("time_s", &FrameArrays::time_s, "Seconds, or None.")
      .def_readonly("name", &FrameArrays::name, "What a person would call it.")
      .def_readonly("index", &FrameArrays::index, "Position in the recording, skipped frames counted.");
  py::class_<FrameIterator>(module, "FrameIterator", "Goes through frames.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", [](FrameIterator& iterator) {
        if (iterator.position >= iterator.frames.size()) throw py::stop_iteration{};
        return iterator.frames.at(iterator.position++);
      });
  py::class_<FrameFolder>(module, "Frames", "Recorded RGB-D frames, each read when it is asked for.")
      .def("__len__", &FrameFolder::size)
      .def("__iter__", [](const FrameFolder& frames) { return FrameIterator{frames}; })
      .def("__getitem__", &frame_at, py::arg("index"))
      .def_property_readonly(
          "camera", [](const FrameFolder& frames) { return frames.source().camera(); }, "PinholeCamera of all frames.")
      .def_property_readonly("has_poses", [](const FrameFolder& f) { return f.source().info().has_poses; })
      .def_property_readonly("has_color", [](const FrameFolder& f) { return f.source().info().has_color; })
      .def_property_readonly(
          "damage", [](const FrameFolder& frames) { return frames.source().info().damage; },
          "What is wrong with a bag, for people; empty where nothing is.")
      .def("__repr__", &text_of_frames);
  module.def(
      "open_frames",
      [](const std::string& path, const std::string& layout, const std::optional<PinholeCamera>& camera,
         const std::optional<std::string>& poses, std::optional<double> depth_scale,
         const std::optional<std::string>& mask, std::optional<double> min_range_m, std::optional<double> max_range_m,
         std::optional<int> fill_gaps_px, bool color, bool require_poses, std::size_t first, std::size_t every,
         std::optional<std::size_t> count, const std::string& depth_topic, const std::string& info_topic,
         const std::string& color_topic, const std::string& world_frame) {
        return open_frames(path, layout, camera, poses, depth_scale, mask, min_range_m, max_range_m, fill_gaps_px,
                           color, require_poses, first, every, count,
                           {depth_topic, info_topic, color_topic, world_frame});
      },
      py::arg("path"), py::arg("layout") = "auto", py::kw_only(), py::arg("camera") = py::none(),
      py::arg("poses") = py::none(), py::arg("depth_scale") = py::none(), py::arg("mask") = py::none(),
      py::arg("min_range_m") = py::none(), py::arg("max_range_m") = py::none(), py::arg("fill_gaps_px") = py::none(),
      py::arg("color") = true, py::arg("require_poses") = true, py::arg("first") = 0, py::arg("every") = 1,
      py::arg("count") = py::none(), py::arg("depth_topic") = "", py::arg("info_topic") = "",
      py::arg("color_topic") = "", py::arg("world_frame") = "",
      "Opens a folder of RGB-D frames, a bag of ROS (.bag) or an MCAP file (.mcap), as saccade fuse does. `layout`: "
      "auto, seven-scenes, tum, princeton, open3d, scannet, bundlefusion, rtabmap, replica, bop, icl-nuim or sun3d. "
      "`camera`: "
      "PinholeCamera in place of the folder's. `poses`: file of "
      "T_world_camera in place of the folder's. `depth_scale`: depth samples per metre. `mask`: PNG (0: ignored) or "
      "JSON polygons. `fill_gaps_px`: close gaps up to this wide; None: 2 where the first frame has them all "
      "over. `require_poses`: where there are poses, a frame without a good one is an error. Topics and `world_frame` "
      "are of bags. Returns Frames.");
}

}  // namespace saccade::python

// SPDX-License-Identifier: Apache-2.0
#pragma once
// Request and result of `saccade filter`, for its output.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"
#include "json_output.hpp"
#include "options.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"

namespace saccade::cli {

class Options;

constexpr std::string_view kFilterFile{"filter.json"};

struct FilterOptions {
  std::vector<std::filesystem::path> frames;  ///< depth images, and folders of them
  CameraOptions camera_options;
  PinholeCamera camera;
  std::optional<double> depth_scale;  ///< samples per metre; none: 1000, and floats are metres
  DepthEncoding encoding;
  DepthFilterConfig filter;
  std::size_t pictures{10};  ///< number of frames, the first ones, of which there is a picture
  bool write_pictures{true};
};

struct InputFrame {
  std::filesystem::path file;
  bool from_folder{false};
  std::optional<PinholeCamera> camera{};    ///< that of an RGB-D folder, where no option names one
  std::optional<DepthEncoding> encoding{};  ///< that of an RGB-D folder
};

/// Frames that the options name, and what the user should know of the choice.
struct FilterInput {
  std::vector<InputFrame> frames;
  std::vector<std::string> notes;
};

struct FilteredFrame {
  std::filesystem::path file;
  std::size_t points{0};  ///< within the camera's range
  std::size_t shadow_points{0};
  std::size_t veil_points{0};
  std::size_t out_of_range{0};
  double ms{0.0};  ///< time of the filter alone
};

struct LeftOutFile {
  std::filesystem::path file;
  Error error;
};

struct FilterResult {
  std::vector<FilteredFrame> frames;
  std::vector<std::filesystem::path> planned;  ///< frames that were to be filtered
  std::vector<LeftOutFile> left_out;           ///< files of folders that cannot be used
  std::size_t other_kinds{0};  ///< those of them that are images of another kind, such as colours beside the depth
  [[nodiscard]] std::size_t points() const;
  [[nodiscard]] std::size_t out_of_range() const;
  /// Whether every frame was filtered or left out.
  [[nodiscard]] bool is_complete() const { return frames.size() + left_out.size() == planned.size(); }
};

void declare_filter(Options& declared, FilterOptions& options);
void check_filter_options(FilterOptions& options);
/// Lists the frames. Of a folder of RGB-D frames in a known layout, they are its depth images; of any other folder,
/// its images but for those whose names say that they are labels, colours or masks.
[[nodiscard]] Result<FilterInput> filter_input(const FilterOptions& options);
/// @param out  folder of the results
[[nodiscard]] nlohmann::json filter_json(const FilterOptions& options, const std::string& out,
                                         const FilterResult& result, bool interrupted);
[[nodiscard]] std::string filter_text(const std::string& out, const FilterResult& result);
/// Warns where most of the measured pixels lie outside of the camera's range; empty otherwise.
[[nodiscard]] std::string filter_range_warning(const FilterResult& result);

}  // namespace saccade::cli

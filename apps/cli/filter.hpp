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
  std::vector<LeftOutFile> left_out;  ///< files of folders that cannot be used
  std::size_t other_kinds{0};  ///< those of them that are images of another kind, such as colours beside the depth
  [[nodiscard]] std::size_t points() const;
};

void declare_filter(Options& declared, FilterOptions& options);
void check_filter_options(FilterOptions& options);
/// @param out  folder of the results
[[nodiscard]] nlohmann::json filter_json(const FilterOptions& options, const std::string& out,
                                         const FilterResult& result, bool interrupted);
[[nodiscard]] std::string filter_text(const std::string& out, const FilterResult& result);

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once
// What `saccade filter` was asked for and what it did, for its output.

#include <cstddef>
#include <filesystem>
#include <vector>

#include "command.hpp"
#include "json_output.hpp"
#include "options.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"

namespace saccade::cli {

struct FilterOptions {
  std::vector<std::filesystem::path> frames;  ///< 16-bit PNG files, and folders of them
  std::filesystem::path out;
  CameraOptions camera_options;
  PinholeCamera camera;
  DepthEncoding encoding;
  DepthFilterConfig filter;
  std::size_t pictures{10};  ///< of the first so many frames
  bool force{false};
};

struct FilteredFrame {
  std::filesystem::path file;
  std::size_t points{0};  ///< within the camera's range
  std::size_t shadow_points{0};
  std::size_t veil_points{0};
  std::size_t out_of_range{0};
  double ms{0.0};  ///< of the filter alone
};

struct FilterResult {
  std::vector<FilteredFrame> frames;
  std::vector<Error> left_out;  ///< files of folders that cannot be used
  [[nodiscard]] std::size_t points() const;
};

void add_filter_options(CLI::App& command, FilterOptions& options);
void check_filter_options(FilterOptions& options);
[[nodiscard]] nlohmann::json filter_json(const FilterOptions& options, const FilterResult& result, bool interrupted);
void print_filter(const FilterOptions& options, const FilterResult& result);

}  // namespace saccade::cli

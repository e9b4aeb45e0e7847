// SPDX-License-Identifier: Apache-2.0
#pragma once
// Options that several subcommands share: lists of numbers, boxes, polygons, and the camera.

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "saccade/core/names.hpp"
#include "saccade/core/region.hpp"
#include "saccade/core/result.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/sensor/mask.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace saccade::cli {

/// Throws what CLI11 reports as a usage error of that option.
[[noreturn]] void usage_error(const std::string& option, const std::string& message);
/// As usage_error, for the errors of a library check on values that came from options.
void require_ok(const Status& status, const std::string& option);
void require_positive(double value, const std::string& option);
/// Returns the whole of the text as a number from 0 to 2⁶⁴ − 1; nullopt for any other text.
[[nodiscard]] std::optional<std::uint64_t> whole_number(std::string_view text);
/// For CLI::Option::check: what is wrong with the text, or nothing. CLI11 itself takes -1 for the largest number.
[[nodiscard]] std::string check_whole_number(const std::string& text);

/// Says that a word is none of those that an option takes, and which one may have been meant.
[[nodiscard]] std::string unknown_word(const std::string& word, std::span<const std::string_view> known);

/// `count` finite numbers, separated by commas or blanks (any number of them, at least one, for count 0).
[[nodiscard]] std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count);
/// "x,y,z", metres.
[[nodiscard]] Eigen::Vector3d parse_point(const std::string& option, const std::string& text);
/// "x0,y0,z0,x1,y1,z1", metres.
[[nodiscard]] Box parse_box(const std::string& option, const std::string& text);
/// "u,v;u,v;u,v…", pixels; nullopt for what does not look like one (a file name).
[[nodiscard]] std::optional<PixelPolygon> parse_polygon(const std::string& option, const std::string& text);

/// Fails early where a file cannot be written, or where it is one that is read or written besides. Nothing for no file.
[[nodiscard]] Status check_output(const std::filesystem::path& file, const char* option,
                                  const std::vector<std::filesystem::path>& others);

/// Adds an option for one of a few words, which help and error list. `preset` is shown as the default, unless empty.
CLI::Option* add_words(CLI::App& command, const std::string& option, std::span<const std::string_view> words,
                       std::function<void(const std::string&)> take, const std::string& description,
                       std::string_view preset = {});
/// Adds an option for one of the values of a table, which outlives the parsing. The default is that of `target`; an
/// optional one shows none.
template <class T, std::size_t N, class Target>
CLI::Option* add_choice(CLI::App& command, const std::string& option, Target& target, const Names<T, N>& names,
                        const std::string& description) {
  std::string_view preset;
  if constexpr (std::is_same_v<Target, T>) preset = names.of(target);
  const auto take = [&target, &names](const std::string& word) { target = *names.find(word); };
  return add_words(command, option, names.words, take, description, preset);
}
/// Words for switches that are no flags, since what they switch is on by default, or as something else says.
inline constexpr auto kOnOff = make_names<bool>({{true, "on"}, {false, "off"}});

/// Adds an option for a point: X,Y,Z.
void add_point(CLI::App& command, const std::string& option, std::optional<Eigen::Vector3d>& point,
               const std::string& description);
/// Adds an option for lengths above 0, one at least, separated by commas.
void add_lengths(CLI::App& command, const std::string& option, std::vector<double>& lengths_m,
                 const std::string& description);
/// Adds an option for a box: X0,Y0,Z0,X1,Y1,Z1.
void add_box(CLI::App& command, const std::string& option, std::optional<Box>& box, const std::string& description);

/// Camera as the options describe it; the caller chooses what they leave open.
struct CameraOptions {
  std::optional<PinholeCamera> preset;
  std::string preset_name{};
  std::optional<std::vector<double>> intrinsics;  ///< fx, fy, cx, cy in pixels
  std::optional<std::pair<int, int>> image_size;
  std::optional<double> min_range_m;
  std::optional<double> max_range_m;

  /// The camera, where everything not given is taken from `fallback`. Without --intrinsics, --image-size scales the
  /// focal lengths and the principal point along.
  [[nodiscard]] PinholeCamera camera(const PinholeCamera& fallback) const;
  /// For the reader of a folder: only what was given.
  [[nodiscard]] std::optional<Intrinsics> given_intrinsics() const;
};

/// Adds --camera, --intrinsics, --min-range and --max-range, and --image-size where the images do not say their size.
void add_camera_options(CLI::App& command, CameraOptions& options, bool with_image_size);
/// --clearing PERCENT: TsdfConfig::clearing_percent.
void add_clearing_option(CLI::App& command, std::uint8_t& percent);

}  // namespace saccade::cli

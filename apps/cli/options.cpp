// SPDX-License-Identifier: Apache-2.0
#include "options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "add_value.hpp"
#include "length_options.hpp"
#include "saccade/core/nearest_word.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade::cli {
namespace {

/// The whole of `word` as a finite number.
std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value{0.0};
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (code != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The non-empty parts between separators.
std::vector<std::string> split(const std::string& text, const char* separators) {
  std::vector<std::string> parts;
  std::size_t begin = text.find_first_not_of(separators);
  while (begin != std::string::npos) {
    const std::size_t end = text.find_first_of(separators, begin);
    parts.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(separators, end);
  }
  return parts;
}

}  // namespace

void usage_error(const std::string& option, const std::string& message) { throw CLI::ValidationError(option, message); }

void require_ok(const Status& status, const std::string& option) {
  if (!status) usage_error(option, status.error().message);
}

void require_positive(double value, const std::string& option) {
  if (!(value > 0.0) || !std::isfinite(value)) usage_error(option, "must be a positive number");
}

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value{0};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc{} && end == text.data() + text.size() ? std::optional{value} : std::nullopt;
}

std::string check_whole_number(const std::string& text) {
  return whole_number(text) ? "" : "needs a whole number from 0 to 2^64 - 1, not '" + text + "'";
}

std::string unknown_word(const std::string& word, std::span<const std::string_view> known) {
  return "must be " + listed(known) + ", not '" + word + "'" + did_you_mean(word, known);
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count) {
  std::vector<double> numbers;
  for (const std::string& word : split(text, ", ")) {
    const auto value = number_of(word);
    if (!value) usage_error(option, "'" + word + "' in '" + text + "' is not a number");
    numbers.push_back(*value);
  }
  if (numbers.empty() || (count != 0 && numbers.size() != count)) {
    usage_error(option, "needs " + (count == 0 ? "at least one number" : std::to_string(count) + " numbers") +
                            " separated by commas, not '" + text + "'");
  }
  return numbers;
}

Eigen::Vector3d parse_point(const std::string& option, const std::string& text) {
  const std::vector<double> n = parse_numbers(option, text, 3);
  return {n[0], n[1], n[2]};
}

Box parse_box(const std::string& option, const std::string& text) {
  const std::vector<double> n = parse_numbers(option, text, 6);
  const Box box{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
  if (!validate(Region{box})) {
    usage_error(option, "needs x0,y0,z0,x1,y1,z1 with each first coordinate below its second, not '" + text + "'");
  }
  return box;
}

std::optional<PixelPolygon> parse_polygon(const std::string& option, const std::string& text) {
  if (text.find(';') == std::string::npos || text.find_first_not_of("0123456789+-.,; ") != std::string::npos) {
    return std::nullopt;
  }
  PixelPolygon polygon;
  for (const std::string& vertex : split(text, ";")) {
    const std::vector<double> n = parse_numbers(option, vertex, 2);
    polygon.emplace_back(n[0], n[1]);
  }
  if (polygon.size() < 3) usage_error(option, "a polygon needs at least 3 vertices, as in '0,0;100,0;100,50'");
  return polygon;
}

CLI::Option* add_words(CLI::App& command, const std::string& option, std::span<const std::string_view> words,
                       std::function<void(const std::string&)> take, const std::string& description,
                       std::string_view preset) {
  const std::vector<std::string_view> known{words.begin(), words.end()};
  const auto checked = [option, known, take = std::move(take)](const std::string& word) {
    if (std::find(known.begin(), known.end(), word) == known.end()) {
      usage_error(option, unknown_word(word, known));
    }
    take(word);
  };
  CLI::Option* added = command.add_option_function<std::string>(option, checked, description);
  return added->type_name(joined(known, "|"))->default_str(std::string{preset});
}

void add_point(CLI::App& command, const std::string& option, std::optional<Eigen::Vector3d>& point,
               const std::string& description) {
  const auto take = [option, &point](const std::string& text) { point = parse_point(option, text); };
  command.add_option_function<std::string>(option, take, description)->type_name("X,Y,Z");
}

void add_lengths(CLI::App& command, const std::string& option, std::vector<double>& lengths_m,
                 const std::string& description) {
  const auto take = [name = option.substr(0, option.find(',')), &lengths_m](const std::string& text) {
    lengths_m = parse_numbers(name, text, 0);
    for (const double length_m : lengths_m) require_length(length_m, name);
  };
  command.add_option_function<std::string>(option, take, description)->type_name("METRES");
}

void add_box(CLI::App& command, const std::string& option, std::optional<Box>& box, const std::string& description) {
  const auto take = [option, &box](const std::string& text) { box = parse_box(option, text); };
  command.add_option_function<std::string>(option, take, description)->type_name("X0,Y0,Z0,X1,Y1,Z1");
}

PinholeCamera CameraOptions::camera(const PinholeCamera& fallback) const {
  PinholeCamera camera = preset.value_or(fallback);
  if (image_size) camera = camera.scaled_to(image_size->first, image_size->second);
  if (intrinsics) {
    camera.fx = (*intrinsics)[0];
    camera.fy = (*intrinsics)[1];
    camera.cx = (*intrinsics)[2];
    camera.cy = (*intrinsics)[3];
  }
  camera.min_range_m = min_range_m.value_or(camera.min_range_m);
  camera.max_range_m = max_range_m.value_or(camera.max_range_m);
  return camera;
}

std::optional<Intrinsics> CameraOptions::given_intrinsics() const {
  if (!preset && !intrinsics) return std::nullopt;
  const PinholeCamera camera = this->camera({});
  Intrinsics given{camera.fx, camera.fy, camera.cx, camera.cy, {}, {}, {}, {}, {}};
  if (preset) {
    given.min_range_m = camera.min_range_m;
    given.max_range_m = camera.max_range_m;
    if (!intrinsics) {
      given.width = camera.width;
      given.height = camera.height;
    }
  }
  return given;
}

void add_clearing_option(CLI::App& command, std::uint8_t& percent) {
  command
      .add_option_function<int>(
          "--clearing", [&percent](int given) { percent = static_cast<std::uint8_t>(given); },
          "weight of rays that pass through a surface, as evidence against it: 100 as much as any other measurement, "
          "less where poses are inexact (default: " +
              std::to_string(percent) + ")")
      ->check(CLI::Range(1, 100))
      ->type_name("PERCENT");
}

void add_camera_options(CLI::App& command, CameraOptions& options, bool with_image_size) {
  command
      .add_option_function<std::string>(
          "--camera",
          [&options](const std::string& name) {
            const auto preset = camera_preset(name);
            if (!preset) {
              std::vector<std::string_view> known;
              for (const CameraPreset& one : camera_presets()) known.push_back(one.name);
              usage_error("--camera", preset.error().message + did_you_mean(name, known));
            }
            options.preset = *preset;
            options.preset_name = name;
          },
          "camera preset: " + joined(camera_presets(), ", ", &CameraPreset::name))
      ->type_name("NAME");
  command
      .add_option_function<std::string>(
          "--intrinsics",
          [&options, with_image_size](const std::string& text) {
            options.intrinsics = parse_numbers("--intrinsics", text, 4);
            const std::vector<double>& n = *options.intrinsics;
            const bool is_recorded = !with_image_size;  // a negative one mirrors an axis of recorded images
            require_positive(is_recorded ? std::abs(n[0]) : n[0], "--intrinsics: fx");
            require_positive(is_recorded ? std::abs(n[1]) : n[1], "--intrinsics: fy");
          },
          "focal lengths and principal point, pixels")
      ->type_name("FX,FY,CX,CY");
  if (with_image_size) {
    command
        .add_option_function<std::string>(
            "--image-size",
            [&options](const std::string& text) {
              const std::vector<double> n = parse_numbers("--image-size", text, 2);
              for (const double edge : n) {
                if (edge < 1.0 || edge > 16384.0 || edge != std::floor(edge)) {
                  usage_error("--image-size", "needs two whole numbers from 1 to 16384, not '" + text + "'");
                }
              }
              options.image_size = {static_cast<int>(n[0]), static_cast<int>(n[1])};
            },
            "image size, pixels; scales the preset's intrinsics along")
        ->type_name("WIDTH,HEIGHT");
  }
  add_value(command, "--min-range", options.min_range_m, "METRES",
            "nearest depth that is used, metres along the optical axis");
  add_value(command, "--max-range", options.max_range_m, "METRES",
            "farthest depth that is used, metres along the optical axis");
}

Status check_output(const std::filesystem::path& file, const char* option,
                    const std::vector<std::filesystem::path>& others) {
  if (file.empty()) return {};
  std::error_code ignored;
  for (const std::filesystem::path& other : others) {
    if (other.empty() ||
        std::filesystem::weakly_canonical(file, ignored) != std::filesystem::weakly_canonical(other, ignored))
      continue;
    return Error{Errc::invalid_argument, std::string{"would be replaced by "} + option + "; name another file there",
                 file.string()};
  }
  SACCADE_TRY(const AtomicFile probe, AtomicFile::create(file));
  return {};
}

}  // namespace saccade::cli

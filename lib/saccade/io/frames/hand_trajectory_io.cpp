// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/trajectory_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <system_error>

#include "saccade/core/pose.hpp"
#include "saccade/io/files/csv.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Columns of a table of samples, and their positions in a line.
constexpr std::array<std::string_view, 8> kColumns{"time", "x", "y", "z", "qx", "qy", "qz", "qw"};
using ColumnOrder = std::array<std::optional<std::size_t>, kColumns.size()>;

std::optional<Eigen::Quaterniond> unit_quaternion(double x, double y, double z, double w) {
  constexpr double kNormTolerance{1e-3};
  const Eigen::Quaterniond q{w, x, y, z};
  if (!(std::abs(q.norm() - 1.0) <= kNormTolerance)) return std::nullopt;
  return q.normalized();
}

HandSample sample_of(const std::vector<double>& values, const ColumnOrder& order) {
  const auto at = [&](std::size_t column) { return values[*order[column]]; };
  HandSample sample{at(0), {at(1), at(2), at(3)}, std::nullopt};
  if (order[4]) sample.R_world_hand = unit_quaternion(at(4), at(5), at(6), at(7));
  return sample;
}

ColumnOrder usual_order(std::size_t columns) {
  ColumnOrder order;
  for (std::size_t i = 0; i < columns; ++i) order[i] = i;
  return order;
}

/// Whether a number can be a time in seconds. What is not finite is counted elsewhere.
bool is_time(double time_s) {
  constexpr double kLatest_s{1e12};
  return !std::isfinite(time_s) || std::abs(time_s) <= kLatest_s;
}

Result<HandTrajectory> table_samples(const std::vector<NumberLine>& lines, const ColumnOrder& order,
                                     std::size_t columns) {
  HandTrajectory samples;
  samples.reserve(lines.size());
  for (const NumberLine& line : lines) {
    if (line.values.size() != columns) {
      return bad_line(line.line, std::to_string(columns) + " numbers expected as in the lines before, not " +
                                     std::to_string(line.values.size()));
    }
    samples.push_back(sample_of(line.values, order));
    if (!is_time(samples.back().time_s)) {
      return bad_line(line.line,
                      "this time would be thousands of years in seconds; divide times in nanoseconds by 1e9");
    }
  }
  return samples;
}

/// Returns the position of each column by its name in a header; ignores other columns.
Result<ColumnOrder> header_order(const std::vector<std::string_view>& names, std::size_t line) {
  ColumnOrder order;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string_view name = names[i];
    if (name == "t" || name == "timestamp" || name == "time_s") name = kColumns[0];
    const auto column = std::find(kColumns.begin(), kColumns.end(), name);
    if (column == kColumns.end()) continue;
    auto& place = order[static_cast<std::size_t>(column - kColumns.begin())];
    if (place) return bad_line(line, "column " + in_quotes(names[i]) + " comes twice");
    place = i;
  }
  const auto is_there = [](const auto& place) { return place.has_value(); };
  if (!std::all_of(order.begin(), order.begin() + 4, is_there)) {
    return bad_line(line, "columns time, x, y and z expected");
  }
  if (!std::all_of(order.begin() + 4, order.end(), is_there)) std::fill(order.begin() + 4, order.end(), std::nullopt);
  return order;
}

/// Tables of spreadsheets in countries with decimal commas have semicolons between their fields.
bool has_semicolons(std::string_view text) {
  LineScanner lines{text};
  while (const auto line = lines.next()) {
    if (!is_comment(*line)) return separator_of(*line) == ';';
  }
  return false;
}

/// Returns such a table with commas and decimal points, line by line.
std::string with_commas(std::string text) {
  std::replace(text.begin(), text.end(), ',', '.');
  std::replace(text.begin(), text.end(), ';', ',');
  return text;
}

Result<HandTrajectory> csv_samples(std::string_view text) {
  LineScanner lines{text};
  while (const auto line = lines.next()) {
    std::vector<std::string_view> words;
    TokenScanner tokens{*line};
    while (const auto token = tokens.next()) words.push_back(*token);
    if (words.empty() || words.front().front() == '#') continue;
    if (!parse_number(words.front())) {
      SACCADE_TRY(const ColumnOrder order, header_order(words, lines.line()));
      SACCADE_TRY(const auto numbers, number_lines(lines));
      return table_samples(numbers, order, words.size());
    }
    if (words.size() != 4 && words.size() != 8) {
      return bad_line(lines.line(), "4 or 8 numbers expected: time,x,y,z[,qx,qy,qz,qw]");
    }
    SACCADE_TRY(const auto numbers, number_lines(text));
    return table_samples(numbers, usual_order(words.size()), words.size());
  }
  return HandTrajectory{};
}

Result<HandTrajectory> matrix_samples(const std::vector<NumberLine>& lines) {
  HandTrajectory samples;
  for (std::size_t i = 0; i < lines.size(); i += 4) {
    Eigen::Matrix4d matrix;
    for (std::size_t row = 0; row < 4; ++row) {
      if (i + row >= lines.size()) return bad_line(lines[i].line, "this 4x4 matrix is cut");
      const NumberLine& line = lines[i + row];
      if (line.values.size() != 4) {
        return bad_line(line.line, "4 numbers of a matrix row expected, not " + std::to_string(line.values.size()));
      }
      matrix.row(static_cast<Eigen::Index>(row)) = Eigen::Map<const Eigen::RowVector4d>{line.values.data()};
    }
    if (matrix.row(3) != Eigen::RowVector4d{0.0, 0.0, 0.0, 1.0}) {
      return bad_line(lines[i + 3].line, "the last row of a matrix must be 0 0 0 1");
    }
    HandSample sample{static_cast<double>(samples.size()) * kHandMatrixInterval_s, matrix.topRightCorner<3, 1>(),
                      std::nullopt};
    if (const auto pose = pose_from_matrix(matrix)) sample.R_world_hand = Eigen::Quaterniond{pose->rotation()};
    samples.push_back(sample);
  }
  return samples;
}

Result<HandTrajectory> all_samples(std::string_view file, HandFormat format) {
  const std::string_view text = without_byte_order_mark(file);
  if (format == HandFormat::csv) {
    return has_semicolons(text) ? csv_samples(with_commas(std::string{text})) : csv_samples(text);
  }
  SACCADE_TRY(const auto lines, number_lines(text));
  if (format == HandFormat::matrices) return matrix_samples(lines);
  if (!lines.empty() && lines.front().values.size() != kColumns.size()) {
    return bad_line(lines.front().line, "8 numbers expected: time tx ty tz qx qy qz qw");
  }
  return table_samples(lines, usual_order(kColumns.size()), kColumns.size());
}

Result<HandFormat> format_of(const fs::path& path) {
  const fs::path extension = path.extension();
  if (extension == ".traj") return HandFormat::matrices;
  if (extension == ".csv") return HandFormat::csv;
  if (extension == ".tum" || extension == ".txt") return HandFormat::tum;
  return Error{Errc::invalid_argument,
               "no format of hand trajectories has this extension; .traj, .csv, .tum and .txt do", path.string()};
}

fs::path labels_path(fs::path trajectory) { return trajectory += ".res"; }

}  // namespace

Result<HandRecording> parse_hand_trajectory(std::string_view text, HandFormat format) {
  SACCADE_TRY(const HandTrajectory samples, all_samples(text, format));
  return HandRecording{usable_samples(samples), check_samples(samples)};
}

Result<HandRecording> read_hand_trajectory(const fs::path& path, std::optional<HandFormat> format) {
  if (!format) {
    SACCADE_TRY(format, format_of(path));
  }
  SACCADE_TRY(const std::string text, read_text_file(path));
  auto recording = parse_hand_trajectory(text, *format);
  if (!recording) return in_file(recording.error(), path);
  return recording;
}

Result<std::vector<Eigen::Vector3d>> parse_hand_labels(std::string_view text) {
  SACCADE_TRY(const auto lines, number_lines(text));
  std::vector<Eigen::Vector3d> labels_m;
  for (const NumberLine& line : lines) {
    if (line.values.size() != 3) return bad_line(line.line, "3 numbers of a label expected: x y z");
    labels_m.emplace_back(line.values[0], line.values[1], line.values[2]);
    if (!labels_m.back().allFinite()) return bad_line(line.line, "the label is not finite");
  }
  return labels_m;
}

Result<std::vector<Eigen::Vector3d>> read_hand_labels(const fs::path& trajectory) {
  const fs::path path = labels_path(trajectory);
  SACCADE_TRY(const std::string text, read_text_file(path));
  auto labels_m = parse_hand_labels(text);
  if (!labels_m) return in_file(labels_m.error(), path);
  return labels_m;
}

Result<LabelledTrajectory> read_labelled_trajectory(const fs::path& path, std::optional<HandFormat> format) {
  SACCADE_TRY(HandRecording recording, read_hand_trajectory(path, format));
  SACCADE_TRY(std::vector<Eigen::Vector3d> labels_m, read_hand_labels(path));
  return LabelledTrajectory{path.stem().string(), std::move(recording.trajectory), std::move(labels_m)};
}

Result<std::vector<fs::path>> find_hand_trajectories(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code failed;
  for (fs::recursive_directory_iterator at{folder, failed}, end; !failed && at != end; at.increment(failed)) {
    if (at->path().extension() == ".traj" && at->is_regular_file(failed)) paths.push_back(at->path());
  }
  if (failed) return Error{Errc::not_found, "cannot be read as a folder: " + failed.message(), folder.string()};
  if (paths.empty()) return Error{Errc::not_found, "holds no .traj file", folder.string()};
  std::sort(paths.begin(), paths.end());
  return paths;
}

Status write_hand_csv(const fs::path& path, const HandTrajectory& trajectory) {
  CsvTable table{{kColumns.begin(), kColumns.begin() + 4}};
  for (const HandSample& sample : trajectory) {
    table.add(sample.time_s);
    for (Eigen::Index axis = 0; axis < 3; ++axis) table.add(sample.position_m[axis]);
    table.end_row();
  }
  return table.write(path);
}

}  // namespace saccade

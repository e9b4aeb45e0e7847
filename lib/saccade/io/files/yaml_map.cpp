// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/yaml_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "saccade/core/length_limit.hpp"
#include "saccade/core/names.hpp"
#include "saccade/core/nearest_word.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade {
namespace {

std::string place_of(const YAML::Mark& mark) {
  if (mark.is_null()) return "";
  return "line " + std::to_string(mark.line + 1) + ", column " + std::to_string(mark.column + 1);
}

/// Reads the first bytes of a file; nothing of one that cannot be read.
std::string start_of(const std::filesystem::path& path) {
  constexpr std::size_t kBytes{512};
  std::string start(kBytes, ' ');
  std::ifstream file{path, std::ios::binary};
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return start;
}

/// Names the kind of a binary file by its first bytes or its extension.
std::string kind_of_binary(const std::filesystem::path& path, std::string_view content) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kStarts{{{"\x89PNG", "a picture (PNG)"},
                                                                                  {"\xff\xd8\xff", "a picture (JPEG)"},
                                                                                  {"ply", "a PLY mesh or cloud"},
                                                                                  {"glTF", "a mesh (GLB)"},
                                                                                  {"SQLite format 3", "a database"},
                                                                                  {"#ROSBAG", "a bag of ROS"}}};
  for (const auto& [start, kind] : kStarts) {
    if (content.starts_with(start)) return std::string{kind};
  }
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kEndings{{{".sacmap", "a saved map"},
                                                                                   {".stl", "a mesh (STL)"},
                                                                                   {".pcd", "a point cloud (PCD)"},
                                                                                   {".npy", "a NumPy array"},
                                                                                   {".sacann", "an annotation session"},
                                                                                   {".mcap", "a bag (MCAP)"}}};
  for (const auto& [ending, kind] : kEndings) {
    if (path.extension() == ending) return std::string{kind};
  }
  return "a binary file";
}

}  // namespace

Result<std::string> read_yaml_file(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMaxBytes{std::uintmax_t{16} << 20U};
  const std::string start = start_of(path);
  const bool binary =
      start.find('\0') != std::string::npos || start.starts_with("\x89PNG") || start.starts_with("ply\n");
  if (binary) {
    return Error{Errc::corrupt_data, "is " + kind_of_binary(path, start) + ", not a text in YAML", path.string()};
  }
  return read_text_file(path, kMaxBytes);
}

Error yaml_error(const YAML::Exception& exception) {
  return Error{Errc::corrupt_data, "not valid YAML: " + exception.msg, place_of(exception.mark)};
}

void yaml_problem(const YAML::Node& node, const std::string& what) {
  throw YamlProblem{Error{Errc::corrupt_data, what, place_of(node.Mark())}};
}

double yaml_number(const YAML::Node& node) {
  double value = 0.0;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
    yaml_problem(node, "expected a number");
  }
  return value;
}

std::string yaml_text(const YAML::Node& node) {
  if (!node.IsScalar()) yaml_problem(node, "expected a word");
  return node.Scalar();
}

std::vector<double> yaml_numbers(const YAML::Node& node, std::size_t count) {
  const std::string wanted = count == 0 ? "numbers" : std::to_string(count) + " numbers";
  if (!node.IsSequence() || (count != 0 && node.size() != count)) yaml_problem(node, "expected a list of " + wanted);
  std::vector<double> values;
  for (const YAML::Node& value : node) values.push_back(yaml_number(value));
  return values;
}

Eigen::Vector3d yaml_point(const YAML::Node& node) {
  const std::vector<double> values = yaml_numbers(node, 3);
  return {values[0], values[1], values[2]};
}

Eigen::Vector3d yaml_place(const YAML::Node& node, const std::string& what) {
  const Eigen::Vector3d place_m = yaml_point(node);
  const auto far = std::find_if(place_m.begin(), place_m.end(), [](double x) { return std::abs(x) > kMaxLength_m; });
  if (far == place_m.end()) return place_m;
  std::ostringstream text;
  text << what << " reaches to " << *far << " m; coordinates are within " << kMaxLength_m << " m of the origin";
  yaml_problem(node, text.str());
}

YamlMap::YamlMap(const YAML::Node& node, std::string what, std::vector<std::string_view> known)
    : node_{node}, what_{std::move(what)} {
  if (!node_.IsMap()) yaml_problem(node_, what_ + " is a list of \"key: value\"");
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!seen.insert(yaml_text(entry.first)).second)
      yaml_problem(entry.first, "the key " + entry.first.Scalar() + " is there twice");
  }
  if (known.empty()) return;
  std::sort(known.begin(), known.end());
  for (const auto& entry : node_) {
    if (!std::binary_search(known.begin(), known.end(), entry.first.Scalar())) refuse_key(entry.first, known);
  }
}

YAML::Node YamlMap::need(const std::string& key) {
  YAML::Node value = find(key);
  if (!value.IsDefined()) yaml_problem(node_, what_ + " needs the key " + key);
  return value;
}

YAML::Node YamlMap::find(const std::string& key) {
  asked_.insert(key);
  for (const auto& entry : node_) {
    if (entry.first.Scalar() == key) return entry.second;
  }
  return YAML::Node{YAML::NodeType::Undefined};
}

double YamlMap::number(const std::string& key, double fallback) {
  const YAML::Node value = find(key);
  return value.IsDefined() ? yaml_number(value) : fallback;
}

void YamlMap::finish() const {
  for (const auto& entry : node_) {
    if (asked_.contains(entry.first.Scalar())) continue;
    refuse_key(entry.first, {asked_.begin(), asked_.end()});
  }
}

void YamlMap::refuse_key(const YAML::Node& key, const std::vector<std::string_view>& known) const {
  yaml_problem(key, "unknown key " + key.Scalar() + " in " + what_ + "; known here: " + joined(known) +
                        did_you_mean(key.Scalar(), known));
}

}  // namespace saccade

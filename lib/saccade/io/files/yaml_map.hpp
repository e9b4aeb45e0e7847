// SPDX-License-Identifier: Apache-2.0
#pragma once
// YamlMap: one mapping of a YAML file, read key by key, with errors that name line and column.

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// Exception while a file is read, turned into an Error before it leaves the reader.
struct YamlProblem {
  Error error;
};

/// Returns yaml-cpp's error for invalid YAML, with its position. corrupt_data.
[[nodiscard]] Error yaml_error(const YAML::Exception& exception);

/// Reads a file that should hold YAML. io_failure; corrupt_data for a binary file, with what it is.
[[nodiscard]] Result<std::string> read_yaml_file(const std::filesystem::path& path);

/// Throws a YamlProblem at the node.
[[noreturn]] void yaml_problem(const YAML::Node& node, const std::string& what);

// Convert a value to a number, text, or list of numbers (any count for 0); throw a YamlProblem.
[[nodiscard]] double yaml_number(const YAML::Node& node);
[[nodiscard]] std::string yaml_text(const YAML::Node& node);
[[nodiscard]] std::vector<double> yaml_numbers(const YAML::Node& node, std::size_t count);
[[nodiscard]] Eigen::Vector3d yaml_point(const YAML::Node& node);
/// Converts a value to coordinates or lengths of `what`, metres, each within kMaxLength_m of 0.
[[nodiscard]] Eigen::Vector3d yaml_place(const YAML::Node& node, const std::string& what);

/// Mapping. Every function throws a YamlProblem.
class YamlMap {
 public:
  /// @param what   names the mapping in messages ("an object")
  /// @param known  all keys that it may have, so that an unknown one is refused before a missing one; empty: unknown
  ///               keys are refused by finish()
  YamlMap(const YAML::Node& node, std::string what, std::vector<std::string_view> known = {});

  /// Returns the value of a required key.
  [[nodiscard]] YAML::Node need(const std::string& key);
  /// Returns the value of a key, or an undefined node.
  [[nodiscard]] YAML::Node find(const std::string& key);
  [[nodiscard]] double number(const std::string& key, double fallback);
  [[nodiscard]] const YAML::Node& node() const { return node_; }
  /// Rejects keys that were not read.
  void finish() const;

 private:
  YAML::Node node_;
  std::string what_;
  [[noreturn]] void refuse_key(const YAML::Node& key, const std::vector<std::string_view>& known) const;

  std::set<std::string> asked_;
};

}  // namespace saccade

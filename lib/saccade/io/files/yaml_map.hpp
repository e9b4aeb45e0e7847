// SPDX-License-Identifier: Apache-2.0
#pragma once
// YamlMap: one mapping of a YAML file, read key by key; what is wrong is told with line and column.

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <set>
#include <string>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// Thrown while a file is read, and turned into an Error at its entrance.
struct YamlProblem {
  Error error;
};

/// What yaml-cpp says of text that is no YAML, and where. corrupt_data.
[[nodiscard]] Error yaml_error(const YAML::Exception& exception);

/// Throws a YamlProblem at the node.
[[noreturn]] void yaml_problem(const YAML::Node& node, const std::string& what);

// A value as a number, text, or list of numbers (any count for 0); throws a YamlProblem.
[[nodiscard]] double yaml_number(const YAML::Node& node);
[[nodiscard]] std::string yaml_text(const YAML::Node& node);
[[nodiscard]] std::vector<double> yaml_numbers(const YAML::Node& node, std::size_t count);
[[nodiscard]] Eigen::Vector3d yaml_point(const YAML::Node& node);

/// Every function throws a YamlProblem.
class YamlMap {
 public:
  /// `what` names the mapping in messages ("an object").
  YamlMap(const YAML::Node& node, std::string what);

  /// The value of a key that must be there.
  [[nodiscard]] YAML::Node need(const std::string& key);
  /// The value of a key, or an undefined node.
  [[nodiscard]] YAML::Node find(const std::string& key);
  [[nodiscard]] double number(const std::string& key, double fallback);
  [[nodiscard]] const YAML::Node& node() const { return node_; }
  /// Refuses keys that nobody asked for.
  void finish() const;

 private:
  YAML::Node node_;
  std::string what_;
  std::set<std::string> asked_;
};

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/yaml_map.hpp"

#include <cmath>

namespace saccade {
namespace {

std::string place_of(const YAML::Mark& mark) {
  if (mark.is_null()) return "";
  return "line " + std::to_string(mark.line + 1) + ", column " + std::to_string(mark.column + 1);
}

}  // namespace

Error yaml_error(const YAML::Exception& exception) {
  return Error{Errc::corrupt_data, "no YAML: " + exception.msg, place_of(exception.mark)};
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

YamlMap::YamlMap(const YAML::Node& node, std::string what) : node_{node}, what_{std::move(what)} {
  if (!node_.IsMap()) yaml_problem(node_, what_ + " is a list of \"key: value\"");
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!seen.insert(yaml_text(entry.first)).second)
      yaml_problem(entry.first, "the key " + entry.first.Scalar() + " is there twice");
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
    yaml_problem(entry.first,
                 "unknown key " + entry.first.Scalar() + " in " + what_ + "; known here: " + joined(asked_));
  }
}

}  // namespace saccade

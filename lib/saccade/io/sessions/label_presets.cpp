// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/sessions/label_presets.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/yaml_map.hpp"

namespace saccade {
namespace {

using Color = std::array<std::uint8_t, 3>;

std::uint32_t whole_number(const YAML::Node& node, double least, double most) {
  const double value = yaml_number(node);
  if (value != std::floor(value) || value < least || value > most) {
    yaml_problem(node, "expected a whole number within " + std::to_string(static_cast<std::int64_t>(least)) + " and " +
                           std::to_string(static_cast<std::int64_t>(most)));
  }
  return static_cast<std::uint32_t>(value);
}

Color color_from_digits(const YAML::Node& node) {
  const std::string text = yaml_text(node);
  Color color{};
  bool good = text.size() == 7 && text[0] == '#';
  for (std::size_t i = 0; i < 3 && good; ++i) {
    const char* digits = text.data() + 1 + 2 * i;
    good = std::from_chars(digits, digits + 2, color[i], 16).ptr == digits + 2;
  }
  if (!good) yaml_problem(node, "a colour is \"#rrggbb\" in quotes, or [red, green, blue]");
  return color;
}

Color color_from(const YAML::Node& node) {
  if (!node.IsSequence()) return color_from_digits(node);
  if (node.size() != 3) yaml_problem(node, "a colour is [red, green, blue]");
  Color color{};
  for (std::size_t i = 0; i < 3; ++i) color[i] = static_cast<std::uint8_t>(whole_number(node[i], 0, 255));
  return color;
}

NumberedLabel label_from(const YAML::Node& node, std::optional<DistinctColors>& generated) {
  YamlMap map{node, "a label", {"number", "name", "class", "instance", "color", "points"}};
  NumberedLabel label;
  label.number = whole_number(map.need("number"), 1, kMaxLabel);
  const auto text = [&](const char* key) {
    const YAML::Node value = map.find(key);
    return value.IsDefined() ? yaml_text(value) : std::string{};
  };
  label.info.name = text("name");
  label.info.class_name = text("class");
  if (const YAML::Node value = map.find("instance"); value.IsDefined()) {
    label.info.instance = whole_number(value, 0, 4294967295.0);
  }
  if (const YAML::Node color = map.find("color"); color.IsDefined()) {
    label.info.color = color_from(color);
  } else {
    if (!generated) generated.emplace();
    label.info.color = (*generated)(label.number);
  }
  static_cast<void>(map.find("points"));  // written by write_label_names_json
  map.finish();
  if (const Status valid = label.info.validate(); !valid) yaml_problem(node, valid.error().message);
  return label;
}

std::vector<NumberedLabel> labels_from(const YAML::Node& document) {
  YamlMap map{document, "a file of labels", {"labels", "schema"}};
  const YAML::Node list = map.need("labels");
  static_cast<void>(map.find("schema"));
  map.finish();
  if (!list.IsSequence() || list.size() == 0) yaml_problem(list, "labels is a list of at least one label");
  std::optional<DistinctColors> generated;  // made when a label needs it
  std::vector<NumberedLabel> labels;
  std::set<std::uint32_t> numbers;
  for (const YAML::Node& node : list) {
    labels.push_back(label_from(node, generated));
    if (!numbers.insert(labels.back().number).second) {
      yaml_problem(node, "label " + std::to_string(labels.back().number) + " is there twice");
    }
  }
  return labels;
}

}  // namespace

Result<std::vector<NumberedLabel>> parse_label_presets(std::string_view text) {
  try {
    return labels_from(YAML::Load(std::string{text}));
  } catch (const YamlProblem& problem) {
    return problem.error;
  } catch (const YAML::Exception& exception) {
    return yaml_error(exception);
  }
}

Result<std::vector<NumberedLabel>> read_label_presets(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMaxBytes{std::uintmax_t{16} << 20U};
  SACCADE_TRY(const std::string text, read_text_file(path, kMaxBytes));
  auto labels = parse_label_presets(text);
  if (!labels) return in_file(labels.error(), path);
  return labels;
}

}  // namespace saccade

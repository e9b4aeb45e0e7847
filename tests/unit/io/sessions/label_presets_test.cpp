// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/sessions/label_presets.hpp"

#include <gtest/gtest.h>

#include "saccade/io/clouds/label_io.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

std::string error_of_presets(const std::string& text) {
  const auto labels = parse_label_presets(text);
  if (labels) return "";
  EXPECT_EQ(labels.error().code, Errc::corrupt_data);
  return labels.error().to_string();
}

TEST(LabelPresets, YamlAndJsonAreRead) {
  const std::vector<NumberedLabel> expected{{3, {"White box", {255, 0, 16}, "box", 2}},
                                            {1, {"", DistinctColors{}(1), "", 0}},
                                            {kMaxLabel, {"Schl\xC3\xBCssel", {1, 2, 3}, "", 0}}};
  const auto yaml = parse_label_presets(
      "labels:\n"
      "  - {number: 3, name: White box, class: box, instance: 2, color: \"#fF0010\"}\n"
      "  - number: 1\n"
      "  - {number: 4294967294, name: Schl\xC3\xBCssel, color: [1, 2, 3]}\n");
  ASSERT_TRUE(yaml) << yaml.error().to_string();
  EXPECT_EQ(*yaml, expected);
  const auto json = parse_label_presets(
      R"({"labels": [{"number": 3, "name": "White box", "class": "box", "instance": 2, "color": "#ff0010"},)"
      R"({"number": 1}, {"number": 4294967294, "name": "Schlüssel", "color": [1, 2, 3]}]})");
  ASSERT_TRUE(json) << json.error().to_string();
  EXPECT_EQ(*json, expected);
}

TEST(LabelPresets, LabelsOfAnotherCloudAreRead) {
  const test::TempFolder folder;
  const std::vector<NamedLabel> names{{3, "White box", "box", 2, {255, 0, 16}, 4711}, {9, "", "", 0, {1, 2, 3}, 0}};
  ASSERT_TRUE(write_label_names_json(folder / "labels.json", names));
  const auto presets = read_label_presets(folder / "labels.json");
  ASSERT_TRUE(presets) << presets.error().to_string();
  EXPECT_EQ(*presets,
            (std::vector<NumberedLabel>{{3, {"White box", {255, 0, 16}, "box", 2}}, {9, {"", {1, 2, 3}, "", 0}}}));
}

TEST(LabelPresets, MistakesAreToldWithTheirPlace) {
  EXPECT_NE(error_of_presets("labels: [{name: cup}]").find("line 1, column 10: a label needs the key number"),
            std::string::npos);
  EXPECT_NE(error_of_presets("labels: [{number: 1, colour: red}]").find("unknown key colour"), std::string::npos);
  EXPECT_NE(error_of_presets("labels: [{number: 1}, {number: 1}]").find("label 1 is there twice"), std::string::npos);
  for (const char* number : {"0", "-1", "1.5", "4294967295", "cup", "[1]"}) {
    EXPECT_NE(error_of_presets(std::string{"labels: [{number: "} + number + "}]").find("expected a"), std::string::npos)
        << number;
  }
  for (const char* color : {"red", "\"#12345\"", "\"#12345g\"", "\"#+12345\"", "[1, 2]", "[1, 2, 256]", "{r: 1}"}) {
    EXPECT_NE(error_of_presets(std::string{"labels: [{number: 1, color: "} + color + "}]"), "") << color;
  }
  EXPECT_NE(error_of_presets("labels: [{number: 1, instance: -3}]").find("within 0 and 4294967295"), std::string::npos);
  EXPECT_NE(error_of_presets("labels: [{number: 1, name: \"a\\nb\"}]").find("control character"), std::string::npos);
  EXPECT_NE(error_of_presets("labels: []").find("at least one"), std::string::npos);
  EXPECT_NE(error_of_presets("- 1"), "");
  EXPECT_NE(error_of_presets(""), "");
  EXPECT_NE(error_of_presets("labels: [").find("not valid YAML"), std::string::npos);
}

TEST(LabelPresets, FilesAreNamedInErrors) {
  const test::TempFolder folder;
  EXPECT_EQ(read_label_presets(folder / "none").error().code, Errc::not_found);
  const auto path = folder.write("a.yaml", "labels: 7");
  EXPECT_EQ(read_label_presets(path).error().context, path.string() + ", line 1, column 9");
  EXPECT_EQ(read_label_presets(folder.write("b.yaml", "labels: [{number: 2}]"))->size(), 1U);
}

}  // namespace
}  // namespace saccade

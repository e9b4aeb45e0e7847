// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotatedBoxes: a made-up cloud of a table with three boxes, and saccade annotate on it.

#include <sstream>

#include "cli/run_program.hpp"
#include "saccade/io/clouds/label_io.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade::test {

/// A frame of a camera that looks down on a table, 1 m away, with three boxes, each of one colour.
class AnnotatedBoxes : public ::testing::Test {
 protected:
  static constexpr int kLabels{4};
  static constexpr std::size_t kPoints{12'000};
  // Points in the middle of the table's edge and of the boxes.
  static constexpr int kOnTable{10 * 120 + 60};
  static constexpr int kOnBox2{50 * 120 + 60};
  static constexpr int kOnBox3{50 * 120 + 100};

  void SetUp() override { write_boxes("cloud", 30); }

  /// NAME.csv and its labels NAME.txt; the boxes reach from the row `first` to row 70.
  void write_boxes(const std::string& name, int first, const std::string& in = ".") const {
    fs::create_directories(folder_ / in);
    std::ofstream cloud{folder_ / in / (name + ".csv")};
    std::ofstream truth{folder_ / in / (name + ".txt")};
    cloud << "x,y,z,r,g,b\n";
    for (int row = 0; row < 100; ++row) {
      for (int column = 0; column < 120; ++column) {
        const int box = row >= first && row < 70 && column % 40 >= 10 && column % 40 < 30 ? 1 + column / 40 : 0;
        cloud << 0.005 * (column - 60) << ',' << 0.005 * (row - 50) << ',' << (box > 0 ? 0.95 : 1.0) << ','
              << (box == 0 ? 200 : 30) << ',' << 60 * box << ",90\n";
        truth << box + 1 << '\n';
      }
    }
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream{folder_ / name} << text;
    return path(name);
  }
  [[nodiscard]] std::string text(const std::string& name) const { return *read_text_file(folder_ / name); }
  /// saccade annotate with paths as long as the scene is wide.
  [[nodiscard]] Arguments annotate(const Arguments& more, const std::string& cloud = "cloud.csv") const {
    return Arguments{"--json", "-", "--quiet", "annotate", path(cloud), "--max-path", "10"} + more;
  }
  [[nodiscard]] Arguments simulate(const Arguments& more = {}) const {
    return annotate(Arguments{"--simulate", path("truth.txt")} + more);
  }
  /// A control point on the table and on every box.
  [[nodiscard]] std::string four_clicks() const {
    std::ostringstream script;
    script << "# table, boxes\n"
           << R"({"do": "set", "label": 1, "points": [)" << kOnTable << "]}\n"
           << R"({"do": "set", "label": 2, "at": [-0.2, 0, 0.95]})" << '\n'
           << R"({"do": "set", "label": 3, "points": [)" << kOnBox2 << "]}\n"
           << R"({"do": "set", "label": 4, "points": [)" << kOnBox3 << "]}\n";
    return script.str();
  }
  [[nodiscard]] std::vector<std::uint32_t> truth() const { return *read_labels(folder_ / "cloud.txt", kPoints); }

  TempFolder folder_;
};

}  // namespace saccade::test

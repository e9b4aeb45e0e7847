// SPDX-License-Identifier: Apache-2.0
#pragma once
// ReproducedTable: a table or figure of the thesis with our figures beside its own; print: as Markdown.

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "saccade/sensor/image.hpp"

namespace saccade::reproduce {

struct TablePlot {
  std::string file;
  std::string svg;
};

struct TablePicture {
  std::string file;
  ColorImage image;
};

struct ReproducedTable {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> notes;  ///< what was done here, and what differs from the thesis
  nlohmann::json figures;
  std::vector<TablePlot> plots{};  ///< figures of the thesis that go with it
  std::vector<TablePicture> pictures{};
  bool complete{true};  ///< false: interrupted; rows are missing, and a note says which
};

/// Prints the caption, the table with aligned columns, and the notes as a list, in Markdown.
void print(std::ostream& out, const ReproducedTable& table);

}  // namespace saccade::reproduce

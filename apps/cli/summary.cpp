// SPDX-License-Identifier: Apache-2.0
#include "summary.hpp"

#include <iomanip>
#include <sstream>

namespace saccade::cli {

void Summary::line(std::string_view name, std::string_view value) const {
  constexpr std::size_t kNameWidth{12};
  out_ << std::left << std::setw(static_cast<int>(kNameWidth)) << name << (name.size() < kNameWidth ? "" : "  ")
       << value << '\n';
}

std::string offset_text(const Eigen::Vector3d& offset_m) {
  return "(" + fixed(offset_m.x(), 0) + ", " + fixed(offset_m.y(), 0) + ", " + fixed(offset_m.z(), 0) +
         ") is subtracted from the coordinates, which are far from the origin; files keep theirs";
}

std::string fixed(double value, int decimals) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

std::string millimetres(double value_m) { return fixed(1000.0 * value_m, 2) + " mm"; }

std::string percent(double share) { return fixed(100.0 * share, 1) + " %"; }

std::string mebibytes(std::size_t bytes) { return fixed(static_cast<double>(bytes) / (1024.0 * 1024.0), 1) + " MiB"; }

}  // namespace saccade::cli

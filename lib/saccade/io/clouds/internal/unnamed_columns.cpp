// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/internal/unnamed_columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace saccade {

Triple meaning_of(std::size_t rows, const std::function<double(std::size_t, std::size_t)>& value) {
  constexpr double kMost{255.0};
  constexpr double kUnit{0.01};
  if (rows == 0) return Triple::none;
  bool bytes{true}, shares{true}, units{true};
  double most{0.0};
  for (std::size_t i = 0; i < rows && (bytes || shares || units); ++i) {
    double squares{0.0};
    for (std::size_t k = 0; k < 3; ++k) {
      const double v = value(i, k);
      bytes = bytes && v >= 0.0 && v <= kMost && v == std::floor(v);
      shares = shares && v >= 0.0 && v <= 1.0;
      squares += v * v;
      most = std::max(most, v);
    }
    units = units && (squares == 0.0 || std::abs(std::sqrt(squares) - 1.0) < kUnit || std::isnan(squares));
  }
  if (bytes && most > 1.0) return Triple::colors_255;
  if (units && !shares) return Triple::normals;
  if (shares) return Triple::colors_1;
  return Triple::none;
}

std::vector<std::string> unnamed_columns(std::size_t columns, Triple last_three) {
  std::vector<std::string> names{"x", "y", "z"};
  const bool known = (columns == 6 || columns == 7) && last_three != Triple::none;
  if (columns == 4 || (columns == 7 && known)) names.emplace_back("intensity");
  if (known) {
    const bool normals = last_three == Triple::normals;
    for (const char* name : {normals ? "nx" : "r", normals ? "ny" : "g", normals ? "nz" : "b"}) {
      names.emplace_back(name);
    }
  }
  while (names.size() < columns) names.push_back("value" + std::to_string(names.size()));
  return names;
}

void name_columns(ColumnTable& table) {
  SACCADE_EXPECTS(table.columns.size() >= 3);
  const std::size_t columns = table.columns.size();
  const std::size_t first = columns - 3;
  const auto value = [&](std::size_t row, std::size_t k) { return table.columns[first + k].value(row); };
  const Triple meaning = columns == 6 || columns == 7 ? meaning_of(table.rows, value) : Triple::none;
  const std::vector<std::string> names = unnamed_columns(columns, meaning);
  for (std::size_t k = 0; k < columns; ++k) table.columns[k].name = names[k];
  if (meaning != Triple::colors_255) return;
  for (std::size_t k = first; k < columns; ++k) {
    Column bytes{table.columns[k].name, ColumnType::u8, 1, std::vector<std::byte>(table.rows)};
    for (std::size_t i = 0; i < table.rows; ++i) {
      bytes.bytes[i] = static_cast<std::byte>(static_cast<std::uint8_t>(table.columns[k].value(i)));
    }
    table.columns[k] = std::move(bytes);
  }
}

}  // namespace saccade

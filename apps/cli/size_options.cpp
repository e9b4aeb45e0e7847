// SPDX-License-Identifier: Apache-2.0
#include "size_options.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>
#include <string_view>

#include "options.hpp"

namespace saccade::cli {
namespace {

struct Unit {
  std::string_view name;  ///< in lower case
  double bytes;
};
constexpr double kKibi{1024.0};
constexpr double kKilo{1000.0};
constexpr std::array<Unit, 9> kUnits{{{"b", 1.0},
                                      {"kib", kKibi},
                                      {"mib", kKibi* kKibi},
                                      {"gib", kKibi* kKibi* kKibi},
                                      {"tib", kKibi* kKibi* kKibi* kKibi},
                                      {"kb", kKilo},
                                      {"mb", kKilo* kKilo},
                                      {"gb", kKilo* kKilo* kKilo},
                                      {"tb", kKilo* kKilo* kKilo* kKilo}}};

}  // namespace

std::size_t parse_size(const std::string& option, const std::string& text) {
  std::istringstream input{text};
  input.imbue(std::locale::classic());
  double number{0.0};
  std::string unit;
  const bool has_number = static_cast<bool>(input >> number);
  input >> unit;
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto* known = std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& u) { return u.name == unit; });
  constexpr double kMost{1e18};
  std::string rest;
  const double bytes = known != kUnits.end() ? number * known->bytes : 0.0;
  if (!has_number || known == kUnits.end() || (input >> rest) || !(bytes >= 1.0 && bytes <= kMost)) {
    usage_error(option, "is a size of memory, such as 512MiB or 2GiB, not " + text);
  }
  return static_cast<std::size_t>(bytes);
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once
// Summary: aligned "name  value" lines for people; numbers with their units as text.

#include <Eigen/Core>
#include <cstddef>
#include <ostream>
#include <string>
#include <string_view>

namespace saccade::cli {

class Summary {
 public:
  explicit Summary(std::ostream& out) : out_{out} {}
  void line(std::string_view name, std::string_view value) const;

 private:
  std::ostream& out_;
};

/// Says that a cloud's coordinates are computed with relative to an offset (PointCloud::offset_m).
[[nodiscard]] std::string offset_text(const Eigen::Vector3d& offset_m);
[[nodiscard]] std::string fixed(double value, int decimals);
[[nodiscard]] std::string millimetres(double value_m);
[[nodiscard]] std::string percent(double share);
[[nodiscard]] std::string mebibytes(std::size_t bytes);

}  // namespace saccade::cli

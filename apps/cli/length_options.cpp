// SPDX-License-Identifier: Apache-2.0
#include "length_options.hpp"

#include <algorithm>
#include <sstream>

#include "options.hpp"
#include "saccade/core/length_limit.hpp"

namespace saccade::cli {
namespace {

constexpr double kMinLength_m{1e-6};

}  // namespace

void require_length(double value_m, const std::string& option) {
  require_positive(value_m, option);
  if (value_m >= kMinLength_m && value_m <= kMaxLength_m) return;
  std::ostringstream text;
  text << "must be from a micrometre to " << kMaxLength_m << " m, not " << value_m << " m";
  usage_error(option, text.str());
}

void require_near(const Box& box, const std::string& option) {
  const double farthest_m = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  if (farthest_m <= kMaxLength_m) return;
  std::ostringstream text;
  text << "reaches to " << farthest_m << " m; coordinates are within " << kMaxLength_m << " m of the origin";
  usage_error(option, text.str());
}

}  // namespace saccade::cli

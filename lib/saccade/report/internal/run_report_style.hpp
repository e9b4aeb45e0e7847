// SPDX-License-Identifier: Apache-2.0
#pragma once
// run_report_style, run_report_script: the style sheet and the little script inside the run report.

#include <string_view>

namespace saccade {

/// Light and dark by prefers-color-scheme, one column on narrow screens, fit for print.
[[nodiscard]] std::string_view run_report_style();

/// Arrow keys step from view to view, a click shows a picture large. The page says everything without it.
[[nodiscard]] std::string_view run_report_script();

}  // namespace saccade

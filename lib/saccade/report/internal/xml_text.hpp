// SPDX-License-Identifier: Apache-2.0
#pragma once
// xml_escaped: any text as content of an SVG picture.

#include <string>
#include <string_view>

namespace saccade {

/// Returns text for element content and quoted attributes: & < > " ' become entities; bytes that are no UTF-8, and
/// control characters that XML does not allow, become U+FFFD.
[[nodiscard]] std::string xml_escaped(std::string_view text);

}  // namespace saccade

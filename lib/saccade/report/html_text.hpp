// SPDX-License-Identifier: Apache-2.0
#pragma once
// What HTML and SVG are written with: html_escaped, relative_href, base64, and numbers as text.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace saccade {

/// Text for element content and quoted attributes: & < > " ' become entities; bytes that are no UTF-8, and control
/// characters that XML does not allow, become U+FFFD.
[[nodiscard]] std::string html_escaped(std::string_view text);

/// A link to a file beside the page: everything but letters, digits and -._~/ is percent-encoded, so that no name is
/// taken for a scheme, a query or another host.
[[nodiscard]] std::string relative_href(std::string_view name);

/// RFC 4648, with padding, without line breaks.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

/// 1234567 as "1 234 567", with narrow no-break spaces.
[[nodiscard]] std::string grouped(std::uint64_t value);
/// Rounded to so many decimals; thousands as above; a minus sign (U+2212) before negative numbers. "–" for what is not
/// finite.
[[nodiscard]] std::string number_text(double value, int decimals);
/// A duration in the unit that suits it: "0.42 ms", "31 ms", "2.4 s", "3 min 12 s".
[[nodiscard]] std::string duration_text(double ms);

}  // namespace saccade

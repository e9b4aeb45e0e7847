// SPDX-License-Identifier: Apache-2.0
#include "server/access.hpp"

#include <algorithm>
#include <optional>

namespace saccade::server {
namespace {

constexpr std::size_t kShortestToken{16};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
bool is_word(char c) { return is_digit(c) || (lower(c) >= 'a' && lower(c) <= 'z') || c == '-' || c == '_'; }
bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

std::optional<unsigned> hex_digit(char c) {
  if (is_digit(c)) return static_cast<unsigned>(c - '0');
  const char small = lower(c);
  if (small >= 'a' && small <= 'f') return static_cast<unsigned>(small - 'a' + 10);
  return std::nullopt;
}

std::optional<std::string> decoded(std::string_view text, bool plus_is_blank) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '%') {
      const auto high = i + 1 < text.size() ? hex_digit(text[i + 1]) : std::nullopt;
      const auto low = i + 2 < text.size() ? hex_digit(text[i + 2]) : std::nullopt;
      if (!high || !low) return std::nullopt;
      c = static_cast<char>(*high * 16 + *low);
      i += 2;
    } else if (c == '+' && plus_is_blank) {
      c = ' ';
    }
    if (is_control(c)) return std::nullopt;
    out += c;
  }
  return out;
}

/// Removes the part before `separator` from the text, and returns it.
std::string_view take_until(std::string_view& text, char separator) {
  const std::string_view part = text.substr(0, text.find(separator));
  text.remove_prefix(std::min(part.size() + 1, text.size()));
  return part;
}

bool is_same_host(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

Result<Target> parse_target(std::string_view target) {
  const Error broken{Errc::invalid_argument, "this is not a path", ""};
  if (target.empty() || target.front() != '/') return broken;
  std::string_view query = target.substr(0, target.find('#'));
  auto path = decoded(take_until(query, '?'), false);
  if (!path) return broken;
  Target parsed{std::move(*path), {}};
  while (!query.empty()) {
    std::string_view value = take_until(query, '&');
    auto name = decoded(take_until(value, '='), true);
    auto text = decoded(value, true);
    if (!name || !text) return broken;
    parsed.query.emplace(std::move(*name), std::move(*text));
  }
  return parsed;
}

std::string host_name(std::string_view host) {
  std::string_view name;
  std::string_view port;
  if (!host.empty() && host.front() == '[') {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return {};
    name = host.substr(1, end - 1);
    port = host.substr(end + 1);
  } else {
    name = host.substr(0, host.find(':'));
    port = host.substr(name.size());
  }
  if (!port.empty() && (port.front() != ':' || port.size() > 6 || !std::all_of(port.begin() + 1, port.end(), is_digit)))
    return {};
  std::string small;
  for (const char c : name) {
    if (!is_word(c) && c != '.' && c != ':') return {};
    small += lower(c);
  }
  return small;
}

bool is_origin_of(std::string_view origin, std::string_view host) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme)) return is_same_host(origin.substr(scheme.size()), host);
  }
  return false;
}

bool is_foxglove_origin(std::string_view origin) {
  constexpr std::string_view kPlain{"http://"};
  if (origin == "https://app.foxglove.dev" || origin == "file://") return true;
  if (!origin.starts_with(kPlain)) return false;
  const std::string name = host_name(origin.substr(kPlain.size()));
  return name == "localhost" || name == "127.0.0.1" || name == "::1";
}

std::string_view offered_token(std::string_view subprotocols) {
  constexpr std::string_view kPrefix{"saccade.token."};
  while (!subprotocols.empty()) {
    std::string_view offered = take_until(subprotocols, ',');
    while (!offered.empty() && offered.front() == ' ') offered.remove_prefix(1);
    while (!offered.empty() && offered.back() == ' ') offered.remove_suffix(1);
    if (offered.starts_with(kPrefix)) return offered.substr(kPrefix.size());
  }
  return {};
}

bool is_same_token(std::string_view given, std::string_view token) {
  unsigned differences = given.size() == token.size() ? 0U : 1U;
  for (std::size_t i = 0; i < token.size(); ++i) {
    const char c = given.empty() ? '\0' : given[i % given.size()];
    differences |= static_cast<unsigned>(static_cast<unsigned char>(c) ^ static_cast<unsigned char>(token[i]));
  }
  return differences == 0;
}

Status check_token(std::string_view token) {
  if (token.size() >= kShortestToken && std::all_of(token.begin(), token.end(), is_word)) return {};
  return Error{Errc::invalid_argument, "a token is at least 16 letters, digits, - and _", ""};
}

std::string attachment(std::string_view file_name) {
  constexpr std::string_view kDigits{"0123456789ABCDEF"};
  std::string plain;
  std::string encoded;
  for (const char c : file_name) {
    const bool word = is_word(c) || c == '.';
    plain += word ? c : '_';
    if (word) {
      encoded += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      encoded += {'%', kDigits[byte / 16U], kDigits[byte % 16U]};
    }
  }
  return "attachment; filename=\"" + plain + "\"; filename*=UTF-8''" + encoded;
}

}  // namespace saccade::server

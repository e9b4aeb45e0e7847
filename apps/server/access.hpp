// SPDX-License-Identifier: Apache-2.0
#pragma once
// Access rules: targets, hosts, origins and tokens of HTTP requests, which may come from any client.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade::server {

/// Decoded target of a request line.
struct Target {
  std::string path;  ///< begins with /
  std::map<std::string, std::string> query;
};

/// Parses a target. Answers invalid_argument for anything but a path on this server: a whole URL, a broken % or a
/// control character.
[[nodiscard]] Result<Target> parse_target(std::string_view target);

/// Returns a Host header's name in lower case, without its port; empty for an invalid one. IPv6 addresses lose their
/// brackets.
[[nodiscard]] std::string host_name(std::string_view host);

/// Tells whether `origin` ("http://localhost:8080") is this `host` ("localhost:8080").
[[nodiscard]] bool is_origin_of(std::string_view origin, std::string_view host);

/// Tells whether `origin` may watch without a token: Foxglove's own page (https://app.foxglove.dev), a desktop program
/// (file://), or a page served by this machine (http://localhost:8080).
[[nodiscard]] bool is_foxglove_origin(std::string_view origin);

/// Header in which requests give the token. Browsers let no page of another origin send it.
inline constexpr std::string_view kTokenHeader{"Saccade-Token"};
/// Subprotocol of the page's WebSocket.
inline constexpr std::string_view kSubprotocol{"saccade.v1"};

/// Returns the token among the subprotocols that a WebSocket offers ("saccade.v1, saccade.token.TOKEN"), since browsers
/// give a WebSocket no other header; empty without one.
[[nodiscard]] std::string_view offered_token(std::string_view subprotocols);

/// Compares tokens in constant time.
[[nodiscard]] bool is_same_token(std::string_view given, std::string_view token);

/// Checks that a token has at least 16 letters, digits, - and _.
[[nodiscard]] Status check_token(std::string_view token);

/// Returns the value of Content-Disposition that makes a browser save an answer under this name.
[[nodiscard]] std::string attachment(std::string_view file_name);

}  // namespace saccade::server

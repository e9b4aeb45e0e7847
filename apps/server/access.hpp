// SPDX-License-Identifier: Apache-2.0
#pragma once
// Who may have what: targets, hosts, origins, cookies and tokens of HTTP requests, as they come from anybody.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade::server {

/// What a request line asks for, decoded.
struct Target {
  std::string path;  ///< begins with /
  std::map<std::string, std::string> query;
};

/// invalid_argument for what is no path of this server's: a whole URL, a broken % or a control character.
[[nodiscard]] Result<Target> parse_target(std::string_view target);

/// A Host header's name in small letters, without its port; empty for what is none. IPv6 addresses lose their brackets.
[[nodiscard]] std::string host_name(std::string_view host);

/// Whether `origin` ("http://localhost:8080") is this `host` ("localhost:8080").
[[nodiscard]] bool is_origin_of(std::string_view origin, std::string_view host);

/// Whether `origin` may look on without a token: Foxglove's own page (https://app.foxglove.dev), a program of the
/// desktop (file://), or a page that this machine serves (http://localhost:8080).
[[nodiscard]] bool is_foxglove_origin(std::string_view origin);

/// The value of a cookie in a Cookie header; empty without it.
[[nodiscard]] std::string_view cookie_value(std::string_view header, std::string_view name);

/// Takes as long for tokens that begin alike as for others.
[[nodiscard]] bool is_same_token(std::string_view given, std::string_view token);

/// At least 16 letters, digits, - and _.
[[nodiscard]] Status check_token(std::string_view token);

/// The value of Content-Disposition with which a browser keeps an answer under this name.
[[nodiscard]] std::string attachment(std::string_view file_name);

}  // namespace saccade::server

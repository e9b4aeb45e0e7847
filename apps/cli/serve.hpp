// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shared by `annotate` and `show`: the options of the page's address, the message that names it, and the wait for
// Ctrl-C.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "browser_page.hpp"
#include "command.hpp"
#include "server/http_server.hpp"

namespace saccade::cli {

struct ServeOptions {
  std::string address{"127.0.0.1"};
  std::uint16_t port{0};             ///< 0: any that is free
  std::filesystem::path token_file;  ///< empty: a new token
  std::vector<std::string> host_names;
  bool no_browser{false};
  std::string given;  ///< one of these options that was given, for those who do not serve; empty: none
};

/// --listen, --port, --token-file, --host and --no-browser.
void add_serve_options(CLI::App& command, ServeOptions& options);

/// Listens: from here on the page is there, and waits for its socket until HttpServer::serve. Reads the token file, or
/// makes it (mode 0600). Errors name the option's value.
/// @param foxglove  a run that Foxglove may look at; null: none.
[[nodiscard]] Result<std::unique_ptr<server::HttpServer>> listen(
    const ServeOptions& options, std::shared_ptr<server::FoxgloveHub> foxglove = nullptr);

/// Says the URL (on standard output; on standard error with --json -), how to reach it from elsewhere where there is no
/// display or it is that of SSH, and opens the browser elsewhere; or says why it could not.
[[nodiscard]] std::optional<BrowserPage> announce(const ServeOptions& options, const GlobalOptions& global,
                                                  const server::HttpServer& server);

/// Says on standard error where Foxglove connects, and who else could where that is not this machine alone.
void announce_foxglove(const server::HttpServer& server);

/// Runs work on the server's thread before there is a page, and waits for it. Ctrl-C ends the program at once, without
/// waiting for the work: it must keep nothing that is not whole at any time.
[[nodiscard]] Status run_before_page(const std::string& command, server::HttpServer& server,
                                     std::function<Status()> work);

/// HttpServer::serve, announce, then waits for Ctrl-C or SIGTERM, which interrupts no work. The caller ends the server
/// before the service.
void serve(const ServeOptions& options, const GlobalOptions& global, server::HttpServer& server,
           server::Service& service);

}  // namespace saccade::cli

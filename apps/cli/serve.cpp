// SPDX-License-Identifier: Apache-2.0
#include "serve.hpp"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <future>
#include <iostream>
#include <optional>
#include <string_view>
#include <thread>

#include "add_value.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"

namespace saccade::cli {
namespace {

constexpr std::chrono::milliseconds kLookEvery{50};
constexpr std::size_t kLongestToken{256};

bool is_set(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

/// Not that of an SSH connection: a browser over there is no use here.
bool has_display() { return (is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")) && !is_set("SSH_CONNECTION"); }

/// "user@machine"
std::string login() {
  std::array<char, 256> machine{};
  const bool has_name = ::gethostname(machine.data(), machine.size() - 1) == 0 && machine[0] != '\0';
  const passwd* const user = ::getpwuid(::getuid());
  return std::string{user != nullptr ? user->pw_name : "USER"} + "@" + (has_name ? machine.data() : "HOST");
}

Error token_file_error(const std::filesystem::path& file, int error) {
  return {error == ENOENT ? Errc::not_found : Errc::io_failure, std::strerror(error), file.string()};
}

/// Closes itself.
struct Descriptor {
  int number{-1};
  explicit Descriptor(int opened) : number{opened} {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

/// Nothing where the file is there already.
Result<std::optional<std::string>> made_token(const std::filesystem::path& file) {
  const Descriptor made{::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)};
  if (made.number < 0) {
    if (errno == EEXIST) return std::optional<std::string>{};
    return token_file_error(file, errno);
  }
  std::string token = server::make_token();
  const std::string line = token + "\n";
  const ssize_t written = ::write(made.number, line.data(), line.size());
  if (written != static_cast<ssize_t>(line.size())) {
    const int error = written < 0 ? errno : ENOSPC;
    ::unlink(file.c_str());
    return token_file_error(file, error);
  }
  return std::optional{std::move(token)};
}

Result<std::string> read_token(const std::filesystem::path& file) {
  const Descriptor opened{::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (opened.number < 0) return token_file_error(file, errno);
  struct stat about {};
  if (::fstat(opened.number, &about) != 0) return token_file_error(file, errno);
  if ((about.st_mode & S_IFMT) != S_IFREG) return Error{Errc::invalid_argument, "is not a regular file", file.string()};
  if ((about.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return Error{Errc::invalid_argument, "others may read this token: chmod 600, or name another file", file.string()};
  }
  std::array<char, kLongestToken + 1> bytes{};
  const ssize_t count = ::read(opened.number, bytes.data(), bytes.size());
  if (count < 0) return token_file_error(file, errno);
  std::string_view text{bytes.data(), static_cast<std::size_t>(count)};
  if (text.size() > kLongestToken) return Error{Errc::corrupt_data, "is too long for a token", file.string()};
  while (text.ends_with('\n') || text.ends_with('\r') || text.ends_with(' ')) text.remove_suffix(1);
  server::ServerConfig config;
  config.token = text;
  if (const Status valid = config.validate(); !valid) {
    return Error{Errc::corrupt_data, valid.error().message, file.string()};
  }
  return std::string{text};
}

Result<std::string> token_of(const std::filesystem::path& file) {
  if (file.empty()) return server::make_token();
  SACCADE_TRY(std::optional<std::string> made, made_token(file));
  if (made) return std::move(*made);
  return read_token(file);
}

}  // namespace

void add_serve_options(CLI::App& command, ServeOptions& options) {
  const auto given = [&options](const char* name) {
    return [&options, name](const std::string&) {
      if (options.given.empty()) options.given = name;
    };
  };
  add_value(command, "--listen", options.address, "ADDRESS",
            "address that the page is served on; 0.0.0.0: all of this machine's. The token is always needed, and "
            "travels unencrypted: beyond this machine, prefer ssh -L")
      ->each(given("--listen"));
  add_value(command, "--port", options.port, "N", "port of the page; 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->each(given("--port"));
  add_value(
      command, "--token-file", options.token_file, "FILE",
      "the page's token; made (for you alone to read) where it is not there. With --port, the page keeps its address")
      ->each(given("--token-file"));
  add_value(command, "--host", options.host_names, "NAME",
            "name by which browsers may reach the page, besides localhost and the address; may be given again")
      ->check([](const std::string& name) {
        server::ServerConfig config;
        config.token = "0123456789abcdef";
        config.host_names = {name};
        return std::string{config.validate() ? "" : "is no name of a machine"};
      })
      ->each(given("--host"))
      ->allow_extra_args(false);
  command.add_flag("--no-browser", options.no_browser, "only say where the page is")->each(given("--no-browser"));
}

Result<std::unique_ptr<server::HttpServer>> listen(const ServeOptions& options,
                                                   std::shared_ptr<server::FoxgloveHub> foxglove) {
  server::ServerConfig config;
  config.foxglove = std::move(foxglove);
  config.address = options.address;
  config.port = options.port;
  config.host_names = options.host_names;
  SACCADE_TRY(config.token, token_of(options.token_file));
  return server::HttpServer::listen(config);
}

std::optional<BrowserPage> announce(const ServeOptions& options, const GlobalOptions& global,
                                    const server::HttpServer& server) {
  std::ostream& out = global.json_to_stdout() ? std::cerr : std::cout;
  const std::string port = std::to_string(server.port());
  const std::string url = server.url();
  const bool is_local = url.starts_with("http://localhost:");
  out << "The page is at " << url << '\n';
  if (is_local && !has_display()) {
    out << "To open it on another machine, run there: ssh -N -L " << port << ":localhost:" << port << ' ' << login()
        << '\n';
  }
  if (!is_local) out << "Anyone who can reach this address and knows the token may use it; nothing is encrypted.\n";
  out << "Ctrl-C ends it." << std::endl;
  if (options.no_browser || !has_display()) return std::nullopt;
  auto page = BrowserPage::open(url);
  if (page) return std::move(*page);
  std::cerr << "the browser was not opened (" << page.error().to_string() << "); the address above leads there"
            << std::endl;
  return std::nullopt;
}

void announce_foxglove(const server::HttpServer& server) {
  const std::string url = server.foxglove_url();
  std::cerr << "Foxglove connects to " << url << '\n';
  if (!url.starts_with("ws://localhost:")) {
    std::cerr << "Anyone who reaches this address and knows the token may look on; nothing is encrypted.\n";
  }
  std::cerr << std::flush;
}

Status run_before_page(const std::string& command, server::HttpServer& server, std::function<Status()> work) {
  auto promised = std::make_shared<std::promise<Status>>();
  std::future<Status> done = promised->get_future();
  server.post([promised, work = std::move(work)] { promised->set_value(work()); });
  while (done.wait_for(kLookEvery) != std::future_status::ready) {
    if (!interrupted()) continue;
    print_error(command, "interrupted");
    std::_Exit(interrupt_status());
  }
  return done.get();
}

void serve(const ServeOptions& options, const GlobalOptions& global, server::HttpServer& server,
           server::Service& service) {
  server.serve(service);
  const auto page = announce(options, global, server);
  while (!interrupted()) std::this_thread::sleep_for(kLookEvery);
}

}  // namespace saccade::cli

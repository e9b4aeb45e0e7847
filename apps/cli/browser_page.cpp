// SPDX-License-Identifier: Apache-2.0
#include "browser_page.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <thread>
#include <vector>

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

/// Where browsers come as snaps, they read no hidden files, nor those of /run and /tmp, but what lies in the home
/// folder. Else the file is less in the way elsewhere.
std::vector<fs::path> redirect_places() {
  const auto from = [](const char* variable) {
    const char* const value = std::getenv(variable);
    return fs::path{value == nullptr ? "" : value};
  };
  std::error_code ignored;
  std::vector<fs::path> places{from("XDG_RUNTIME_DIR"), fs::temp_directory_path(ignored)};
  places.insert(fs::exists("/snap/bin", ignored) ? places.begin() : places.end(), from("HOME"));
  std::erase_if(places, [](const fs::path& place) { return !place.is_absolute(); });
  return places;
}

/// Host names and tokens have nothing in them that means something else here.
std::string redirect_text(const std::string& url) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>Saccade</title>\n"
         "<meta name=\"referrer\" content=\"no-referrer\">\n<meta http-equiv=\"refresh\" content=\"0; url=" +
         url + "\">\n<p><a href=\"" + url + "\">To the page</a></p>\n</html>\n";
}

bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// Its own words go nowhere. Ctrl-C is not for it, and the signals that the program ignores it does not.
/// @return as posix_spawnp.
int begin_xdg_open(std::string file) {
  posix_spawnattr_t attributes;
  if (const int error = ::posix_spawnattr_init(&attributes); error != 0) return error;
  sigset_t as_usual;
  sigemptyset(&as_usual);
  for (const int signal : {SIGPIPE, SIGXFSZ}) sigaddset(&as_usual, signal);
  ::posix_spawnattr_setsigdefault(&attributes, &as_usual);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGDEF);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    ::posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  }
  std::string program{"xdg-open"};
  const std::array<char*, 3> arguments{program.data(), file.data(), nullptr};
  pid_t child{0};
  const int error = ::posix_spawnp(&child, program.c_str(), &actions, &attributes, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  if (error == 0) std::thread{[child] { ::waitpid(child, nullptr, 0); }}.detach();
  return error;
}

}  // namespace

Result<BrowserPage> BrowserPage::write(const std::string& url) {
  Error why{Errc::io_failure, "there is no folder for the file that leads there", "XDG_RUNTIME_DIR"};
  for (const fs::path& place : redirect_places()) {
    constexpr std::string_view kSuffix{".html"};
    std::string name = (place / "saccade-XXXXXX").string().append(kSuffix);
    const int file = ::mkostemps(name.data(), kSuffix.size(), O_CLOEXEC);  // with mode 0600
    if (file >= 0) {
      BrowserPage page{name};
      const bool written = write_all(file, redirect_text(url));
      const int error = errno;
      ::close(file);
      if (written) return page;
      errno = error;
    }
    why = {Errc::io_failure, std::string{"the file that leads there cannot be written: "} + std::strerror(errno),
           place.string()};
  }
  return why;
}

Result<BrowserPage> BrowserPage::open(const std::string& url) {
  SACCADE_TRY(BrowserPage page, write(url));
  const int error = begin_xdg_open(page.file_.string());
  if (error != 0) return Error{Errc::io_failure, std::strerror(error), "xdg-open"};
  return page;
}

BrowserPage::~BrowserPage() {
  std::error_code ignored;
  if (!file_.empty()) fs::remove(file_, ignored);
}

}  // namespace saccade::cli

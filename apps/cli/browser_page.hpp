// SPDX-License-Identifier: Apache-2.0
#pragma once
// BrowserPage: an address that the browser was sent to.

#include <filesystem>
#include <string>
#include <utility>

#include "saccade/core/result.hpp"

namespace saccade::cli {

/// A file that sends the browser on, for its user alone to read: the address has the token in it, and everyone on the
/// machine sees the arguments of a program. It is there as long as this lives.
class BrowserPage {
 public:
  /// Writes it and begins xdg-open, which outlives the program. io_failure where the file cannot be written or there is
  /// no xdg-open; whether that finds a browser is the user's to see.
  [[nodiscard]] static Result<BrowserPage> open(const std::string& url);
  BrowserPage(BrowserPage&& other) noexcept : file_{std::exchange(other.file_, {})} {}
  BrowserPage& operator=(BrowserPage&& other) noexcept {
    file_.swap(other.file_);
    return *this;
  }
  ~BrowserPage();

 private:
  explicit BrowserPage(std::filesystem::path file) : file_{std::move(file)} {}
  [[nodiscard]] static Result<BrowserPage> write(const std::string& url);

  std::filesystem::path file_;
};

}  // namespace saccade::cli

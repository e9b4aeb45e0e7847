// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a device's program says and hears: LineInput, say; Options of its command line.

#include <poll.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

namespace saccade::devices {

/// Lines of the standard input as they come.
class LineInput {
 public:
  /// The next request, waited for no longer than given; nullopt: none has come.
  [[nodiscard]] std::optional<nlohmann::json> next(std::chrono::milliseconds longest) {
    for (;;) {
      const std::size_t end = received_.find('\n');
      if (end != std::string::npos) {
        const std::string line = received_.substr(0, end);
        received_.erase(0, end + 1);
        return nlohmann::json::parse(line);
      }
      pollfd input{STDIN_FILENO, POLLIN, 0};
      if (ended_ || ::poll(&input, 1, static_cast<int>(longest.count())) <= 0) return std::nullopt;
      std::array<char, 65536> chunk{};
      const ssize_t got = ::read(STDIN_FILENO, chunk.data(), chunk.size());
      if (got <= 0) ended_ = true;
      if (got > 0) received_.append(chunk.data(), static_cast<std::size_t>(got));
    }
  }
  /// Saccade is done, or gone.
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  std::string received_;
  bool ended_{false};
};

inline void say(const nlohmann::json& message, std::span<const char> bytes = {}) {
  std::cout << message.dump() << '\n';
  std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  std::cout.flush();
}

/// "--name value" pairs.
class Options {
 public:
  Options(int argc, char** argv) {
    for (int i = 1; i + 1 < argc; i += 2) values_[argv[i]] = argv[i + 1];
    if (argc % 2 == 0) values_["?"] = argv[argc - 1];
  }
  [[nodiscard]] std::string text(const std::string& name, const std::string& otherwise = "") const {
    const auto found = values_.find(name);
    return found == values_.end() ? otherwise : found->second;
  }
  [[nodiscard]] double number(const std::string& name, double otherwise) const {
    const std::string value = text(name);
    return value.empty() ? otherwise : std::stod(value);
  }
  /// Comma-separated.
  [[nodiscard]] std::vector<double> numbers(const std::string& name) const {
    std::vector<double> values;
    std::string rest = text(name);
    while (!rest.empty()) {
      std::size_t used = 0;
      values.push_back(std::stod(rest, &used));
      rest = used < rest.size() ? rest.substr(used + 1) : "";
    }
    return values;
  }

 private:
  std::map<std::string, std::string> values_;
};

/// Seconds on the clock that the devices of one machine share.
inline double now_s() {
  return std::chrono::duration<double>{std::chrono::steady_clock::now().time_since_epoch()}.count();
}

}  // namespace saccade::devices

// SPDX-License-Identifier: Apache-2.0
#pragma once
// Input and output of a device's program: LineInput, say, keep_output_for_answers; Options of its command line. C++17,
// which libraries of some devices need.

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

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

/// Where answers go.
inline int& answer_output() {
  static int descriptor{STDOUT_FILENO};
  return descriptor;
}

/// Sends what libraries print to standard output to standard error from now on; answers alone still go to the former.
inline void keep_output_for_answers() {
  answer_output() = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
}

inline void say(const nlohmann::json& message, std::string_view bytes = {}) {
  const std::string line = message.dump() + '\n';
  for (std::string_view rest : {std::string_view{line}, bytes}) {
    while (!rest.empty()) {
      const ssize_t written = ::write(answer_output(), rest.data(), rest.size());
      if (written < 0) throw std::runtime_error{"Saccade does not listen any more"};
      rest.remove_prefix(static_cast<std::size_t>(written));
    }
  }
}

/// "--name value" pairs, switches ("--name" alone) and at most one argument without a name.
class Options {
 public:
  Options(int argc, char** argv, const std::vector<std::string>& switches = {}) {
    for (int i = 1; i < argc; ++i) {
      const std::string name{argv[i]};
      if (name.substr(0, 2) != "--") {
        if (!values_.emplace("", name).second) throw std::runtime_error{"one argument too many: " + name};
      } else if (std::find(switches.begin(), switches.end(), name) != switches.end()) {
        values_.emplace(name, "yes");
      } else if (i + 1 < argc) {
        values_[name] = argv[++i];
      } else {
        throw std::runtime_error{name + " has no value"};
      }
    }
  }
  /// Throws for an option that is not among these. The argument without a name is called "".
  void only(const std::vector<std::string>& known) const {
    for (const auto& [name, value] : values_) {
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      throw std::runtime_error{name.empty() ? "one argument too many: " + value : "unknown option " + name};
    }
  }
  [[nodiscard]] bool has(const std::string& name) const { return values_.count(name) != 0; }
  [[nodiscard]] std::string text(const std::string& name, const std::string& otherwise = "") const {
    const auto found = values_.find(name);
    return found == values_.end() ? otherwise : found->second;
  }
  [[nodiscard]] double number(const std::string& name, double otherwise) const {
    const std::string value = text(name);
    if (value.empty()) return otherwise;
    std::size_t used = 0;
    try {
      const double number = std::stod(value, &used);
      if (used == value.size()) return number;
    } catch (const std::exception&) {
      used = 0;  // said below
    }
    throw std::runtime_error{name + " must be a number, not '" + value + "'"};
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

// SPDX-License-Identifier: Apache-2.0
#pragma once
// EnvironmentVariable: sets a variable of the environment for as long as it lives.

#include <cstdlib>
#include <optional>
#include <string>

namespace saccade::test {

class EnvironmentVariable {
 public:
  EnvironmentVariable(const char* name, const std::string& value) : name_{name} {
    const char* before = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): tests have one thread here
    if (before != nullptr) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;
  ~EnvironmentVariable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> before_{};
};

}  // namespace saccade::test

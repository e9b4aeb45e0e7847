// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/result.hpp"

namespace saccade {

std::string Error::to_string() const { return context.empty() ? message : context + ": " + message; }

void contract_violation(const char* condition, const char* file, int line) {
  throw ContractViolation{std::string{"contract violated: "} + condition + " (" + file + ":" + std::to_string(line) +
                          ")"};
}

}  // namespace saccade

// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/result.hpp"

namespace saccade {

std::string_view to_string(Errc code) {
  switch (code) {
    case Errc::invalid_argument: return "invalid argument";
    case Errc::not_found: return "not found";
    case Errc::io_failure: return "input/output failure";
    case Errc::corrupt_data: return "corrupt data";
    case Errc::unsupported: return "unsupported";
    case Errc::size_mismatch: return "size mismatch";
    case Errc::unavailable: return "unavailable";
    case Errc::cancelled: return "cancelled";
  }
  return "unknown error";
}

std::string Error::to_string() const { return context.empty() ? message : context + ": " + message; }

void contract_violation(const char* condition, const char* file, int line) {
  throw ContractViolation{std::string{"contract violated: "} + condition + " (" + file + ":" + std::to_string(line) +
                          ")"};
}

}  // namespace saccade

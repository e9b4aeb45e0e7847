// SPDX-License-Identifier: Apache-2.0
#pragma once
// Errors as values: Errc, Error, Result<T>, Status; SACCADE_TRY to pass an error on; contract checks.

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "saccade/core/names.hpp"

namespace saccade {

/// Kind of an error. The command line maps it to an exit status, the server to an HTTP status.
enum class Errc {
  invalid_argument,  ///< a value chosen by the caller is out of range or makes no sense
  not_found,         ///< a file or folder does not exist
  io_failure,        ///< reading or writing failed (permissions, full disk, broken pipe)
  corrupt_data,      ///< a file exists but its content is damaged or is not what it claims to be
  unsupported,       ///< well-formed, but of a variant that is not supported
  size_mismatch,     ///< two things that must agree in size do not
  unavailable,       ///< a back end or an optional part is missing from this build or machine
  cancelled,         ///< the caller asked to stop
};

inline constexpr auto kErrcNames = make_names<Errc>({{Errc::invalid_argument, "invalid argument"},
                                                     {Errc::not_found, "not found"},
                                                     {Errc::io_failure, "input/output failure"},
                                                     {Errc::corrupt_data, "corrupt data"},
                                                     {Errc::unsupported, "unsupported"},
                                                     {Errc::size_mismatch, "size mismatch"},
                                                     {Errc::unavailable, "unavailable"},
                                                     {Errc::cancelled, "cancelled"}});
[[nodiscard]] constexpr std::string_view to_string(Errc code) { return kErrcNames.of(code); }

/// An error: what is wrong, where, and what to do.
struct Error {
  Errc code{Errc::invalid_argument};
  std::string message;  ///< what is wrong and, where it helps, what to do
  std::string context;  ///< where: a file, a line, a frame, a byte offset; may be empty

  /// Returns "context: message", or the message alone where there is no context.
  [[nodiscard]] std::string to_string() const;
};

/// Thrown on a broken contract (a programmer's error), never for bad data.
class ContractViolation : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] void contract_violation(const char* condition, const char* file, int line);

/// Either a value or an Error.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_{std::in_place_index<0>, std::move(value)} {}      // NOLINT: implicit on purpose
  Result(Error error) : state_{std::in_place_index<1>, std::move(error)} {}  // NOLINT: implicit on purpose

  [[nodiscard]] bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  [[nodiscard]] T& value() & { return require(), *std::get_if<0>(&state_); }
  [[nodiscard]] const T& value() const& { return require(), *std::get_if<0>(&state_); }
  [[nodiscard]] T&& value() && { return require(), std::move(*std::get_if<0>(&state_)); }
  [[nodiscard]] T& operator*() & { return value(); }
  [[nodiscard]] const T& operator*() const& { return value(); }
  [[nodiscard]] T&& operator*() && { return std::move(*this).value(); }
  [[nodiscard]] T* operator->() { return &value(); }
  [[nodiscard]] const T* operator->() const { return &value(); }

  /// Requires !ok().
  [[nodiscard]] const Error& error() const {
    const Error* e = std::get_if<1>(&state_);
    if (e == nullptr) contract_violation("Result holds an error", __FILE__, __LINE__);
    return *e;
  }

 private:
  void require() const {
    if (!ok()) throw ContractViolation{"Result::value() on an error: " + error().to_string()};
  }
  std::variant<T, Error> state_;
};

/// Success without a value, or an Error.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(Error error) : error_{std::move(error)} {}  // NOLINT: implicit on purpose
  [[nodiscard]] bool ok() const { return !error_; }
  explicit operator bool() const { return ok(); }
  [[nodiscard]] const Error& error() const {
    if (!error_) contract_violation("Status holds an error", __FILE__, __LINE__);
    return *error_;
  }

 private:
  std::optional<Error> error_;
};

}  // namespace saccade

/// Checks a contract at API borders, also in Release. A violation is a programmer's error.
#define SACCADE_EXPECTS(condition) \
  ((condition) ? static_cast<void>(0) : ::saccade::contract_violation(#condition, __FILE__, __LINE__))

/// Passes an error of `expression` (a Result or Status) on to the caller.
#define SACCADE_CHECK(expression)                              \
  do {                                                         \
    if (auto saccade_status = (expression); !saccade_status) { \
      return saccade_status.error();                           \
    }                                                          \
  } while (false)

#define SACCADE_CONCAT_IMPL(a, b) a##b
#define SACCADE_CONCAT(a, b) SACCADE_CONCAT_IMPL(a, b)
/// `SACCADE_TRY(auto x, f());` binds the value, or passes the error on.
#define SACCADE_TRY(declaration, expression)                     \
  auto SACCADE_CONCAT(saccade_result_, __LINE__) = (expression); \
  if (!SACCADE_CONCAT(saccade_result_, __LINE__)) {              \
    return SACCADE_CONCAT(saccade_result_, __LINE__).error();    \
  }                                                              \
  declaration = std::move(SACCADE_CONCAT(saccade_result_, __LINE__)).value()

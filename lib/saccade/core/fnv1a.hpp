// SPDX-License-Identifier: Apache-2.0
#pragma once
// Fnv1a: a hash of numbers that is equal on every machine. It detects mistakes, not forgeries.

#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <string>

namespace saccade {

/// 64-bit FNV-1a hash over the bytes of the added values, lowest byte first.
class Fnv1a {
 public:
  void add(std::uint64_t value) {
    for (unsigned shift = 0; shift < 64; shift += 8) {
      state_ = (state_ ^ ((value >> shift) & 0xffU)) * 0x100000001b3ULL;
    }
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value)); }  // −0 is 0
  template <class Derived>
  void add_all(const Eigen::MatrixBase<Derived>& values) {
    for (Eigen::Index j = 0; j < values.cols(); ++j) {
      for (Eigen::Index i = 0; i < values.rows(); ++i) add(static_cast<double>(values(i, j)));
    }
  }
  [[nodiscard]] std::uint64_t value() const { return state_; }
  /// Returns the hash as 16 hexadecimal digits.
  [[nodiscard]] std::string text() const {
    constexpr char kDigits[] = "0123456789abcdef";
    std::string digits;
    for (int shift = 60; shift >= 0; shift -= 4) digits += kDigits[(state_ >> static_cast<unsigned>(shift)) & 0xfU];
    return digits;
  }

 private:
  std::uint64_t state_{0xcbf29ce484222325ULL};
};

}  // namespace saccade

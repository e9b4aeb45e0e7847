// SPDX-License-Identifier: Apache-2.0
#pragma once
// Hidden: a part of a class whose type only the class's source file knows.

#include <memory>
#include <utility>

namespace saccade {

/// Value of a type that may be incomplete where its owner is declared, and must be complete where the value is made. It
/// is copied, moved and const together with its owner. A moved-from value can only be assigned to or destroyed.
template <class T>
class Hidden {
 public:
  explicit Hidden(T value)
      : value_{std::make_shared<T>(std::move(value))}, copy_{[](const T& from) { return std::make_shared<T>(from); }} {}
  Hidden(const Hidden& other) : value_{other.copy_(*other.value_)}, copy_{other.copy_} {}
  Hidden(Hidden&&) noexcept = default;
  Hidden& operator=(Hidden other) noexcept {
    std::swap(value_, other.value_);
    std::swap(copy_, other.copy_);
    return *this;
  }
  ~Hidden() = default;

  [[nodiscard]] T& operator*() { return *value_; }
  [[nodiscard]] const T& operator*() const { return *value_; }
  [[nodiscard]] T* operator->() { return value_.get(); }
  [[nodiscard]] const T* operator->() const { return value_.get(); }

 private:
  std::shared_ptr<T> value_;  ///< never shared: it only remembers how to destroy a T
  std::shared_ptr<T> (*copy_)(const T&);
};

}  // namespace saccade

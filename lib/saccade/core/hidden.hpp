// SPDX-License-Identifier: Apache-2.0
#pragma once
// Hidden: a part of a class whose type only the class's source file knows.

#include <memory>
#include <utility>

namespace saccade {

/// A value that is copied, moved and const with its owner, though where the owner is declared it may be of an
/// incomplete type; where it is made, the type is complete. What was moved from can only be assigned to or destroyed.
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
  std::shared_ptr<T> value_;  ///< never shared: it only remembers how T is destroyed
  std::shared_ptr<T> (*copy_)(const T&);
};

}  // namespace saccade

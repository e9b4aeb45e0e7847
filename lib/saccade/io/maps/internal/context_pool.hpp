// SPDX-License-Identifier: Apache-2.0
#pragma once
// ContextPool: contexts of a C library that several threads take and give back.

#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// Pool of contexts of zstd, each some hundred kilobytes, so that they are not made for every sector.
template <class T, T* (*kMake)(), std::size_t (*kFree)(T*)>
class ContextPool {
 public:
  struct Free {
    void operator()(T* context) const { kFree(context); }
  };
  using Context = std::unique_ptr<T, Free>;

  [[nodiscard]] Context take() {
    const std::scoped_lock lock{mutex_};
    if (idle_.empty()) {
      Context made{kMake()};
      SACCADE_EXPECTS(made != nullptr);
      return made;
    }
    Context context = std::move(idle_.back());
    idle_.pop_back();
    return context;
  }
  void give_back(Context context) {
    const std::scoped_lock lock{mutex_};
    idle_.push_back(std::move(context));
  }

 private:
  std::mutex mutex_;
  std::vector<Context> idle_;
};

}  // namespace saccade

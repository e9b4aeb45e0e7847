// SPDX-License-Identifier: Apache-2.0
#pragma once
// SharedMap: the map behind a Python object.

#include <memory>
#include <mutex>

#include "convert.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade::python {

/// Map with its worker threads. Python threads may call it concurrently: writers wait for each other.
class SharedMap {
 public:
  SharedMap(TsdfMap map, std::size_t threads)
      : content_{std::make_shared<Content>(std::move(map))}, executor_{Executor::with_threads(threads)} {}

  /// Calls body(TsdfMap&) without the GIL, one caller at a time. Raises ValueError after the map was closed.
  template <class Body>
  auto write(const Body& body) {
    const std::shared_ptr<Content> content = open();
    const py::gil_scoped_release released;
    const std::scoped_lock lock{content->mutex};
    return body(content->map);
  }
  /// Waits without the GIL: who holds the map may be waiting for the GIL, to report progress.
  [[nodiscard]] TsdfSnapshot snapshot() const {
    const std::shared_ptr<Content> content = open();
    const py::gil_scoped_release released;
    return content->map.snapshot();
  }
  [[nodiscard]] const Executor& executor() const { return executor_; }
  void close() { content_.reset(); }

 private:
  struct Content {
    explicit Content(TsdfMap m) : map{std::move(m)} {}
    TsdfMap map;
    std::recursive_mutex mutex;  ///< recursive, because a writer's callees may write too
  };
  [[nodiscard]] std::shared_ptr<Content> open() const {
    if (!content_) throw py::value_error{"the map was closed"};
    return content_;
  }

  std::shared_ptr<Content> content_;
  Executor executor_;
};

}  // namespace saccade::python

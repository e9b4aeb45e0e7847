// SPDX-License-Identifier: Apache-2.0
#pragma once
// Records of runs as Python dictionaries.

#include "convert.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/explore/run_record.hpp"

namespace saccade::python {

template <class T>
py::object number_or_none(const std::optional<T>& value) {
  return value ? py::cast(*value) : py::none();
}

[[nodiscard]] py::dict to_dict(const Measures& measures);
[[nodiscard]] py::dict to_dict(const ScanRecord& scan);
[[nodiscard]] py::dict to_dict(const ViewRecord& view);
[[nodiscard]] py::dict to_dict(const RunRecord& run);
/// Returns mean, low, high, n.
[[nodiscard]] py::dict to_dict(const MeanEstimate& estimate);

}  // namespace saccade::python

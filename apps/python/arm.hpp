// SPDX-License-Identifier: Apache-2.0
#pragma once
// OwnArm: an arm that plans its own motions, whose joints a Python object may move.

#include "convert.hpp"
#include "saccade/arm/planned_arm.hpp"
#include "saccade/arm/urdf.hpp"

namespace saccade::python {

struct OwnArm {
  ArmModel model;
  std::vector<std::string> notes;
  std::vector<Box> fixtures;
  std::optional<Configuration> start;
  py::object joints;  ///< position() and execute(…); None: they are simulated

  /// Returns the arm in a map that has a workspace.
  [[nodiscard]] std::unique_ptr<PlannedArm> in(const TsdfConfig& map) const;
};

}  // namespace saccade::python

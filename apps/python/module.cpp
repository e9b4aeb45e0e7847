// SPDX-License-Identifier: Apache-2.0
// The Python module. Its docstrings name shapes, units and frames; docs/guides/python.md introduces it.
#include "convert.hpp"

PYBIND11_MODULE(_saccade, module) {
  module.doc() = "Next-best-view planning and TSDF mapping for robot-held depth cameras.";
  saccade::python::bind_sensor(module);
  saccade::python::bind_map(module);
  saccade::python::bind_views(module);
  saccade::python::bind_strategy(module);
  saccade::python::bind_arm(module);
  saccade::python::bind_explore(module);
  saccade::python::bind_trial(module);
  saccade::python::bind_hands(module);
  saccade::python::bind_frames(module);
  saccade::python::bind_clouds(module);
  saccade::python::bind_tracking(module);
  saccade::python::bind_segments(module);
  saccade::python::bind_filter(module);
  saccade::python::bind_surfels(module);
  saccade::python::bind_annotation(module);
}

// SPDX-License-Identifier: Apache-2.0
#include "records.hpp"

namespace saccade::python {
namespace {

py::dict refusals(const RefusalCounts& counts) {
  py::dict result;
  for (const Refusal refusal : kRefusalNames.values) {
    if (counts.of(refusal) > 0) result[py::str(std::string{to_string(refusal)})] = counts.of(refusal);
  }
  return result;
}

}  // namespace

py::dict to_dict(const Measures& measures) {
  py::dict result;
  result["coverage"] = number_or_none(measures.coverage);
  result["unknown_left"] = measures.unknown_left;
  result["unknown_near_objects"] = number_or_none(measures.unknown_near_objects);
  result["accuracy_m"] = number_or_none(measures.accuracy_m);
  result["chamfer_m"] = number_or_none(measures.chamfer_m);
  result["f_score"] = number_or_none(measures.f_score);
  return result;
}

py::dict to_dict(const ScanRecord& scan) {
  py::dict result = to_dict(scan.measures);
  result["complete"] = scan.complete;
  result["views"] = scan.views;
  result["frames"] = scan.frames;
  result["refused"] = refusals(scan.refused);
  return result;
}

py::dict to_dict(const ViewRecord& view) {
  py::dict result = to_dict(view.measures);
  result["region"] = view.region;
  result["T_world_camera"] = from_pose(view.T_world_camera);
  result["gain_predicted"] = view.gain_predicted;
  result["gain_observed"] = view.gain_observed;
  result["candidates"] = view.candidates;
  result["evaluated"] = view.evaluated;
  result["refused"] = refusals(view.refused);
  result["frames"] = view.frames;
  result["path_m"] = view.path_m;
  result["motion_s"] = view.motion_s;
  return result;
}

py::dict to_dict(const RunRecord& run) {
  py::list views;
  for (const ViewRecord& view : run.views) views.append(to_dict(view));
  py::dict result;
  result["scan"] = to_dict(run.scan);
  result["views"] = views;
  result["stopped_because"] = std::string{to_string(run.stopped_because)};
  result["final"] = to_dict(run.final());
  return result;
}

py::dict to_dict(const MeanEstimate& estimate) {
  py::dict result;
  result["mean"] = estimate.mean;
  result["low"] = number_or_none(estimate.low());
  result["high"] = number_or_none(estimate.high());
  result["n"] = estimate.n;
  return result;
}

}  // namespace saccade::python

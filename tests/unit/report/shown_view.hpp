// SPDX-License-Identifier: Apache-2.0
#pragma once
// shown_view: a view for the pages of the report's tests.

#include <utility>
#include <vector>

#include "saccade/report/run_report.hpp"

namespace saccade::test {

inline ShownView shown_view(std::size_t number, double gain, std::size_t candidates, const Measures& measures,
                            bool reveals_object, const std::vector<std::pair<Phase, double>>& ms) {
  ShownView view;
  view.number = number;
  view.record.gain_predicted = gain;
  view.record.candidates = candidates;
  view.record.measures = measures;
  view.record.reveals_object = reveals_object;
  for (const auto& [phase, spent] : ms) view.record.times.add(phase, spent);
  return view;
}

inline void without_truth(ShownView& view) {
  view.record.measures.coverage.reset();
  view.record.measures.unknown_near_objects.reset();
  view.record.reveals_object.reset();
}

}  // namespace saccade::test

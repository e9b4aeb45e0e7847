// SPDX-License-Identifier: Apache-2.0
// Feeds the reader of label presets.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "saccade/annotate/action.hpp"
#include "saccade/io/sessions/label_presets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto labels = saccade::parse_label_presets({reinterpret_cast<const char*>(data), size});
  if (labels && !saccade::check_action({0, saccade::DefineLabels{*labels}}, 1, 1.0)) std::abort();
  return 0;
}

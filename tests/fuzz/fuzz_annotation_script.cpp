// SPDX-License-Identifier: Apache-2.0
// Feeds the reader of annotation scripts, and does on a small cloud what they say.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "saccade/io/sessions/annotation_script.hpp"
#include "support/annotated_cloud.hpp"

namespace {

constexpr int kMostPixels{200'000};
constexpr std::size_t kMostActions{50};

bool is_large(const saccade::ScriptedAction& action) {
  return action.selection && action.selection->view.width > kMostPixels / action.selection->view.height;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const saccade::PointCloud cloud = saccade::test::patchy_cloud(12);
  static const auto graph = saccade::test::graph_of(cloud);
  const auto script = saccade::parse_annotation_script({reinterpret_cast<const char*>(data), size});
  if (!script || script->size() > kMostActions) return 0;
  if (!saccade::check_script(*script, cloud.positions_m.size(), graph->config().max_path)) return 0;
  saccade::Annotation annotation{graph};
  for (const saccade::ScriptedAction& scripted : *script) {
    if (is_large(scripted)) continue;
    auto action = saccade::resolve_action(scripted, cloud.positions_m, annotation, 1, saccade::Executor{});
    if (action && annotation.validate(*action)) annotation.apply(std::move(*action));
  }
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
#include "update_report.hpp"

#include "explore_report.hpp"
#include "saccade/io/image_io.hpp"
#include "saccade/report/exploration_pictures.hpp"
#include "view_json.hpp"

namespace saccade::cli {

Status UpdatePictures::draw_view(const TakenView& view) const {
  const std::optional<RobotDrawing> robot = drawing_of(devices_.arm(), view.view.q, view.view.path);
  return cli::draw_view(
      out_,
      {view.number, view.before, view.after, task_.regions.at(view.view.region).bounds, view.view, view.proposals,
       view.T_world_earlier, view.frames, subject_.after.scene.workspace, devices_.camera(), robot ? &*robot : nullptr},
      executor_);
}

Status UpdatePictures::draw_maps(const UpdateFigures& figures) const {
  const Box& workspace = subject_.after.scene.workspace;
  SACCADE_CHECK(write_png(out_ / "before.png", map_picture(figures.before, workspace, executor_)));
  SACCADE_CHECK(write_png(out_ / "regions.png", map_picture(figures.forgotten, workspace, executor_)));
  return write_png(out_ / "after.png", map_picture(figures.after, workspace, executor_));
}

Status remove_update_pictures(const RunFolder& out) {
  std::vector<std::string> names{"before.png", "hand.png", "regions.png", "after.png"};
  for (const auto& entry : std::filesystem::directory_iterator{out.path()}) {
    std::string name = entry.path().filename().string();
    if (is_view_picture(name)) names.push_back(std::move(name));
  }
  return out.remove(std::vector<std::string_view>{names.begin(), names.end()});
}

Status write_update_report(const UpdateOptions& /*options*/, const WatchedTask& /*task*/, const RunFolder& /*out*/,
                           const nlohmann::json& /*document*/) {
  return {};
}

}  // namespace saccade::cli

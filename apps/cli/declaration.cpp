// SPDX-License-Identifier: Apache-2.0
#include "declaration.hpp"

#include <sstream>

#include "saccade/core/angle.hpp"

namespace saccade::cli {

Declared Options::angle(const std::string& name, double& target_rad, const std::string& help) {
  std::ostringstream preset;
  preset << to_deg(target_rad);
  const auto take = [&target_rad](const double& angle_deg) { target_rad = to_rad(angle_deg); };
  return Declared{
      command_.add_option_function<double>(name, take, help)->type_name("DEGREES")->default_str(preset.str())};
}

void Options::direction(const std::string& name, std::optional<Eigen::Vector3d>& target, const std::string& help) {
  const auto take = [name, &target](const std::string& text) {
    const Eigen::Vector3d direction = parse_point(name, text);
    if (!(direction.norm() > 0.0)) usage_error(name, "needs a direction, not a zero vector");
    target = direction.normalized();
  };
  command_.add_option_function<std::string>(name, take, help)->type_name("X,Y,Z");
}

void Options::folder(FolderOption folder) {
  static_cast<FolderOption&>(folder_) = std::move(folder);
  add_value(command_, "--out", folder_.path, folder_.value, folder_.help)->required(folder_.required);
  command_.add_flag("--force", folder_.force, "write into a folder that holds other files");
}

}  // namespace saccade::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once
// The labelled clouds of mOSD, where they are.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/io/clouds/pcd_io.hpp"

namespace saccade::test {

struct LabelledCloud {
  std::string name;
  PointCloud cloud;
  std::vector<std::uint32_t> parts;  ///< 1–9: of the table, 20 and more: of objects; kUnlabelled: no point
};

inline constexpr std::uint32_t kFirstObjectPart{20};

/// In the order of their names; none if the folder is not there. Throws for a file that cannot be read.
inline std::vector<LabelledCloud> labelled_clouds(const std::filesystem::path& shared_data) {
  std::vector<LabelledCloud> clouds;
  const std::filesystem::path folder = shared_data / "mosd_labelled" / "learn";
  if (!std::filesystem::is_directory(folder)) return clouds;
  for (const auto& entry : std::filesystem::directory_iterator{folder}) {
    if (entry.path().extension() != ".pcd") continue;
    const PcdFile file = read_pcd(entry.path()).value();
    LabelledCloud labelled{entry.path().stem().string(), {}, {}};
    const std::vector<float> x = file.table.find("x")->values<float>();
    const std::vector<float> y = file.table.find("y")->values<float>();
    const std::vector<float> z = file.table.find("z")->values<float>();
    labelled.parts = file.table.find("label")->values<std::uint32_t>();
    for (std::size_t i = 0; i < x.size(); ++i) {
      labelled.cloud.positions_m.emplace_back(x[i], y[i], z[i]);
      if (labelled.parts[i] == 0) labelled.parts[i] = kUnlabelled;
    }
    clouds.push_back(std::move(labelled));
  }
  std::sort(clouds.begin(), clouds.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return clouds;
}

}  // namespace saccade::test

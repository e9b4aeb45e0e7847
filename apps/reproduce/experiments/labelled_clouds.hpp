// SPDX-License-Identifier: Apache-2.0
#pragma once
// LabelledClouds: those that Tables 4.5, 4.6 and 4.8 are made on.

#include <string>
#include <vector>

#include "annotate.hpp"
#include "table_options.hpp"

namespace saccade::reproduce {

struct LabelledCloud {
  cli::CloudJob job;  ///< `cloud` of a simulated one is the scene's name
  PointCloud points;
  std::vector<std::uint32_t> truth;  ///< per point; 0: none

  [[nodiscard]] std::size_t finite_points() const;
};

/// The clouds of a folder, or the built-in tabletops as a simulated Kinect sees them from before the table: label 1 is
/// what objects stand on, and every object has the next one.
class LabelledClouds {
 public:
  /// Opens TableOptions::clouds. Errors of plan_jobs.
  [[nodiscard]] static Result<LabelledClouds> open(const TableOptions& options);

  [[nodiscard]] std::size_t size() const { return jobs_.size(); }
  [[nodiscard]] bool are_made() const { return files_.cloud.empty(); }
  /// A sentence for people.
  [[nodiscard]] std::string about() const;
  /// Errors of load_cloud and read_truth.
  [[nodiscard]] Result<LabelledCloud> load(std::size_t cloud, const Executor& executor) const;

 private:
  LabelledClouds() = default;
  [[nodiscard]] Result<LabelledCloud> make(const cli::CloudJob& job, const Executor& executor) const;

  cli::AnnotateOptions files_;
  std::vector<cli::CloudJob> jobs_;
  std::uint64_t seed_{1};
  int image_width_px_{0};
};

}  // namespace saccade::reproduce

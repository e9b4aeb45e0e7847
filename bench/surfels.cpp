// SPDX-License-Identifier: Apache-2.0
// Fuses a folder of RGB-D frames into surfels with the mode filter and prints medians of the milliseconds per phase,
// and bytes per surfel.   Usage: surfels FOLDER [FRAMES] [THREADS]; exit status 77 without frames.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "saccade/io/rgbd_folder.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"

namespace {

using namespace saccade;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  RgbdFolderConfig config;
  config.count = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 200;
  const auto source = open_rgbd_folder(argv[1], config);
  if (!source) return std::puts(source.error().to_string().c_str()), 77;
  const Executor executor = Executor::with_threads(argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 0);
  SurfelFusion fusion = SurfelFusion::create().value();
  ModeFilter filter = ModeFilter::create().value();
  std::vector<std::vector<double>> phases(7);
  while (true) {
    const auto frame = (*source)->next();
    if (!frame) return std::puts(frame.error().to_string().c_str()), 1;
    if (!frame->has_value()) break;
    const auto fused = fusion.add_frame(**frame, (*source)->camera(), executor);
    if (!fused) return std::puts(fused.error().to_string().c_str()), 1;
    const auto filtered = filter.add_frame(**frame, fusion.association(), executor);
    const double ms[]{fused->points_ms,    fused->index_ms,        fused->associate_ms,
                      fused->integrate_ms, filtered->integrate_ms, filtered->guided_filter_ms,
                      filtered->move_ms};
    for (std::size_t i = 0; i < phases.size(); ++i) phases[i].push_back(ms[i]);
  }
  const char* names[]{"points", "index", "associate", "integrate", "filter.integrate", "filter.guided", "filter.move"};
  double fusion_ms{0.0};
  double all_ms{0.0};
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const double ms = median(phases[i]);
    std::printf("%-18s %7.2f ms\n", names[i], ms);
    all_ms += ms;
    if (i < 4) fusion_ms += ms;
  }
  const auto surfels = static_cast<double>(fusion.map().size());
  std::size_t modes{0};
  for (SurfelId id = 0; id < filter.size(); ++id) modes += filter.modes(id).size();
  std::printf("fusion %.2f ms, with the mode filter %.2f ms; %zu threads, %zu frames\n", fusion_ms, all_ms,
              executor.threads(), phases[0].size());
  std::printf("%.0f surfels, %.2f modes each; %.0f bytes each (map %.0f, modes %.0f)\n", surfels,
              static_cast<double>(modes) / surfels,
              static_cast<double>(fusion.map().memory_bytes() + filter.memory_bytes()) / surfels,
              static_cast<double>(fusion.map().memory_bytes()) / surfels,
              static_cast<double>(filter.memory_bytes()) / surfels);
  return surfels > 0.0 ? 0 : 1;
}

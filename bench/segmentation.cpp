// SPDX-License-Identifier: Apache-2.0
// segmentation DATA [RUNS]: supervoxels and LCCP on the labelled clouds of mOSD in DATA, ours beside PCL's where that
// is installed: weighted overlap, over- and under-segmentation, and the time of the fastest of RUNS (5). Exit status 1
// where ours is worse than PCL's, 77 where there are no clouds.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "saccade/core/clock.hpp"
#include "saccade/segment/overlap.hpp"
#include "segmentation_peer.hpp"
#include "support/labelled_clouds.hpp"

namespace {

using namespace saccade;

/// Means over clouds.
struct Row {
  double all{0.0}, objects{0.0}, whole_objects{0.0}, fos{0.0}, fus{0.0}, supervoxels_ms{0.0}, lccp_ms{0.0},
      segments{0.0};

  void add(const bench::PeerSegments& found, const test::LabelledCloud& truth, double share) {
    const SegmentOverlap whole = score_segments(found.labels, truth.parts).value();
    all += share * whole.weighted_overlap;
    fos += share * whole.over_segmentation;
    fus += share * whole.under_segmentation;
    objects += share * score_segments(found.labels, truth.parts, test::kFirstObjectPart).value().weighted_overlap;
    std::vector<std::uint32_t> merged = truth.parts;  // whole objects, and the whole table
    for (std::uint32_t& part : merged) part = part == kUnlabelled ? part : std::max(1U, part / 10);
    whole_objects += share * score_segments(found.labels, merged, test::kFirstObjectPart / 10).value().weighted_overlap;
    supervoxels_ms += share * found.supervoxels_ms;
    lccp_ms += share * found.lccp_ms;
    segments += share * static_cast<double>(found.segments);
  }
  void print(const std::string& who) const {
    std::printf("| %s | %.3f | %.3f | %.3f | %.3f | %.3f | %.0f | %.1f | %.2f |\n", who.c_str(), objects, whole_objects,
                all, fos, fus, segments, supervoxels_ms, lccp_ms);
  }
  /// Reference for ours.
  [[nodiscard]] bool is_no_worse_than(const Row& peer) const {
    constexpr double kSlack{0.005};
    return objects >= peer.objects - kSlack && whole_objects >= peer.whole_objects - kSlack && all >= peer.all;
  }
};

bench::PeerSegments segment_with_ours(const PointCloud& cloud, const SupervoxelConfig& config, const LccpConfig& lccp,
                                      const Executor& executor) {
  bench::PeerSegments found;
  const Stopwatch clustering_time;
  const SupervoxelResult supervoxels = find_supervoxels(cloud, config, executor).value();
  found.supervoxels_ms = clustering_time.elapsed_ms();
  const Stopwatch lccp_time;
  const LccpResult segments = segment_by_convexity(supervoxels, lccp).value();
  found.lccp_ms = lccp_time.elapsed_ms();
  found.labels = segments.labels;
  found.segments = segments.segments;
  return found;
}

template <class Segment>
Row measure(const std::vector<test::LabelledCloud>& clouds, int runs, const Segment& segment) {
  Row row;
  for (const test::LabelledCloud& cloud : clouds) {
    bench::PeerSegments fastest = segment(cloud.cloud);
    for (int run = 1; run < runs; ++run) {
      const bench::PeerSegments again = segment(cloud.cloud);
      fastest.supervoxels_ms = std::min(fastest.supervoxels_ms, again.supervoxels_ms);
      fastest.lccp_ms = std::min(fastest.lccp_ms, again.lccp_ms);
    }
    row.add(fastest, cloud, 1.0 / static_cast<double>(clouds.size()));
  }
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const std::vector<test::LabelledCloud> clouds = test::labelled_clouds(argv[1]);
  if (clouds.empty()) return 77;
  const int runs = argc > 2 ? std::max(1, std::atoi(argv[2])) : 5;
  SupervoxelConfig supervoxels;
  supervoxels.voxels.single_camera = true;
  std::printf(
      "| %zu clouds | WOv objects | whole objects | WOv all | Fos | Fus | segments | supervoxels, ms | LCCP, ms |\n",
      clouds.size());
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  LccpConfig extended, without_sanity;
  extended.extended_convexity = true;
  without_sanity.sanity = false;
  const std::array<std::pair<std::string, LccpConfig>, 3> kinds{
      {{"", {}}, {", extended convexity", extended}, {", without sanity", without_sanity}}};
  const Executor executor = Executor::with_threads(2);
  bool no_worse{true};
  for (const auto& [kind, lccp] : kinds) {
    const Row ours = measure(
        clouds, runs, [&](const PointCloud& cloud) { return segment_with_ours(cloud, supervoxels, lccp, executor); });
    ours.print("ours, 2 threads" + kind);
#ifdef SACCADE_WITH_PCL
    const Row peer = measure(
        clouds, runs, [&](const PointCloud& cloud) { return bench::segment_with_pcl(cloud, supervoxels, lccp); });
    peer.print("PCL" + kind);
    no_worse = no_worse && ours.is_no_worse_than(peer);
#endif
  }
  if (!no_worse) std::printf("\nOurs is worse than PCL's.\n");
  return no_worse ? 0 : 1;
}

# SPDX-License-Identifier: Apache-2.0
"""The table of ours beside the peers, and the list of everything measured."""
import statistics

from performance.results import figure, spread

# (row, what it does, peer, least ratio, most ms).
ROWS = [
    ("mapping:integrate/2", "fuse one 640×480 frame, free space and all, 5.8 mm voxels, truncation of 4",
     "mapping:open3d_integrate", 2.0, None),
    ("mapping:surface_raycast/2", "depth and normals of the surface, 640×480", "mapping:open3d_raycast", 4.0, None),
    ("mapping:icp/2", "align one 640×480 frame, three levels", "mapping:opencv_icp", 3.0, None),
    ("mapping:tracked_frame/2", "a whole tracked frame: ray cast, align, fuse", None, None, 45.0),
    ("depth_filter:filter_frame/surface/threads:1", "filter one 512×424 frame of a Kinect v2, one thread",
     "depth_filter:filter_frame/thesis/threads:1", None, 2.0),
    ("mapping:snapshot", "snapshot of the map", None, None, 1.0),
    ("mapping:forget", "forget a sphere of 0.2 m", None, None, 1.0),
    ("view_evaluation:all_savings/views:0/threads:2",
     "gains of 960 poses, a sphere of 0.2 m just forgotten, with preparation",
     "view_evaluation:embree/views:0/every:1", 10.0, 150.0),
    ("view_evaluation:all_savings/views:1/threads:2", "the same after the best view was fused",
     "view_evaluation:embree/views:1/every:1", None, 250.0),
    ("view_evaluation:all_savings/views:3/threads:2", "the same after three",
     "view_evaluation:embree/views:3/every:1", None, 250.0),
    ("regions:best_pose/again:0/threads:2", "only the best of 960 poses, in 20 regions of scanned tables",
     "regions:all_poses/again:0/threads:2", 2.0, None),
    ("regions:all_poses/again:1/threads:2", "all gains of these again, after the frame from the best pose, the 20 regions together",
     "regions:all_poses/again:0/threads:2", 2.0, None),
    ("regions:all_poses_of_median_region/again:1/threads:2", "the same, the median region",
     "regions:all_poses_of_median_region/again:0/threads:2", 2.0, None),
    ("regions:best_pose/again:1/threads:2", "only the best again", "regions:best_pose/again:0/threads:2", 2.0, None),
    ("view_evaluation:best_only/views:0/threads:2", "only the best of 960 poses, on the table that is known all around",
     "view_evaluation:all_savings/views:0/threads:2", 2.0, None),
    ("segments:clouds/2", "supervoxels and LCCP of twelve labelled clouds (mOSD)", "segments:pcl_clouds", 4.0, None),
    ("segments:map/voxel_um:7500/threads:2", "segments of a map with 490,000 surface voxels of 3.6 mm, in voxels of 7.2 mm",
     None, None, 250.0),
    ("segments:map/voxel_um:3600/threads:2", "the same in voxels of 3.6 mm", None, None, 250.0),
    ("segments:map_after_view/voxel_um:7500/threads:2", "these after one more view of about 5 % of it, in voxels of 7.2 mm",
     None, None, 20.0),
    ("segments:map_after_view/voxel_um:3600/threads:2", "the same in voxels of 3.6 mm", None, None, 20.0),
    ("segments:attention/voxel_um:7500/threads:2", "segments and saliency of that map, in voxels of 7.2 mm", None, None, 250.0),
    ("segments:attention/voxel_um:3600/threads:2", "the same in voxels of 3.6 mm", None, None, 250.0),
    ("segments:attention_after_view/voxel_um:7500/threads:2",
     "segments and saliency after one more view of about 5 % of it, in voxels of 7.2 mm", None, None, 20.0),
    ("segments:attention_after_view/voxel_um:3600/threads:2", "the same in voxels of 3.6 mm", None, None, 20.0),
    ("surfels:fusion/frames:200/threads:2", "a recorded 640×480 frame into surfels, the median of 200", None, None, 12.0),
    ("surfels:fusion_and_mode_filter/frames:200/threads:2", "the same with mode filter and guided filter", None, None, 33.0),
    ("guided_filter:ours/threads:2", "guided filter of a 640×480 frame, four channels, two threads", "guided_filter:naive/threads:2",
     3.0, 6.0),
    ("mode_filter:ours/threads:1", "six 640×480 frames of a table with noise into modes, one thread", "mode_filter:naive", None,
     None),
    ("surfel_segments:fill/threads:1", "flood fill of a million surfels, one thread", "surfel_segments:fill_by_nanoflann", None,
     None),
    ("contours:from_scratch/threads:2", "contours of that map", "contours:voxel_by_voxel", None, None),
    ("contours:after_view/threads:2", "contours after one more view of about 5 % of it", None, None, None),
    ("standard_views:best_of_all/views:0/threads:2",
     "the best of 95,728 views of all contours of a table, 512×424 rays, the whole workspace, after the scan", None, None, 10000.0),
    ("standard_views:best_of_all/views:2/threads:2", "of 125,096 after two views more", None, None, 10000.0),
    ("annotation:neighbourhood_without_normals/2",
     "neighbourhood graph of a labelled cloud (mOSD, 169,969 points), distances alone, two threads",
     "annotation:neighbourhood_by_nanoflann", 2.0, None),
    ("annotation:neighbourhood/2", "the same with normals estimated, as it usually is", "annotation:neighbourhood_by_nanoflann",
     None, 60.0),
    ("annotation:control_points_90", "its labels from 90 control points, one thread", "annotation:control_points_90_by_dijkstra",
     2.0, 13.0),
    ("annotation:add_control_point", "one control point more, mean", None, None, None),
    ("annotation:remove_control_point", "one fewer, mean", None, None, None),
    ("annotation:graph_ten_million", "graph of ten million points, tiled from labelled clouds", None, None, 20000.0),
    ("annotation:first_control_point_ten_million", "the first control point in it", None, None, 300.0),
    ("annotation:add_ten_million", "one more beside a thousand, mean", None, None, None),
]
# (row, median over what it did in one repetition, most ms).
MEDIANS = [("annotation:add_control_point", "one control point more", 0.1),
           ("annotation:remove_control_point", "one fewer", 0.15),
           ("annotation:add_ten_million", "one more among ten million points", 20.0)]
MOST_MIB = 3072
PEERS = {"mapping:open3d_integrate": "Open3D VoxelBlockGrid, surface blocks only",
         "mapping:open3d_raycast": "Open3D VoxelBlockGrid",
         "mapping:opencv_icp": "OpenCV FastICPOdometry",
         "depth_filter:filter_frame/thesis/threads:1": "the thesis' filter",
         "view_evaluation:embree/views:0/every:1": "Embree, 16 rays at a time, without its preparation",
         "view_evaluation:embree/views:1/every:1": "Embree",
         "view_evaluation:embree/views:3/every:1": "Embree",
         "view_evaluation:all_savings/views:0/threads:2": "all poses, as above",
         "regions:all_poses/again:0/threads:2": "all poses",
         "regions:all_poses_of_median_region/again:0/threads:2": "the first time, the median region",
         "regions:best_pose/again:0/threads:2": "the first time",
         "segments:pcl_clouds": "PCL",
         "contours:voxel_by_voxel": "voxel by voxel",
         "guided_filter:naive/threads:2": "a sum over every window",
         "mode_filter:naive": "Algorithm 6 as printed",
         "surfel_segments:fill_by_nanoflann": "nanoflann and a queue",
         "annotation:neighbourhood_by_nanoflann": "nanoflann, distances alone, one thread",
         "annotation:control_points_90_by_dijkstra": "Dijkstra's algorithm as in a book"}


def target_row(results, row):
    """One line of the table, and whether the targets are held."""
    name, what, peer, least_ratio, most_ms = row
    ours = results.times.get(name)
    if not ours:
        return f"| {what} | not measured | | | | |", False
    held = most_ms is None or statistics.median(ours) <= most_ms
    if peer and results.times.get(peer):
        ratio = results.median_ms(peer) / statistics.median(ours)
        held = held and (least_ratio is None or ratio >= least_ratio)
        cells = f"{PEERS[peer]} | {spread(results.times[peer])} | {ratio:.1f}×"
    else:
        held = held and (peer is None or least_ratio is None)
        cells = (f"{PEERS[peer]}: not installed" if peer else "–") + " | | "
    wanted = " and ".join(([f"≥ {least_ratio:g}×"] if least_ratio else []) + ([f"≤ {most_ms:g} ms"] if most_ms else []))
    answer = f"{wanted}: {'yes' if held else 'no'}" if wanted else "–"
    return f"| {what} | {spread(ours)} | {cells} | {answer} |", held


def differing(results):
    """How the gains of Embree differ, in a sentence."""
    shares = [results.counter(f"view_evaluation:embree/views:{views}/every:1", "differing") for views in (0, 1, 3)]
    shares = [share for share in shares if share is not None]
    if not shares:
        return []
    return [f"Gains are equal to the ray among ours. Beside Embree, whose single-precision distances decide otherwise where "
            f"a ray passes through the edge of a voxel, {1e6 * max(shares):.1f} in a million of the rays that score differ at "
            "most; 1000 would fail the benchmark.", ""]


def annotation(results):
    """Medians and memory in a sentence, and whether they are held."""
    parts = []
    held = True
    for row, what, most_ms in MEDIANS:
        microseconds = results.counter(row, "median_us")
        if microseconds is None:
            return [], False
        good = 1e-3 * microseconds <= most_ms
        held = held and good
        parts.append(f"{what} {figure(1e-3 * microseconds)} ms (≤ {most_ms:g}: {'yes' if good else 'no'})")
    peak, kept = (results.counter("annotation:graph_ten_million", name) for name in ("peak_mib", "kept_mib"))
    good = peak <= MOST_MIB
    return [f"Annotation, medians of single control points: {', '.join(parts)}. Graph and forest of ten million points take "
            f"{peak:,.0f} MiB at the most (≤ {MOST_MIB:,}: {'yes' if good else 'no'}) and keep {kept:,.0f} MiB.", ""], held and good


def section(results):
    """Lines, and whether all targets are held."""
    lines = ["## Beside the peers", "", "| work | ours, ms | peer | peer, ms | ratio | held |", "|---|---|---|---|---|---|"]
    held_all = True
    for row in ROWS:
        line, held = target_row(results, row)
        lines.append(line)
        held_all = held_all and held
    told, held = annotation(results)
    return lines + [""] + differing(results) + told, held_all and held


def everything(results):
    """Returns the rows that no other table has."""
    told = {row[0] for row in ROWS} | {row[2] for row in ROWS}
    elsewhere = ("savings:", "scaling:", "phases:", "machine:")
    lines = ["## Everything else measured", "",
             "Names end with the number of threads; `_on_` names the instruction set that was forced.", "",
             "| program | benchmark | ms |", "|---|---|---|"]
    for row, times in sorted(results.times.items()):
        if row not in told and not row.startswith(elsewhere):
            program, name = row.split(":", 1)
            lines.append(f"| `{program}` | `{name}` | {spread(times)} |")
    for row, why in sorted(results.errors.items()):
        lines.append(f"| `{row.split(':', 1)[0]}` | `{row.split(':', 1)[1]}` | failed: {why} |")
    return lines + [""]

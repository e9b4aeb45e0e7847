#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/performance.md from what scripts/bench.sh left: performance_table.py RESULTS DOCUMENT."""
import json
import pathlib
import re
import statistics
import subprocess
import sys

PROGRAM = "build/release/saccade"
# What is measured: (program, benchmark, what it does, peer or None, least ratio, most ms).
ROWS = [
    ("view_evaluation", "all_savings/views:0/threads:2", "gains of 960 poses, a sphere of 0.2 m just forgotten, with "
     "preparation", "embree/views:0/every:1", 10.0, 150.0),
    ("view_evaluation", "all_savings/views:1/threads:2", "the same after the best view was fused",
     "embree/views:1/every:1", None, 250.0),
    ("view_evaluation", "all_savings/views:3/threads:2", "the same after three", "embree/views:3/every:1", None, 250.0),
    ("view_evaluation", "best_only/views:0/threads:2", "only the best of the 960 poses",
     "all_savings/views:0/threads:2", 2.0, None),
    ("mapping", "integrate/2", "fuse one 640×480 frame, free space and all, 5.8 mm voxels, truncation of 4",
     "open3d_integrate", 2.0, None),
    ("mapping", "surface_raycast/2", "depth and normals of the surface, 640×480", "open3d_raycast", 4.0, None),
    ("mapping", "icp/2", "align one 640×480 frame, three levels", "opencv_icp", 3.0, None),
    ("mapping", "tracked_frame/2", "a whole tracked frame: ray cast, align, fuse", None, None, 45.0),
    ("mapping", "snapshot", "snapshot of the map", None, None, 1.0),
    ("mapping", "forget", "forget a sphere of 0.2 m", None, None, 1.0),
]
PEERS = {"open3d_integrate": "Open3D VoxelBlockGrid, surface blocks only",
         "open3d_raycast": "Open3D VoxelBlockGrid",
         "opencv_icp": "OpenCV FastICPOdometry",
         "embree/views:0/every:1": "Embree, 16 rays at a time, without its preparation",
         "embree/views:1/every:1": "Embree", "embree/views:3/every:1": "Embree",
         "all_savings/views:0/threads:2": "all poses, as above"}


def measured(results, program):
    """Milliseconds of every repetition, by name without its suffixes."""
    path = results / f"{program}.json"
    if not path.exists():
        return {}, {}
    document = json.loads(path.read_text())
    times = {}
    for run in document["benchmarks"]:
        if run["run_type"] != "iteration" or run.get("error_occurred"):
            continue
        name = re.sub(r"/(real_time|manual_time|process_time|repeats:\d+)", "", run["run_name"])
        milliseconds = run["real_time"] * {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}[run["time_unit"]]
        times.setdefault(name, []).append(milliseconds)
    return times, document["context"]


def figure(value):
    return f"{value:.3f}" if value < 0.1 else f"{value:.2f}" if value < 10 else f"{value:.1f}"


def spread(times):
    return f"{figure(statistics.median(times))} ({figure(min(times))} to {figure(max(times))})"


def target_row(times, row):
    _, name, what, peer, least_ratio, most_ms = row
    ours = times.get(name)
    if not ours:
        return [f"| {what} | not measured | | | | |"], False
    cells, held = [], True
    if peer and times.get(peer):
        ratio = statistics.median(times[peer]) / statistics.median(ours)
        held = least_ratio is None or ratio >= least_ratio
        cells = [PEERS[peer], spread(times[peer]), f"{ratio:.1f}×"]
    else:
        cells = [f"{PEERS[peer]}: not installed" if peer else "–", "", ""]
        held = peer is None or least_ratio is None
    if most_ms is not None:
        held = held and statistics.median(ours) <= most_ms
    wanted = " and ".join(([f"≥ {least_ratio:g}×"] if least_ratio else []) + ([f"≤ {most_ms:g} ms"] if most_ms else []))
    return [f"| {what} | {spread(ours)} | {cells[0]} | {cells[1]} | {cells[2]} | {wanted}: {'yes' if held else 'no'} |"], held


def main(results, document):
    about = json.loads(subprocess.run([PROGRAM, "info", "--json", "-"], capture_output=True, text=True, check=True)
                       .stdout)["result"]
    lines = ["# Performance", "",
             "Written by `make bench`: medians in milliseconds of seven repetitions, with the fastest and slowest; ours and",
             "the peers run in one process, on the same data, warm, in random order. Frames are those of the 7-Scenes kitchen",
             "(`bench/frames.cpp`); views look at a table with clutter (`bench/view_evaluation.cpp`). Results are compared",
             "before or while they are timed.", ""]
    held_all, context = True, {}
    table = ["| work | ours, ms | peer | peer, ms | ratio | held |", "|---|---|---|---|---|---|"]
    others = []
    named = {}
    for program in sorted({row[0] for row in ROWS}):
        times, program_context = measured(results, program)
        context = program_context or context
        for row in (row for row in ROWS if row[0] == program):
            row_lines, held = target_row(times, row)
            table += row_lines
            held_all = held_all and held
            named.update({row[1]: True, row[3]: True})
        others += [f"| `{program}` | `{name}` | {spread(values)} |" for name, values in sorted(times.items())
                   if name not in named]
    lines += [f"Machine: {about['processor']}, {about['cores']} cores, kernels on {about['simd_target']}; {about['compiler']}, "
              f"oneTBB {about['dependencies']['onetbb']}. Load at the start: "
              f"{', '.join(f'{load:.1f}' for load in context.get('load_avg', [])) or 'unknown'}.", "",
              "## Beside the peers", "", *table, "", "## Everything measured", "",
              "Names end with the number of threads; `_on_` names the instruction set that was forced.", "", "| program | benchmark | ms |", "|---|---|---|", *others, ""]
    pathlib.Path(document).write_text("\n".join(lines))
    print(f"written: {document}" + ("" if held_all else "; some targets are not held"))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), sys.argv[2])

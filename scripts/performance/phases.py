# SPDX-License-Identifier: Apache-2.0
"""Where the time goes: tables of the phases of a tracked frame and of an evaluation."""
from performance.results import figure

FRAME = [("surface_lists_ms", "ray cast", "lists of surface bricks per tile of 8×8 pixels"),
         ("surface_rays_ms", "ray cast", "rays through the bricks of their tile"),
         ("points_ms", "track", "points and normals of the model and of the frame"),
         ("align_ms", "track", "pairs and steps of ICP, three levels"),
         ("ranges_ms", "fuse", "ranges along rays, bounds of squares of pixels"),
         ("sectors_ms", "fuse", "choice of sectors"),
         ("bricks_ms", "fuse", "octants judged, voxels of bricks near surfaces updated")]
EVALUATION = [("grid_ms", "prepare", "what rays meet, per brick (stop grid)"),
              ("windows_ms", "prepare", "windows of rays that meet the region, shared lattices"),
              ("tiles_ms", "evaluate", "tiles of rays that share their fate"),
              ("rays_ms", "evaluate", "rays that tiles leave over, in packets")]


def table(results, phases, columns):
    """Columns: (heading, row of the results)."""
    columns = [(heading, row) for heading, row in columns if row in results.times]
    if not columns:
        return []
    lines = ["| part | phase | " + " | ".join(f"{heading}, ms | share" for heading, _ in columns) + " |",
             "|---|---|" + "---|---|" * len(columns)]
    sums = {row: sum(results.counter(row, name) for name, _, _ in phases) for _, row in columns}
    for name, part, what in phases:
        cells = [f"{figure(results.counter(row, name))} | {100 * results.counter(row, name) / sums[row]:.0f} %"
                 for _, row in columns]
        lines.append(f"| {part} | {what} | " + " | ".join(cells) + " |")
    lines.append("| | together | " + " | ".join(f"{figure(sums[row])} | " for _, row in columns) + "|")
    return lines + [""]


def section(results):
    frame = table(results, FRAME, [(f"{n} thread{'s' if n > 1 else ''}", f"phases:tracked_frame/threads:{n}")
                                   for n in (1, 2)])
    evaluation = table(results, EVALUATION, [(f"{views} views fused", f"phases:evaluation/views:{views}")
                                             for views in (0, 1, 3)])
    lines = ["## Where the time goes", "", "Each phase timed by itself on the same data, mean over the frames."]
    if frame:
        lines += ["", "A tracked frame of 640×480:", "", *frame]
    if evaluation:
        lines += ["An evaluation of 960 poses, on one thread:", "", *evaluation]
    return lines if frame or evaluation else []

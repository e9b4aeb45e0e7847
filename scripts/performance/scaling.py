# SPDX-License-Identifier: Apache-2.0
"""How cost grows: one table and one plot per thing that varies."""
from performance import plots
from performance.results import figure

WORK = [("evaluate", "view evaluation"), ("integrate", "fuse a frame"), ("surface_raycast", "surface ray cast")]
# (part of the rows' names, scale of their arguments, file, heading, axis).
VARIED = [("poses", 1.0, "views", "Number of views", "view poses, 80 per longitude"),
          ("image_width", 1.0, "image", "Image size", "image width, px (4:3)"),
          ("voxel_um", 1e-3, "voxel", "Voxel size", "edge of a voxel, mm"),
          ("extent_m", 1.0, "extent", "Extent of the map", "edge of the workspace, m"),
          ("threads", 1.0, "threads", "Threads", "threads")]
COMMENTS = {
    "poses": "Each longitude adds as many camera centres; the poses straight above share one.",
    "image_width": "An exponent of 2 would be a cost per pixel. Tiles make large images cheaper per pixel for evaluation; "
                   "fusion depends on the bricks near surfaces, not on pixels.",
    "voxel_um": "Minus 2 is a cost per surface voxel, minus 1 a cost per voxel along a ray. The truncation stays 4 voxels.",
    "extent_m": "Only the space between cameras and region is looked at, so that a larger map costs nothing more. In the "
                "smallest the cameras are outside, where all is transparent.",
    "threads": "Minus 1 would be perfect.",
}


def section(results, images):
    lines = ["## How cost grows", "",
             "Medians in milliseconds on two threads where threads do not vary; exponents are those of the power law through",
             "the points. All else as above: 960 views of 640×480 rays, 5.8 mm.", ""]
    found = False
    for varied, scale, file, heading, axis in VARIED:
        series = [(label, [(scale * x, ms) for x, ms in results.by_argument(f"scaling:{work}_by_{varied}")])
                  for work, label in WORK]
        series = [(label, points) for label, points in series if points]
        if not series:
            continue
        found = True
        lines += [f"### {heading}", "", COMMENTS[varied], ""]
        values = [x for x, _ in series[0][1]]
        lines += ["| " + axis + " | " + " | ".join(f"{x:g}" for x in values) + " | exponent |",
                  "|---|" + "---|" * (len(values) + 1)]
        for label, points in series:
            law = f"{plots.exponent(points):.2f}".replace("-", "−") if len(points) > 1 else "–"
            lines.append(f"| {label} | " + " | ".join(figure(ms) for _, ms in points) + f" | {law} |")
        if plots.lines(images / f"performance-{file}.svg", heading, axis, series):
            lines += ["", f"![cost against: {axis}](../images/performance-{file}.svg)"]
        lines.append("")
    return lines if found else []

#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws Fig. 3.17 of the thesis anew: voxels near the objects that are still unknown, over the first five views.

The thesis explored four table scenes with a Kinect v2 on an arm; here the camera flies, and the scenes are made up. A
line is the mean of the seeds, the band around it goes from the least to the greatest. Needs python3-matplotlib. The
cells (# %%) can be run one by one in an editor or as a notebook."""
# %% What is compared
import argparse
import sys

import matplotlib
import numpy as np

import saccade

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
parser.add_argument("picture", nargs="?", default="figure_3_17.png")
parser.add_argument("--scenes", nargs="+", default=["clutter:1", "clutter:2", "clutter:3", "clutter:4"])
parser.add_argument("--seeds", type=int, default=3, help="runs of each strategy in a scene")
parser.add_argument("--views", type=int, default=5)
options = parser.parse_args() if hasattr(sys.modules["__main__"], "__file__") else parser.parse_args([])
picture, scenes, views = options.picture, options.scenes, options.views
strategies = {"attention": "proposed approach", "standard": "standard approach", "surface": "expected surface (ours)"}


# %% The runs: each strategy in each scene with each seed
def told(stage, done, total):
    if stage == "runs":
        print(f"{done} of {total} runs", file=sys.stderr)


result = saccade.trial.compare(list(strategies), scenes, seeds=list(range(1, options.seeds + 1)), max_views=views, voxel_size_m=0.0117, width=320,
                               gain_width=96, progress=told)


# %% Unknown voxels near the objects, after the scan and after each view
def curve(run):
    counts = [run["scan"]["unknown_near_objects"]] + [view["unknown_near_objects"] for view in run["views"]]
    return counts + [counts[-1]] * (1 + views - len(counts))  # a run that ended earlier stays as it is


# %% The figure
columns = min(2, len(scenes))
rows = -(-len(scenes) // columns)
figure, axes = plt.subplots(rows, columns, figsize=(5 * columns, 3.5 * rows), squeeze=False, layout="constrained")
for axis, scene in zip(axes.flat, scenes):
    for strategy, label in strategies.items():
        curves = np.array([curve(run) for run in result["runs"] if (run["scene"], run["strategy"]) == (scene, strategy)])
        line, = axis.plot(curves.mean(axis=0), marker="o", label=label)
        axis.fill_between(range(views + 1), curves.min(axis=0), curves.max(axis=0), alpha=0.2, color=line.get_color(), linewidth=0)
    axis.set(title=scene, xlabel="next-best views", ylabel="unknown voxels near objects", ylim=(0, None))
axes.flat[0].legend()
for axis in axes.flat[len(scenes):]:
    axis.remove()
figure.savefig(picture, dpi=110)
print(f"{picture}: {len(result['runs'])} runs")

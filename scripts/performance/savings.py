# SPDX-License-Identifier: Apache-2.0
"""Effect of each saving of view evaluation: a table, and a plot of one added after the other."""
from performance import plots
from performance.results import figure

ALL_POSES = 960
# In the order in which bench/savings.cpp adds them.
SAVINGS = [("blocked_camera", "a camera inside something gains nothing"),
           ("region_rays", "only rays that meet the region's unknown voxels"),
           ("empty_bricks", "pass over empty bricks"),
           ("region_exit", "stop where the ray leaves the region"),
           ("shared_lattice", "cast rays that poses share once"),
           ("tiles", "decide whole tiles of rays"),
           ("exposed_voxels", "heed only voxels that a ray can come to"),
           ("packets", "walk the rest many rays at a time"),
           ("footprints", "cast only rays that pass a face that can be entered to score")]
# Rows that are the same as others are measured once.
SAME = {"only_region_rays": "up_to_region_rays", "only_blocked_camera": "none", "up_to_blocked_camera": "none"}


def milliseconds(results, name, views):
    """Returns the time of 960 poses, and whether it was scaled up from fewer; None: not measured."""
    row = f"savings:{name}/views:{views}"
    if row not in results.times:
        row = f"savings:{SAME.get(name)}/views:{views}"
    time, poses = results.median_ms(row), results.counter(row, "poses")
    if time is None or not poses:
        return None
    return time * ALL_POSES / poses, poses < ALL_POSES


def cell(results, name, views):
    found = milliseconds(results, name, views)
    return "–" if found is None else ("≈ " if found[1] else "") + figure(found[0])


def section(results, images):
    if milliseconds(results, "all", 0) is None:
        return []
    lines = ["## What each saving brings", "",
             "Milliseconds for 960 poses on two threads, with a region just forgotten and after one view was fused. Each",
             "saving alone on top of none, added to those in the rows above it, and left out of all. Without tiles only 16",
             "or 88 of the poses are evaluated, all rolls of some camera centres, once; the time is scaled to 960 (≈), and",
             "a busy machine shows in it. Tiles alone include passing over empty bricks, which they go by; packets need all",
             "others. No camera of this scene is blocked, so that saving is not timed by itself. Every gain is compared with",
             "that of all savings; that none changes a gain, each alone, without each, none and all, is held to brute force",
             "by `tests/parity/view_gain_test.cpp`.", "",
             "| saving (`GainSavings`) | alone | added | all without it | after a view: alone | added | all without it |",
             "|---|---|---|---|---|---|---|",
             "| none | " + " | ".join(f"{cell(results, 'none', views)} | | " for views in (0, 1)) + "|"]
    for name, what in SAVINGS:
        cells = [cell(results, f"{kind}_{name}", views) for views in (0, 1) for kind in ("only", "up_to", "without")]
        lines.append(f"| `{name}`: {what} | " + " | ".join(cells) + " |")
    bars = [("none", milliseconds(results, "none", 0))]
    bars += [("+ " + name, milliseconds(results, f"up_to_{name}", 0)) for name, _ in SAVINGS[1:]]
    bars = [(name, time[0]) for name, time in bars if time]
    plots.bars(images / "performance-savings.svg", "960 poses, one saving after the other", bars, "ms")
    together = milliseconds(results, "none", 0), milliseconds(results, "all", 0)
    if all(together):
        lines += ["", f"Together: {together[0][0] / together[1][0]:,.0f} times faster than none of them."]
    return lines + ["", "![milliseconds, one saving added after the other](../images/performance-savings.svg)", ""]

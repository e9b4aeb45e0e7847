#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Strategies beside the oracle, over many scenes: evidence_planner.py PROGRAM FOLDER DOCUMENT [CAMPAIGN…].

Runs the campaigns (all of them, or those that are named) with `saccade compare`, each into a folder of its own under
FOLDER, where what was done before is not done again, and writes what they come to into DOCUMENT, with what it is held
to. Where a cluster answers, all of them are submitted there (evidence_campaign.py), and a later call goes on.
"table" in place of a campaign runs none, and writes what there is. Exit status 1: something that is held to was missed,
2: a campaign failed, 3: one is not complete.
SACCADE_DATA: scanned meshes (../shared/data)."""
import csv
import functools
import math
import os
import pathlib
import statistics
import subprocess
import sys

from evidence_campaign import INTERRUPTED, NOT_COMPLETE

BASELINES = ("occlusion-aware,unobserved-voxel,rear-side-voxel,rear-side-entropy,proximity-count,average-entropy,"
             "area-factor,surface-edge,projection")
UNSEEN = "clutter:201-230"  # scenes that nothing was chosen by
ROOMS = "tabletop-1,tabletop-2,tabletop-3,tabletop-4,bottle,jug"
DATA = pathlib.Path(os.environ.get("SACCADE_DATA", "../shared/data"))


def campaign(title, scenes, strategies, *options, views=5):
    told = ["--scenes", scenes, "--strategies", strategies, "--seeds", "1", "--max-views", str(views)]
    return {"title": title, "strategies": strategies.split(","), "options": [*told, *options]}


def campaigns():
    """Name → what it is and what compare is called with."""
    every = f"attention,standard,sphere,{BASELINES}"
    result = {
        "clutter_arm": campaign("Thirty scenes of clutter, the arm", UNSEEN, "surface,oracle,sphere,standard,attention",
                                "--robot", "comau"),
        "clutter_flying": campaign("Thirty scenes of clutter, flying", UNSEEN,
                                   "surface,oracle,sphere,standard,attention"),
        "lookahead_flying": campaign("Thirty scenes of clutter, flying, looking two views ahead", UNSEEN, "surface",
                                     "--lookahead", "2"),
        "lookahead_arm": campaign("Thirty scenes of clutter, the arm, looking two views ahead", UNSEEN, "surface",
                                  "--lookahead", "2", "--robot", "comau"),
        "baselines_flying": campaign("Scenes of clutter, flying: gains of other authors, and the oracle of pairs",
                                     UNSEEN, f"{BASELINES},oracle-2"),
        "rooms_arm": campaign("Tabletops, bottle and jug, the arm", ROOMS, "surface,sphere,oracle", "--robot", "comau"),
        "rooms_flying": campaign("Tabletops, bottle and jug, flying", ROOMS, "surface,sphere,oracle"),
        "long_flying": campaign("Thirty scenes of clutter, flying, twelve views", UNSEEN, "surface", views=12),
        "endless_flying": campaign("Thirty scenes of clutter, flying, twenty views and no end before", UNSEEN, "surface",
                                   "--least-share", "0", "--min-gain", "0.001", views=20),
        "every_flying": campaign("Every strategy that goes by gain, flying", ROOMS, every),
        "every_arm": campaign("Every strategy that goes by gain, the arm", ROOMS, every, "--robot", "comau"),
        "every_ur": campaign("Every strategy that goes by gain, an arm like a UR5e", "tabletop-1,jug", f"surface,{every}",
                             "--robot", "ur_like"),
    }
    meshes = DATA / "meshes_ycb"
    if meshes.is_dir():
        result["household_flying"] = campaign("Household objects, scanned, flying", str(meshes), "surface,sphere,oracle")
        result["household_arm"] = campaign("Household objects, scanned, the arm", str(meshes), "surface,sphere,oracle",
                                           "--robot", "comau")
    return result


class Figures:
    """Runs and views of a campaign, or of several."""

    def __init__(self, runs, views):
        self.runs, self.views = runs, views
        self.scenes = len({run["scene"] for run in runs})

    @classmethod
    def read(cls, folder, strategies):
        """Reads the tables of a campaign that was run, or as far as it was."""
        def rows(name):
            with (folder / name).open() as file:
                return [row for row in csv.DictReader(file) if row["strategy"] in strategies]

        return cls(rows("runs.csv"), rows("views.csv"))

    def beside(self, other):
        """These figures with those of another campaign's runs in the same scenes."""
        scenes = {run["scene"] for run in self.runs}
        return Figures(self.runs + [run for run in other.runs if run["scene"] in scenes],
                       self.views + [view for view in other.views if view["scene"] in scenes])

    def strategies(self):
        return list(dict.fromkeys(run["strategy"] for run in self.runs))

    def by_scene(self, strategy, figure):
        """Scene → value, with more than one seed the mean."""
        values = {}
        for run in self.runs:
            if run["strategy"] == strategy and run[figure]:
                values.setdefault(run["scene"], []).append(float(run[figure]))
        return {scene: statistics.mean(of_scene) for scene, of_scene in values.items()}

    def mean(self, strategy, figure):
        values = list(self.by_scene(strategy, figure).values())
        return statistics.mean(values) if values else math.nan

    def after(self, strategy, number):
        """Mean coverage after a view; a run that ended before counts with what it ended with."""
        values = {}
        for view in self.views:
            if view["strategy"] == strategy and int(view["number"]) <= number:
                values[(view["scene"], view["noise"], view["seed"])] = float(view["coverage"])
        return statistics.mean(values.values()) if values else math.nan

    def gap(self, a, b, figure):
        """Mean of a − b over the scenes that both have, and the half width of its 95 % interval."""
        of_a, of_b = self.by_scene(a, figure), self.by_scene(b, figure)
        gaps = [of_a[scene] - of_b[scene] for scene in of_a if scene in of_b]
        if len(gaps) < 2:
            return (gaps[0] if gaps else math.nan), math.inf
        return statistics.mean(gaps), student_t(len(gaps) - 1) * statistics.stdev(gaps) / math.sqrt(len(gaps))

    def ratio_half_width(self, a, b, figure):
        """Half width of the 95 % interval of mean a / mean b, by the delta method on the scenes that both have."""
        of_a, of_b = self.by_scene(a, figure), self.by_scene(b, figure)
        pairs = [(of_a[scene], of_b[scene]) for scene in of_a if scene in of_b]
        if len(pairs) < 2:
            return math.inf
        mean_a, mean_b = (statistics.mean(side) for side in zip(*pairs))
        rests = [(one_a - mean_a / mean_b * one_b) / mean_b for one_a, one_b in pairs]
        return student_t(len(rests) - 1) * statistics.stdev(rests) / math.sqrt(len(rests))

    def promises(self, strategy):
        """(promised, observed) of each view, run by run."""
        runs = {}
        for view in self.views:
            if view["strategy"] == strategy and view["number"] != "0" and view["gain_observed"]:
                key = (view["scene"], view["noise"], view["seed"])
                runs.setdefault(key, []).append((float(view["gain"]), float(view["gain_observed"])))
        return runs

    def broken_twice(self, strategy, share):
        """Runs with two views in a row that kept less than a share of their promise."""
        return sum(any(a[1] < share * a[0] and b[1] < share * b[0] for a, b in zip(views, views[1:]))
                   for views in self.promises(strategy).values())

    def idle(self, strategy):
        """Runs that took five views, gained nothing, and left more than 5 %."""
        return sum(run["strategy"] == strategy and float(run["views"]) >= 5 and float(run["coverage"]) < 0.95
                   and float(run["coverage"]) - float(run["initial_coverage"]) < 1e-3 for run in self.runs)


@functools.cache
def student_t(degrees):
    """97.5 % quantile, for 95 % intervals: bisection on the closed forms of Abramowitz and Stegun, 26.7.3 and 26.7.4."""
    def within(t):
        """Probability of [-t, t]."""
        angle, odd = math.atan(t / math.sqrt(degrees)), degrees % 2
        term, total = math.cos(angle) if odd else 1.0, 0.0
        for k in range(1 + odd, degrees, 2):
            total += term
            term *= k / (k + 1) * math.cos(angle) ** 2
        total *= math.sin(angle)
        return 2 / math.pi * (angle + total) if odd else total

    low, high = 1.0, 13.0
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if within(middle) < 0.95 else (low, middle)
    return 0.5 * (low + high)


def ranks(values):
    order = sorted(range(len(values)), key=values.__getitem__)
    result = [0.0] * len(values)
    begin = 0
    while begin < len(order):
        end = begin
        while end < len(order) and values[order[end]] == values[order[begin]]:
            end += 1
        for i in order[begin:end]:
            result[i] = 0.5 * (begin + end + 1)
        begin = end
    return result


def calibration(pairs):
    """Rank correlation, and the median of what was kept; without views that promised nothing, as calibration_of does it."""
    pairs = [(promised, observed) for promised, observed in pairs if promised > 0 and math.isfinite(observed)]
    if len(pairs) < 3:
        return math.nan, math.nan
    kept = statistics.median(observed / promised for promised, observed in pairs)
    promised, observed = (ranks(list(side)) for side in zip(*pairs))
    if len(set(promised)) == 1 or len(set(observed)) == 1:
        return math.nan, kept  # all alike: no order
    return statistics.correlation(promised, observed), kept


def table(figures):
    lines = ["| strategy | coverage, % | its area, % | unknown near objects | views | rank correlation | kept, median |",
             "|---|---|---|---|---|---|---|"]
    for strategy in figures.strategies():
        pairs = [pair for views in figures.promises(strategy).values() for pair in views]
        correlation, kept = calibration(pairs)
        cells = [f"{100 * figures.mean(strategy, 'coverage'):.1f}", f"{100 * figures.mean(strategy, 'coverage_area'):.1f}",
                 f"{figures.mean(strategy, 'unknown_near_objects'):,.0f}", f"{figures.mean(strategy, 'views'):.1f}",
                 "–" if math.isnan(correlation) else f"{correlation:.2f}", "–" if math.isnan(kept) else f"{kept:.2f}"]
        lines.append(f"| `{strategy}` | " + " | ".join(cells) + " |")
    return lines


class Held:
    """What is held to, and whether it was met.

    @param so_far  of a campaign that is not complete"""

    def __init__(self, so_far=False):
        self.lines = []
        self.missed = 0
        self.so_far = " so far" if so_far else ""

    def to(self, text, value, limit, at_least, digits=2, half=None):
        """@param half  half width of an interval, which is told; the value alone is held to the limit"""
        met = value >= limit if at_least else value <= limit
        self.missed += not met
        outcome = f"met{self.so_far}" if met else f"**missed{self.so_far}**"
        interval = "" if half is None else f" ± {half:.{digits}f}"
        self.lines.append(f"- {outcome}: {text}: {value:.{digits}f}{interval} "
                          f"(at {'least' if at_least else 'most'} {limit:.{digits}f})")


def hold(name, figures, all_figures):
    held = Held()
    if name.startswith("clutter_"):
        held.to("coverage beside the oracle's, points", 100 * figures.gap("surface", "oracle", "coverage")[0], -0.5, True)
        held.to("area as a share of the oracle's", figures.mean("surface", "coverage_area") /
                figures.mean("oracle", "coverage_area"), 0.98, True, 3)
        held.to("unknown near objects, as a multiple of the oracle's", figures.mean("surface", "unknown_near_objects") /
                figures.mean("oracle", "unknown_near_objects"), 1.3, False)
        for other in ("sphere", "standard", "attention"):
            gap, half = figures.gap("surface", other, "coverage_area")
            held.to(f"area beside {other}'s, points, low end of the interval", 100 * (gap - half), 0.0, True)
        pairs = [pair for views in figures.promises("surface").values() for pair in views]
        held.to("rank correlation of promised and observed", calibration(pairs)[0], 0.7, True)
        held.to("median kept", calibration(pairs)[1], 0.7, True)
    if name.startswith(("rooms_", "household_")):
        for figure in ("coverage", "coverage_area"):
            ours, theirs = figures.by_scene("surface", figure), figures.by_scene("sphere", figure)
            below = [scene for scene in ours if ours[scene] < theirs[scene] - 1e-9]
            held.to(f"scenes with less {figure.replace('_', ' ')} than sphere ({', '.join(below) or 'none'})", len(below),
                    0, False, 0)
    if name.startswith("lookahead_") and name.replace("lookahead", "clutter") in all_figures:
        ours = figures.by_scene("surface", "coverage_area")
        theirs = all_figures[name.replace("lookahead", "clutter")].by_scene("oracle", "coverage_area")
        held.to("scenes with more area than the oracle, share", statistics.mean(ours[s] > theirs[s] for s in ours), 0.5, True)
    if name == "baselines_flying" and "clutter_flying" in all_figures:
        ours = all_figures["clutter_flying"].by_scene("surface", "coverage_area")
        for other in BASELINES.split(","):
            theirs = figures.by_scene(other, "coverage_area")
            gaps = [ours[scene] - theirs[scene] for scene in ours if scene in theirs]
            half = student_t(len(gaps) - 1) * statistics.stdev(gaps) / math.sqrt(len(gaps))
            held.to(f"area of surface beside {other}'s, points, low end of the interval",
                    100 * (statistics.mean(gaps) - half), 0.0, True)
    if name == "long_flying":
        held.to("coverage where runs stop themselves", figures.mean("surface", "coverage"), 0.995, True, 4)
    if name == "endless_flying":
        held.to("coverage after twelve views", figures.after("surface", 12), 0.995, True, 4)
    if name == "endless_flying" and "long_flying" in all_figures:
        stopped = all_figures["long_flying"]
        held.to("coverage that stopping leaves, points", 100 * (figures.mean("surface", "coverage") -
                                                              stopped.mean("surface", "coverage")), 0.5, False)
        views = stopped.by_scene("surface", "views").values()
        held.to("views before a run stops, mean", statistics.mean(views), 10, False, 1)
        held.to("views before a run stops, the most of any scene", max(views), 10, False, 0)
    for strategy in figures.strategies():
        if strategy.startswith("oracle"):
            continue  # a yardstick: its promise counts points of the truth, what it keeps counts voxels
        broken, idle = figures.broken_twice(strategy, 0.01), figures.idle(strategy)
        if broken or idle or name.startswith("every_"):
            held.to(f"runs of {strategy} in which two views in a row kept less than 1 %", broken, 0, False, 0)
            held.to(f"runs of {strategy} in which five views gained nothing", idle, 0, False, 0)
    return held


def run(program, name, wanted, folder):
    """@return the exit status of evidence_campaign.py."""
    script = pathlib.Path(__file__).with_name("evidence_campaign.py")
    command = [str(script), program, str(folder / name), "compare", *wanted["options"]]
    print(f"  {name}: {' '.join(command)}", flush=True)
    with (folder / f"{name}.log").open("w") as log:
        status = subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, check=False).returncode
    if status in INTERRUPTED:
        sys.exit(status)
    return status


def main():
    program, folder, document, *names = sys.argv[1:]
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    known = campaigns()
    wanted = [] if names == ["table"] else names or list(known)
    statuses = {name: run(program, name, known[name], folder) for name in wanted}
    incomplete = [name for name, status in statuses.items() if status == NOT_COMPLETE]
    failed = [name for name, status in statuses.items() if status not in (0, NOT_COMPLETE)]
    if incomplete:
        print(f"  {document} stays as it is; failed: {', '.join(failed) or 'none'}; not complete: {', '.join(incomplete)}")
        return 2 if failed else NOT_COMPLETE
    done = {name: Figures.read(folder / name, known[name]["strategies"]) for name in known
            if (folder / name / "runs.csv").exists()}
    lines = ["# The planner, measured", "",
             "Written by `make evidence` (`scripts/evidence_planner.py`). One seed a scene, the noise of a Kinect v1; means "
             "over scenes. Nothing was chosen by the scenes clutter:201-230. [Metrics](../reference/metrics.md), "
             "[strategies](../guides/exploration.md), [gains of other authors](../design/baselines.md).", ""]
    missed = 0
    for name, figures in done.items():
        held = hold(name, figures, done)
        missed += held.missed
        shown, note = figures, ""
        if name == "baselines_flying" and "clutter_flying" in done:
            shown = figures.beside(done["clutter_flying"])
            note = " The last five rows are the campaign `clutter_flying` in these scenes."
        told = " ".join(known[name]["options"]).replace(str(DATA), "$SACCADE_DATA")
        lines += [f"## {known[name]['title']}", "", "```sh", f"saccade compare {told} --out DIR", "```", "",
                  f"{figures.scenes} scenes.{note}", "", *table(shown), "", *held.lines, ""]
    pathlib.Path(document).write_text("\n".join(lines).rstrip() + "\n")
    print(f"  {document}: {missed} missed; failed: {', '.join(failed) or 'none'}")
    return 2 if failed else 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Published protocols, all strategies and published figures: evidence_benchmark.py PROGRAM FOLDER DOCUMENT [table].

Runs each protocol of `saccade benchmark` on stand-ins, and on the meshes that are there, as a campaign in a folder of its own under
FOLDER (evidence_campaign.py: an interrupted one goes on with the same call, and a cluster that answers gets it). With "table",
nothing runs. DOCUMENT gets the tables that are there, and says which protocols were not run yet.
Exit status 0: complete, and `surface` reached the published figures; 1: it missed one; 2: a campaign failed; 3: not complete.
SACCADE_DATA: meshes (../shared/data). STANFORD: folder of scripts/stanford_meshes.sh (out/stanford).
SACCADE_BENCHMARK_SEEDS: how many seeds (3)."""
import csv
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import typing

from evidence_campaign import INTERRUPTED, NOT_COMPLETE

FOLDERS = {"$SACCADE_DATA": os.environ.get("SACCADE_DATA", "../shared/data"), "$STANFORD": os.environ.get("STANFORD", "out/stanford")}
SEEDS = int(os.environ.get("SACCADE_BENCHMARK_SEEDS", "3"))
OURS = {"surface": "ours", "surface-one-shot": "ours, all views at once"}
KINDS = {**OURS, "standard": "the thesis", "random": "chance", "random-contours": "chance"}
FROM = {"published": "the published meshes, checked by their MD5",
        "stand-ins": "stand-ins, made by rule; they are not those of the publications, so that figures cannot be compared with theirs",
        "own": "meshes other than those of the publications, so that figures cannot be compared with theirs"}


def filled_in(words):
    """Words with the folders in place of their names."""
    for name, folder in FOLDERS.items():
        words = words.replace(name, folder)
    return words


class Campaign(typing.NamedTuple):
    title: str
    words: str  # after `saccade benchmark`; with names of FOLDERS
    needs: str = ""  # file or folder; without it nothing runs
    about: str = ""  # replaces the origin of the objects

    def can_run(self):
        return not self.needs or pathlib.Path(filled_in(self.needs)).exists()


ABOUT = ("Written by `make evidence` (`scripts/evidence_benchmark.py`) from the tables of the commands below. "
         "[Published protocols](../guides/benchmark.md) says what they are, what of the publications could be read, and what is measured. "
         "Means over objects, each with the mean of its first views and seeds; ± is half of the 95 % interval over objects. A run ends "
         "before its last view where no view gains anything: \"taken\" is the mean. Baselines are "
         "[gains of other authors](../design/baselines.md). Differences are paired by object (`tabletop-arm`: by scene); bold ones have an "
         "interval without 0, each by itself: nothing is corrected for the number of comparisons. Published figures are held to shares of "
         "all, after the published number of views, or after the protocol's where that is less. `$STANFORD` is a folder that "
         "`scripts/stanford_meshes.sh` has filled, `$SACCADE_DATA` one with the YCB meshes.")
ARMADILLO = ("the Armadillo of the Stanford 3D Scanning Repository with 26,002 of its 172,974 vertices, as of "
             "`scripts/stanford_meshes.sh`, checked by its MD5. The published run is of the Armadillo")
STANFORD = ("the Bunny and the Dragon of the Stanford 3D Scanning Repository, and its Armadillo with 26,002 of 172,974 vertices, as "
            "`scripts/stanford_meshes.sh` fetches them, checked by their MD5")
CAMPAIGNS = {
    "benchmark_view-sphere": Campaign("`view-sphere`", "view-sphere"),
    "benchmark_one-shot": Campaign("`one-shot`", "one-shot"),
    "benchmark_tabletop-arm": Campaign("`tabletop-arm`", "tabletop-arm", about="random clutter, eight objects a scene"),
    "benchmark_household": Campaign("`household`", "household"),
    "benchmark_ycb": Campaign("`household`, YCB objects", "household --objects $SACCADE_DATA/meshes_ycb", "$SACCADE_DATA/meshes_ycb",
                              "scans `google_16k` of the YCB objects, checked by their MD5"),
    "benchmark_view-sphere_armadillo": Campaign("`view-sphere`, the published object", "view-sphere --objects $STANFORD --only armadillo",
                                                "$STANFORD/armadillo.off", ARMADILLO),
    "benchmark_view-sphere_stanford": Campaign("`view-sphere`, Stanford models", "view-sphere --objects $STANFORD", "$STANFORD", STANFORD),
    "benchmark_one-shot_stanford": Campaign("`one-shot`, Stanford models", "one-shot --objects $STANFORD", "$STANFORD", STANFORD),
}


def seed_text(seeds):
    seeds = sorted(seeds)
    return f"{seeds[0]}-{seeds[-1]}" if 1 < len(seeds) == seeds[-1] - seeds[0] + 1 else ",".join(map(str, seeds))


def run(program, name, folder):
    """@return the exit status of evidence_campaign.py."""
    words = filled_in(CAMPAIGNS[name].words).split()
    command = [pathlib.Path(__file__).with_name("evidence_campaign.py"), program, folder / name, "benchmark", *words, "--seeds",
               seed_text(range(1, SEEDS + 1))]
    print("  " + " ".join(map(str, command)), flush=True)
    with (folder / f"{name}.log").open("w") as log:
        status = subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, check=False).returncode
    if status in INTERRUPTED:
        sys.exit(status)
    return status


def number(row, column):
    return float(row[column]) if row.get(column) else math.nan


def estimate(row, column, times=100.0, digits=1, sign=""):
    """Mean and half of its interval; a mean of one object has none."""
    mean, low = number(row, column), number(row, f"{column}_low")
    if math.isnan(mean):
        return ""
    text = f"{times * mean:{sign}.{digits}f}"
    if float(text) == 0:
        text = text.lstrip("+-")
    return text if math.isnan(low) else f"{text} ± {times * (mean - low):.{digits}f}"


class Results:
    """Tables of a campaign, and the words of its result where they are there."""

    def __init__(self, folder):
        def read(name):
            path = folder / name
            with path.open() if path.exists() else open(os.devnull) as file:
                return list(csv.DictReader(file))

        table = read("table.csv")
        self.published = [row for row in table if row["published"]]
        self.ours = [row for row in table if not row["published"]]
        self.strategies = list(dict.fromkeys(row["method"] for row in self.ours))
        self.differences, self.curves, self.runs = read("differences.csv"), read("curves.csv"), read("runs.csv")
        self.seeds = {int(run["seed"]) for run in self.runs}
        result = folder.with_name(folder.name + ".json")
        self.told = json.loads(result.read_text())["result"].get("benchmark", {}) if result.exists() else {}
        self.objects = list(dict.fromkeys(run["scene"].partition("@")[0] for run in self.runs))
        self.sources = list(dict.fromkeys(row["source"] for row in self.published))
        self.idle = [name for name in self.strategies if not any(run["strategy"] == name and int(run["views"]) for run in self.runs)]
        self.objects_from = table[0]["objects_from"] if table else ""
        self.complete = bool(table) and table[0]["complete"] == "yes" and len(self.seeds) >= SEEDS
        self.measured = bool(self.curves)  # by the protocol's rule; else coverage is that of the map
        self.views = sorted({int(number(row, "views")) for row in self.ours}) if self.measured else []

    def row(self, strategy, views=None):
        return next(row for row in self.ours if row["method"] == strategy and views in (None, number(row, "views")))

    def at(self, published):  # number of views of ours that a published figure is set beside
        return min(math.floor(number(published, "views")), self.views[-1])

    def views_until(self, strategy, share):
        """Views after which the mean over objects of all is not below a share; None if that is never."""
        by_view = {}
        for point in self.curves:
            if point["strategy"] == strategy:
                objects = by_view.setdefault(int(point["view"]), {})
                objects.setdefault(point["object"].partition("@")[0], []).append(float(point["of_all"]))
        return next((view for view, objects in sorted(by_view.items())
                     if statistics.mean(map(statistics.mean, objects.values())) >= share), None)


def table_of_shares(results):
    last = results.views[-1]
    lines = ["| method | which | " + "".join(f"of all after {views}, % | " for views in results.views) +
             f"of visible after {last}, % | taken of {last} | source |", "|---|---|" + "---|" * (len(results.views) + 3)]
    for strategy in results.strategies:
        rows = [results.row(strategy, views) for views in results.views]
        cells = [*(estimate(row, "of_all") for row in rows), estimate(rows[-1], "of_visible"), estimate(rows[-1], "views_taken", 1)]
        lines.append(f"| `{strategy}` | {KINDS.get(strategy, 'baseline')} | " + " | ".join(cells) + " | this run |")
    for method, source in dict.fromkeys((row["method"], row["source"]) for row in results.published):
        figures = {results.at(row): row for row in results.published if (row["method"], row["source"]) == (method, source)}
        cells = []
        for views in results.views:
            row = figures.get(views)
            of = f" ({number(row, 'views'):g} views)" if row and number(row, "views") != views else ""
            cells.append(f"{100 * number(row, 'published'):.1f}{of}" if row else "")
        lines.append(f"| {method} | published | " + " | ".join(cells) + f" | | | [{results.sources.index(source) + 1}] |")
    return lines


def table_of_arms(results):
    told = {row["method"]: row for row in results.told.get("table", [])}
    lines = ["| method | which | coverage, % | views | path, m | motion, s | source |", "|---|---|---|---|---|---|---|"]
    for strategy in results.strategies:
        row = dict(results.row(strategy))
        for column in ("path_m", "motion_s"):  # their intervals are in the result alone
            row[f"{column}_low"] = told.get(strategy, {}).get(column, {}).get("low")
        lines.append(f"| `{strategy}` | {KINDS.get(strategy, 'baseline')} | {estimate(row, 'of_visible')} | {number(row, 'views'):.1f} | "
                     f"{estimate(row, 'path_m', 1, 2)} | {estimate(row, 'motion_s', 1)} | this run |")
    return lines


def differences(results):
    columns = ["of_visible", "of_all"] if results.measured else ["of_visible"]
    titles = "of visible, points | of all, points" if results.measured else "coverage, points"
    first, views = results.differences[0]["method"], results.differences[0]["views"]
    lines = [f"| `{first}` beside, after {'' if results.measured else 'at most '}{views} views | {titles} |",
             "|---|" + "---|" * len(columns)]
    for row in results.differences:
        bold = {column: "**" if row[f"{column}_excludes_0"] == "yes" else "" for column in columns}
        cells = (f"{mark}{estimate(row, column, sign='+')}{mark}" for column, mark in bold.items())
        lines.append(f"| `{row['beside']}` | {' | '.join(cells)} |")
    idle = [f"Differences beside `{name}` say only that no view after the first had any gain for it.\n" for name in results.idle]
    return [*lines, "", *idle]


def held_to(results):
    """Lines on what is held to published figures, and how many of them the first strategy missed."""
    lines, missed, so_far = [], 0, "" if results.complete else " so far"
    for published in (row for row in results.published if number(row, "views") > 1):  # the first view is given, not chosen
        share = number(published, "published")
        other = "" if published["same_object"] == "yes" else " (other objects)"
        for strategy in (name for name in results.strategies if name in OURS):
            row = results.row(strategy, results.at(published))
            gap = 100 * (number(row, "of_all") - share)
            missed += gap < 0 and strategy == results.strategies[0]
            until = results.views_until(strategy, share)
            lines.append(f"- {f'**missed{so_far}**' if gap < 0 else f'met{so_far}'}: `{strategy}` after {results.at(published)} views: "
                         f"{estimate(row, 'of_all')} % of all; {published['method']}: {100 * share:.1f} % after "
                         f"{number(published, 'views'):g} views{other}{f'; short by {-gap:.1f} points' if gap < 0 else ''}"
                         f"{f'; reached after {until} views' if until else ''}")
    return lines, missed


def section(name, folder):
    """Lines of a campaign's section, how many published figures its first strategy missed, and whether it is complete."""
    campaign, results = CAMPAIGNS[name], Results(folder / name)
    seeds = seed_text(results.seeds or range(1, SEEDS + 1))
    command = f"saccade benchmark {campaign.words} --seeds {seeds} --out DIR"
    lines = [f"## {campaign.title}", "", "```sh", command, "```", ""]
    if not results.ours or (results.ours[0]["complete"] != "yes" and number(results.ours[0], "objects") < 2):
        missing = "" if campaign.can_run() else f": `{campaign.needs}` was not there"
        why = f"{len(results.runs)} runs so far: too few for figures" if results.runs else f"Not run yet{missing}"
        return [*lines, f"{why}.", ""], 0, not campaign.can_run()
    told, origin = results.told, campaign.about or FROM[results.objects_from]
    so_far = f"; {len(results.seeds)} of {SEEDS} seeds so far" if len(results.seeds) < SEEDS else ""
    so_far += "" if results.ours[0]["complete"] == "yes" else "; runs are missing, and the table is over what all strategies have in common"
    text = f": {told['text']}; {told['measure']}" if told else ""
    lines += [f"Version {results.ours[0]['version']} of the protocol{text}. Objects: {', '.join(results.objects)}; {origin}. "
              f"{len(results.runs):,} runs{so_far}.", "",
              *(table_of_shares(results) if results.measured else table_of_arms(results)), ""]
    for index, source in enumerate(results.sources, 1):
        rows = [row for row in results.published if row["source"] == source]
        about = "; ".join(dict.fromkeys(f"{row['method']}: {row['object']}" for row in rows))
        lines += [f"[{index}] {source}. {about}. What differs here: {rows[0]['differs']}.", ""]
    if told.get("not_published"):
        lines += [f"No published figures: {told['not_published']}.", ""]
    held, missed = held_to(results)
    return [*lines, *(differences(results) if results.differences else []), *held, *[""] * bool(held)], missed, results.complete


def main():
    program, folder, document, *rest = sys.argv[1:]
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    statuses = {name: run(program, name, folder) for name, campaign in CAMPAIGNS.items() if campaign.can_run() and rest != ["table"]}
    failed = [name for name, status in statuses.items() if status not in (0, NOT_COMPLETE)]
    lines, missed, incomplete = ["# Published protocols, all strategies", "", ABOUT, ""], 0, []
    for name in CAMPAIGNS:
        told, missed_here, complete = section(name, folder)
        lines, missed, incomplete = lines + told, missed + missed_here, incomplete + ([] if complete else [name])
    pathlib.Path(document).write_text("\n".join(lines).rstrip() + "\n")
    print(f"  {document}: {missed} missed; failed: {', '.join(failed) or 'none'}; not complete: {', '.join(incomplete) or 'none'}")
    return 2 if failed else 1 if missed else 3 if incomplete else 0


if __name__ == "__main__":
    sys.exit(main())

# SPDX-License-Identifier: Apache-2.0
"""Finished seeds of a campaign as text, a file each: what no machine has to run again.

A record is FOLDER/KIND-seed-SEED.csv: a line per run with its figures, all digits of them, and per view what it promised and what it
made known. Its first line has the settings of the runs, which name the program's revision: records of other settings are
an error, and are moved away by hand."""
import csv
import json
import pathlib
import re
import sqlite3

from evidence_planner import Figures

KEPT = ("scene", "strategy", "seed", "coverage", "coverage_area", "unknown_near_objects", "views")
NOISE = "kinect-v1"


def promises(views):
    """"12:11 3:2.5": promised and observed, view by view."""
    return " ".join(f"{view['gain']}:{view['gain_observed']}" for view in views if view["number"] != "0" and view["gain_observed"])


def rows_of(figures, seed):
    """The lines of a record."""
    views = {}
    for view in figures.views:
        views.setdefault((view["scene"], view["strategy"], view["seed"]), []).append(view)
    rows = []
    for run in figures.runs:
        if int(run["seed"]) == seed:
            key = (run["scene"], run["strategy"], run["seed"])
            rows.append({**{name: run[name] for name in KEPT}, "promised:observed": promises(views.get(key, []))})
    return sorted(rows, key=lambda row: (row["scene"], row["strategy"]))


def settings_of(campaign):
    """The settings that the runs of a campaign have in common, as a line of JSON."""
    with sqlite3.connect(f"file:{campaign / 'campaign.sqlite'}?mode=ro", uri=True) as file:
        found = [json.loads(settings) for settings, in file.execute("SELECT DISTINCT settings FROM runs")]
    common = {name: value for name, value in found[0].items() if all(one.get(name) == value for one in found)}
    return json.dumps(common, sort_keys=True)


class Records:
    def __init__(self, folder, kind, strategies, scenes):
        self.folder, self.kind, self.strategies, self.scenes = pathlib.Path(folder), kind, strategies, scenes
        self.rows = {}
        self.settings = None
        for path in sorted(self.folder.glob(f"{kind}-seed-*.csv")):
            with path.open() as file:
                settings = file.readline().removeprefix("# ").strip()
                if self.settings not in (None, settings):
                    raise SystemExit(f"{path}: has other settings than the records before it; move the old ones away")
                self.settings = settings
                self.rows[int(re.search(r"-seed-(\d+)", path.name)[1])] = list(csv.DictReader(file))

    def seeds(self):
        return sorted(self.rows)

    def add_whole_seeds(self, campaign):
        """Writes a record of each seed that a campaign has of all scenes and strategies."""
        if not (campaign / "runs.csv").exists():
            return
        figures = Figures(campaign, self.strategies)
        for seed in sorted({int(run["seed"]) for run in figures.runs} - set(self.rows)):
            rows = rows_of(figures, seed)
            if len(rows) < self.scenes * len(self.strategies):
                continue
            settings = settings_of(campaign)
            if self.settings not in (None, settings):
                raise SystemExit(f"{campaign}: its runs have other settings than the records in {self.folder}; move those away")
            self.settings = settings
            self.folder.mkdir(parents=True, exist_ok=True)
            path = self.folder / f"{self.kind}-seed-{seed:02}.csv"
            unfinished = path.with_suffix(".part")
            with unfinished.open("w") as file:
                file.write(f"# {settings}\n")
                writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
            unfinished.rename(path)
            self.rows[seed] = rows

    def with_runs_of(self, campaign):
        """Figures of all records, and of the seeds that the campaign has beside them."""
        figures = Figures.__new__(Figures)
        figures.runs, figures.views = [], []
        if (campaign / "runs.csv").exists():
            here = Figures(campaign, self.strategies)
            figures.runs = [run for run in here.runs if int(run["seed"]) not in self.rows]
            figures.views = [view for view in here.views if int(view["seed"]) not in self.rows]
        for rows in self.rows.values():
            for row in rows:
                figures.runs.append({**row, "noise": NOISE})
                for number, pair in enumerate(row["promised:observed"].split(), 1):
                    gain, observed = pair.split(":")
                    figures.views.append({"scene": row["scene"], "strategy": row["strategy"], "noise": NOISE, "seed": row["seed"],
                                          "number": str(number), "gain": gain, "gain_observed": observed})
        figures.scenes = len({run["scene"] for run in figures.runs})
        return figures

    def differences(self, seed, campaign):
        """How runs that were done again differ from the record, a text each."""
        recorded = {(row["scene"], row["strategy"]): row for row in self.rows[seed]}
        again = rows_of(Figures(campaign, self.strategies), seed)
        found = [f"{row['scene']}, {row['strategy']}: {name} {recorded[row['scene'], row['strategy']][name]}, now {value}"
                 for row in again for name, value in row.items() if recorded[row["scene"], row["strategy"]][name] != value]
        return found if again else ["nothing was run"]

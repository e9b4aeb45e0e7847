# SPDX-License-Identifier: Apache-2.0
"""Finished seeds of a campaign as text, a file each: what no machine has to run again.

A record is FOLDER/KIND-seed-SEED.csv: a line per run with its figures, all digits of them, and per view what it promised and what it
made known. Its first line has the settings of each strategy, with the revision. Runs of other settings, or of a scene with another
hash, are an error, and records of such are moved away by hand; the program's version is kept, and may differ."""
import csv
import json
import pathlib
import re

from evidence_planner import Figures

KEPT = ("scene", "scene_hash", "strategy", "seed", "coverage", "coverage_area", "unknown_near_objects", "views", "program_version")
PAIRS = "promised:observed"
NOT_FIGURES = ("scene_hash", "program_version")
NOISE = "kinect-v1"


class RecordError(Exception):
    """Records or tables that cannot be read, or that do not belong together."""


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
            rows.append({**{name: run[name] for name in KEPT}, PAIRS: promises(views.get(key, []))})
    return sorted(rows, key=lambda row: (row["scene"], row["strategy"]))


def read_tables(campaign, strategies):
    """Figures of a campaign, empty where it has no runs yet."""
    if not (campaign / "runs.csv").exists():
        return Figures([], [])
    try:
        figures = Figures.read(campaign, strategies)
    except (OSError, KeyError) as error:
        raise RecordError(f"{campaign}: its tables cannot be read: {error!r}") from error
    missing = {"settings", *KEPT} - set(figures.runs[0] if figures.runs else KEPT + ("settings",))
    if missing:
        raise RecordError(f"{campaign / 'runs.csv'}: lacks {', '.join(sorted(missing))}")
    return figures


class Origin:
    """Settings of each strategy and hash of each scene, which runs must have in common to be averaged."""

    def __init__(self, settings=(), hashes=()):
        self.settings, self.hashes = dict(settings), dict(hashes)

    @classmethod
    def of(cls, runs):
        """Origin of runs as runs.csv has them, and how they differ from each other, a text each."""
        origin, differing = cls(), []
        for strategy, settings in sorted({(run["strategy"], run["settings"]) for run in runs}):
            differing += origin.add(cls({strategy: json.loads(settings)}))
        for scene, scene_hash in sorted({(run["scene"], run["scene_hash"]) for run in runs}):
            differing += origin.add(cls(hashes={scene: scene_hash}))
        return origin, differing

    def add(self, other):
        """Adds strategies and scenes that are new here. Returns how the others differ, a text each."""
        differing = []
        for strategy, settings in other.settings.items():
            here = self.settings.setdefault(strategy, settings)
            names = sorted(name for name in {*here, *settings} if here.get(name) != settings.get(name))
            differing += [f"{strategy} with several settings ({', '.join(names)})"] if names else []
        for scene, scene_hash in other.hashes.items():
            here = self.hashes.setdefault(scene, scene_hash)
            differing += [f"{scene} with several hashes ({here}, {scene_hash})"] if here != scene_hash else []
        return differing

    def differences(self, other):
        """Tells how another origin differs from this one, a text each."""
        return Origin(self.settings, self.hashes).add(other)


class Records:
    def __init__(self, folder, kind, strategies, scenes):
        self.folder, self.kind, self.strategies, self.scenes = pathlib.Path(folder), kind, strategies, scenes
        self.rows = {}
        self.origin = Origin()
        for path in sorted(self.folder.glob(f"{kind}-seed-*.csv")):
            seed, origin, rows = self._read(path)
            if differing := self.origin.add(origin):
                raise RecordError(f"{path}: does not belong to the records before it: {'; '.join(differing)}; move the old ones away")
            self.rows[seed] = rows

    def _read(self, path):
        """Seed, origin and lines of a record."""
        named = re.search(r"-seed-(\d+)\.csv$", path.name)
        try:
            with path.open() as file:
                settings = {strategy: dict(one) for strategy, one in dict(json.loads(file.readline().removeprefix("# "))).items()}
                rows = list(csv.DictReader(file))
        except (OSError, ValueError, TypeError) as error:
            raise RecordError(f"{path}: cannot be read as a record: {error}") from error
        fits = all(set(row) == {*KEPT, PAIRS} and None not in row.values() for row in rows)
        if not named or not fits or set(settings) != set(self.strategies):
            raise RecordError(f"{path}: is not a record of this version, with the settings of each strategy; move it away")
        seed = int(named[1])
        keys = {(row["scene"], row["strategy"]) for row in rows if row["seed"] == str(seed) and row["strategy"] in self.strategies}
        if not len(keys) == len(rows) == self.scenes * len(self.strategies):
            raise RecordError(f"{path}: has {len(rows)} lines, {len(keys)} of them for its seed and without repetition, in place of "
                              f"{self.scenes} scenes with {len(self.strategies)} strategies; move it away")
        origin = Origin(settings)
        if differing := [text for row in rows for text in origin.add(Origin(hashes={row["scene"]: row["scene_hash"]}))]:
            raise RecordError(f"{path}: {'; '.join(differing)}; move it away")
        return seed, origin, rows

    def seeds(self):
        return sorted(self.rows)

    def count(self):
        """Number of runs that are recorded."""
        return sum(map(len, self.rows.values()))

    def check(self, runs):
        """Refuses runs that do not belong together, or to the records. Returns their origin."""
        origin, differing = Origin.of(runs)
        differing += self.origin.differences(origin)
        if differing:
            raise RecordError(f"{self.kind}: runs do not belong together, or not to the records in {self.folder}: "
                              f"{'; '.join(differing)}; move the records or the campaign away")
        return origin

    def add_whole_seeds(self, campaign):
        """Writes a record of each seed that a campaign has of all scenes and strategies."""
        figures = read_tables(campaign, self.strategies)
        origin = self.check(figures.runs)
        for seed in sorted({int(run["seed"]) for run in figures.runs} - set(self.rows)):
            rows = rows_of(figures, seed)
            if len(rows) != self.scenes * len(self.strategies):
                continue
            self.origin.add(origin)
            self.folder.mkdir(parents=True, exist_ok=True)
            path = self.folder / f"{self.kind}-seed-{seed:02}.csv"
            unfinished = path.with_suffix(".part")
            with unfinished.open("w") as file:
                file.write(f"# {json.dumps(self.origin.settings, sort_keys=True)}\n")
                writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
            unfinished.rename(path)
            self.rows[seed] = rows

    def with_runs_of(self, campaign):
        """Figures of all records, and of the seeds that the campaign has beside them."""
        here = read_tables(campaign, self.strategies)
        self.check(here.runs)
        runs = [run for run in here.runs if int(run["seed"]) not in self.rows]
        views = [view for view in here.views if int(view["seed"]) not in self.rows]
        for row in (row for rows in self.rows.values() for row in rows):
            runs.append({**row, "noise": NOISE})
            for number, pair in enumerate(row[PAIRS].split(), 1):
                gain, observed = pair.split(":")
                views.append({"scene": row["scene"], "strategy": row["strategy"], "noise": NOISE, "seed": row["seed"],
                              "number": str(number), "gain": gain, "gain_observed": observed})
        return Figures(runs, views)

    def differences(self, seed, campaign, scenes):
        """Tells how runs of these scenes that were done again differ from the record, a text each."""
        figures = read_tables(campaign, self.strategies)
        origin, found = Origin.of(figures.runs)
        found += self.origin.differences(origin)
        recorded = {(row["scene"], row["strategy"]): row for row in self.rows[seed]}
        again = {(row["scene"], row["strategy"]): row for row in rows_of(figures, seed)}
        for (scene, strategy), row in again.items():
            if (scene, strategy) not in recorded:
                found.append(f"{scene}, {strategy}: is not recorded")
                continue
            then = recorded[scene, strategy]
            found += [f"{scene}, {strategy}: {name} {then[name]}, now {value}" for name, value in row.items()
                      if name not in NOT_FIGURES and then[name] != value]
        return found + [f"{scene}, {strategy}: was not run" for scene in scenes for strategy in self.strategies
                        if (scene, strategy) not in again]

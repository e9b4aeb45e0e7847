#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The headline figures: a hundred scenes, ten seeds, five strategies: evidence_headline.py PROGRAM FOLDER DOCUMENT [table].

Two campaigns of 5,000 runs, each in a folder of its own under FOLDER, with its page (index.html). They grow seed by
seed, so that an interrupted campaign has whole seeds of all scenes; the same call goes on. A seed that is whole is recorded
beside DOCUMENT (evidence_records.py) and is not run again, on no machine; "check" in place of "table" runs the first and the last
scene of each record again, and compares. Where a cluster answers
(`sinfo`), a campaign is submitted to Slurm as a job array, and a later call merges what its tasks have done; as long as no
cluster answers that call, nothing runs. With "table", nothing runs. DOCUMENT gets the figures of the runs that are there, and
says how many they are.
Exit status 0: complete, and all that is held to was met; 1: something was missed; 2: a campaign failed, or a record differs; 3: not
complete.
SACCADE_HEADLINE_SEEDS: how many seeds (10). SACCADE_SLURM=off: runs here although a cluster answers.
SACCADE_SLURM_OPTIONS: further options of `compare --slurm`, as "--partition long --time 2:00:00"."""
import json
import math
import os
import pathlib
import shlex
import statistics
import subprocess
import sys

from evidence_campaign import (INTERRUPTED, STILL_QUEUED, awaits_cluster, cluster_answers, failed_slices, has_begun, has_shards,
                               jobs_in, may_be_submitted, note_submission, print_awaiting, print_failed, slurm_options,
                               submitted_file)
from evidence_planner import Figures, Held, calibration, student_t
from evidence_records import Records

FIRST_SCENE = 201
SCENES = 100
SEEDS = 10
STRATEGIES = ("surface", "oracle", "sphere", "standard", "attention")
CAMPAIGNS = {"arm": ("The arm", ["--robot", "comau"]), "flying": ("A flying camera", [])}
FIGURES = (("coverage", "coverage, %", 100, 1), ("coverage_area", "its area, %", 100, 1),
           ("unknown_near_objects", "unknown near objects", 1, 0), ("views", "views", 1, 2))


def options(kind, seeds, scenes=f"clutter:{FIRST_SCENE}-{FIRST_SCENE + SCENES - 1}"):
    return ["--scenes", scenes, "--strategies", ",".join(STRATEGIES), "--seeds", ",".join(map(str, seeds)), "--max-views", "5",
            *CAMPAIGNS[kind][1]]


def compare(program, folder, arguments):
    """@return whether it ended well, and what it said."""
    folder.mkdir(parents=True, exist_ok=True)
    command = [program, "--quiet", "compare", *arguments, "--out", str(folder / "campaign")]
    print(f"  {shlex.join(command)}", flush=True)
    with (folder / "log.txt").open("a+") as log:
        begin = log.seek(0, os.SEEK_END)
        status = subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, check=False).returncode
        log.seek(begin)
        said = log.read()
    if status in INTERRUPTED:
        sys.exit(status)
    return status == 0, said


def is_free_here(program, folder, kind, seeds):
    """Whether a campaign may be run here: merges its shards, and tells of one that a cluster may be at work on. None where that failed."""
    campaign, wanted = folder / "campaign", options(kind, seeds)
    if may_be_submitted(campaign):
        status = status_of(program, folder, wanted) if has_begun(campaign) else {}
        if status is None:
            return None
        if awaits_cluster(campaign, status.get("runs")):
            print_awaiting(campaign)
            return False
    elif has_shards(campaign) and not compare(program, folder, [*wanted, "--merge"])[0]:
        return None
    return True


def run_on_cluster(program, folder, kind, seeds):
    """Returns false where the campaign failed."""
    campaign, wanted, merged = folder / "campaign", options(kind, seeds), 0
    if has_shards(campaign) and not compare(program, folder, [*wanted, "--merge"])[0]:
        return False
    if has_begun(campaign):
        status = status_of(program, folder, wanted)
        if status is None:
            return False
        merged = status["runs"]["merged"]
        if failed := failed_slices(campaign, status):
            print_failed(failed)
            return False
    if done_in(folder, seeds) == SCENES * len(STRATEGIES) * len(seeds):
        submitted_file(campaign).unlink(missing_ok=True)
        return True
    submitted, said = compare(program, folder, [*wanted, "--slurm", *slurm_options()])
    if submitted:
        note_submission(campaign, merged, jobs_in(said))
        return True
    return STILL_QUEUED in (said.rstrip().splitlines() or [""])[-1]


def status_of(program, folder, arguments):
    """The result of --status; None where it failed."""
    command = [program, "--quiet", "compare", *arguments, "--status", "--json", "-", "--out", str(folder / "campaign")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode in INTERRUPTED:
        sys.exit(done.returncode)
    if done.returncode:
        with (folder / "log.txt").open("a") as log:
            log.write(done.stderr)
        return None
    return json.loads(done.stdout)["result"]


def done_in(folder, seeds):
    """How many runs of these seeds the tables of a campaign have."""
    if not (folder / "campaign/runs.csv").exists():
        return 0
    return sum(int(run["seed"]) in seeds for run in Figures(folder / "campaign", STRATEGIES).runs)


def interval(values):
    """Mean over scenes, and the half width of its 95 % interval."""
    if len(values) < 2:
        return (values[0] if values else math.nan), math.inf
    return statistics.mean(values), student_t(len(values) - 1) * statistics.stdev(values) / math.sqrt(len(values))


def means(figures):
    lines = ["| strategy | " + " | ".join(title for _, title, _, _ in FIGURES) + " | rank correlation | kept, median |",
             "|---|" + "---|" * (len(FIGURES) + 2)]
    for strategy in STRATEGIES:
        cells = []
        for figure, _, times, digits in FIGURES:
            mean, half = interval(list(figures.by_scene(strategy, figure).values()))
            cells.append(f"{times * mean:,.{digits}f} ± {times * half:,.{digits}f}")
        pairs = [pair for views in figures.promises(strategy).values() for pair in views]
        cells += ["–"] * 2 if strategy == "oracle" else [f"{value:.2f}" for value in calibration(pairs)]
        lines.append(f"| `{strategy}` | " + " | ".join(cells) + " |")
    return lines


def differences(figures):
    lines = ["| surface beside | " + " | ".join(title for _, title, _, _ in FIGURES) + " | scenes with more area |",
             "|---|" + "---|" * (len(FIGURES) + 1)]
    for other in STRATEGIES[1:]:
        cells = []
        for figure, _, times, digits in FIGURES:
            mean, half = figures.gap("surface", other, figure)
            differs = "**" if abs(mean) > half else ""
            cells.append(f"{differs}{times * mean:+,.{digits + 1}f} ± {times * half:,.{digits + 1}f}{differs}")
        ours, theirs = (figures.by_scene(strategy, "coverage_area") for strategy in ("surface", other))
        both = [scene for scene in ours if scene in theirs]
        cells.append(f"{sum(ours[scene] > theirs[scene] for scene in both)} of {len(both)}")
        lines.append(f"| `{other}` | " + " | ".join(cells) + " |")
    return lines


def hold(figures, so_far):
    held = Held(so_far)
    gap, half = figures.gap("surface", "oracle", "coverage")
    held.to("coverage beside the oracle's, points, low end of the interval", 100 * (gap - half), -0.5, True)
    held.to("area as a share of the oracle's",
            figures.mean("surface", "coverage_area") / figures.mean("oracle", "coverage_area"), 0.98, True, 3,
            half=figures.ratio_half_width("surface", "oracle", "coverage_area"))
    held.to("unknown near objects, as a multiple of the oracle's",
            figures.mean("surface", "unknown_near_objects") / figures.mean("oracle", "unknown_near_objects"), 1.3, False,
            half=figures.ratio_half_width("surface", "oracle", "unknown_near_objects"))
    for other in STRATEGIES[2:]:
        gap, half = figures.gap("surface", other, "coverage_area")
        held.to(f"area beside {other}'s, points, low end of the interval", 100 * (gap - half), 0.0, True)
    return held


def section(kind, folder, records, seeds):
    """Lines of the document, how many limits were missed, and whether runs are missing."""
    title, _ = CAMPAIGNS[kind]
    command = " ".join(options(kind, range(1, seeds + 1))).replace(",".join(map(str, range(1, seeds + 1))), f"1-{seeds}")
    lines = [f"## {title}", "", "```sh", f"saccade compare {command} --out DIR", "```", ""]
    figures = records.with_runs_of(folder / "campaign")
    if not figures.runs:
        return [*lines, "Not run yet.", ""], 0, True
    done = {}
    for entry in figures.runs:
        done.setdefault((entry["scene"], entry["seed"]), set()).add(entry["strategy"])
    whole = {key for key, strategies in done.items() if len(strategies) == len(STRATEGIES)}
    figures.runs = [entry for entry in figures.runs if (entry["scene"], entry["seed"]) in whole]
    figures.views = [view for view in figures.views if (view["scene"], view["seed"]) in whole]
    if len({scene for scene, _ in whole}) < 2:
        return [*lines, f"{len(whole)} pairs of a scene and a seed so far: too few for figures.", ""], 0, True
    count, scenes = len(figures.runs), len({scene for scene, _ in whole})
    planned = SCENES * seeds * len(STRATEGIES)
    held = hold(figures, so_far=count < planned)
    names = ", ".join(sorted({seed for _, seed in whole}, key=int))
    lines += [f"{count:,} of {planned:,} runs: {scenes} scenes, {len(whole) / scenes:.1f} seeds each. Seeds: {names}.", "",
              *means(figures), "", *differences(figures), "", *held.lines, ""]
    return lines, held.missed, count < planned


def run_here(program, folder, wanted, records):
    """Seed by seed, so that all campaigns grow together. Returns those that failed."""
    free = {kind: is_free_here(program, folder / kind, kind, seeds) for kind, seeds in wanted.items()}
    failed = [kind for kind, is_free in free.items() if is_free is None]
    for upto in range(1, 1 + max(map(len, wanted.values()), default=0)):
        for kind, seeds in wanted.items():
            if not free[kind] or kind in failed or len(seeds) < upto:
                continue
            if not compare(program, folder / kind, options(kind, seeds[:upto]))[0]:
                failed.append(kind)
            records[kind].add_whole_seeds(folder / kind / "campaign")
    return failed


def run(program, folder, records, seeds):
    """Runs what is not recorded. Returns the campaigns that failed."""
    wanted = {}
    for kind in CAMPAIGNS:
        records[kind].add_whole_seeds(folder / kind / "campaign")
        wanted[kind] = [seed for seed in range(1, seeds + 1) if seed not in records[kind].seeds()]
    wanted = {kind: of_kind for kind, of_kind in wanted.items() if of_kind}
    if not cluster_answers():
        return run_here(program, folder, wanted, records)
    return [kind for kind, of_kind in wanted.items() if not run_on_cluster(program, folder / kind, kind, of_kind)]


def check(program, folder, records):
    """Runs the first and the last scene of each record again. Returns false where a figure differs."""
    same = True
    for kind in CAMPAIGNS:
        for seed in records[kind].seeds():
            home = folder / f"check-{kind}-{seed}"
            if not compare(program, home, options(kind, [seed], f"clutter:{FIRST_SCENE},clutter:{FIRST_SCENE + SCENES - 1}"))[0]:
                return False
            different = records[kind].differences(seed, home / "campaign")
            print(f"  {kind}, seed {seed}: {'as recorded' if not different else 'differs: ' + '; '.join(different)}", flush=True)
            same = same and not different
    return same


def main():
    program, folder, document, *rest = sys.argv[1:]
    folder = pathlib.Path(folder)
    seeds = int(os.environ.get("SACCADE_HEADLINE_SEEDS", SEEDS))
    records = {kind: Records(pathlib.Path(document).with_suffix(""), kind, STRATEGIES, SCENES) for kind in CAMPAIGNS}
    if rest == ["check"]:
        return 0 if check(program, folder, records) else 2
    failed = [] if rest == ["table"] else run(program, folder, records, seeds)
    incomplete, missed = [], 0
    lines = ["# The headline figures", "",
             "Written by `make evidence` (`scripts/evidence_headline.py`). A hundred scenes of random clutter that nothing was chosen by, "
             "the noise of a Kinect v1, five views after the initial scan. Each scene counts once, with the mean of its seeds; "
             "± is half of the 95 % interval over scenes. Differences are paired by scene; bold ones differ from 0 by the paired "
             "t-test at 5 %, each by itself: nothing is corrected for the number of comparisons. Intervals of ratios are by the delta "
             "method on paired scenes; the ratio itself is held to its limit, not an end of its interval. While runs are missing, "
             "met and missed are said \"so far\". Seeds that are whole are kept run by run in [headline/](headline). [Metrics](../reference/metrics.md), [strategies](../guides/exploration.md).", ""]
    for kind in CAMPAIGNS:
        records[kind].add_whole_seeds(folder / kind / "campaign")
        told, missed_here, unfinished = section(kind, folder / kind, records[kind], seeds)
        if unfinished:
            incomplete.append(kind)
        lines += told
        missed += missed_here
    pathlib.Path(document).write_text("\n".join(lines).rstrip() + "\n")
    print(f"  {document}: {missed} missed; failed: {', '.join(failed) or 'none'}; not complete: {', '.join(incomplete) or 'none'}")
    return 2 if failed else 1 if missed else 3 if incomplete else 0


if __name__ == "__main__":
    sys.exit(main())

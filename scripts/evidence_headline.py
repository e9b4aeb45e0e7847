#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The headline figures: a hundred scenes, ten seeds, five strategies: evidence_headline.py PROGRAM FOLDER DOCUMENT [table].

Two campaigns of 5,000 runs, each in a folder of its own under FOLDER, with its page (index.html). They grow seed by
seed, so that an interrupted campaign has whole seeds of all scenes; the same call goes on. A seed that is whole is recorded
beside DOCUMENT (evidence_records.py) and is not run again, on no machine; "check" in place of "table" runs the first and the last
scene of each record again, in a folder of their own, and compares. Where a cluster answers
(`sinfo`), a campaign is submitted to Slurm as a job array, and a later call merges what its tasks have done; as long as no
cluster answers that call, nothing runs. With "table", nothing runs. DOCUMENT gets the figures of the runs that are there, and
says how many they are.
Exit status 0: complete, and all that is held to was met; 1: something was missed; 2: a campaign failed, a record differs or has other
settings than the runs, or there is none to check; 3: not complete.
SACCADE_HEADLINE_SEEDS: how many seeds (10). SACCADE_SLURM=off: runs here although a cluster answers.
SACCADE_SLURM_OPTIONS: further options of `compare --slurm`, as "--partition long --time 2:00:00"."""
import enum
import json
import math
import os
import pathlib
import shlex
import shutil
import statistics
import subprocess
import sys

from evidence_campaign import (INTERRUPTED, STILL_QUEUED, awaits_cluster, cluster_answers, failed_slices, has_begun, has_shards,
                               jobs_in, may_be_submitted, note_submission, print_awaiting, print_failed, slurm_options,
                               submitted_file)
from evidence_planner import Figures, Held, calibration, student_t
from evidence_records import RecordError, Records

FIRST_SCENE = 201
SCENES = 100
LAST_SCENE = FIRST_SCENE + SCENES - 1
SEEDS = 10
STRATEGIES = ("surface", "oracle", "sphere", "standard", "attention")
CAMPAIGNS = {"arm": ("The arm", ["--robot", "comau"]), "flying": ("A flying camera", [])}
FIGURES = (("coverage", "coverage, %", 100, 1), ("coverage_area", "its area, %", 100, 1),
           ("unknown_near_objects", "unknown near objects", 1, 0), ("views", "views", 1, 2))


class Here(enum.Enum):
    """Answers to whether a campaign may be run on this machine."""
    FREE = enum.auto()
    AWAITS_CLUSTER = enum.auto()
    FAILED = enum.auto()


def seeds_text(seeds):
    """Seeds in order, those without a gap between them as a range: "1-3,7"."""
    ranges = []
    for seed in sorted(seeds):
        if ranges and ranges[-1][1] == seed - 1:
            ranges[-1][1] = seed
        else:
            ranges.append([seed, seed])
    return ",".join(str(first) if first == last else f"{first}-{last}" for first, last in ranges)


def options(kind, seeds, scenes=f"clutter:{FIRST_SCENE}-{LAST_SCENE}"):
    """Options of compare.

    @param seeds  as --seeds takes them"""
    return ["--scenes", scenes, "--strategies", ",".join(STRATEGIES), "--seeds", seeds, "--max-views", "5", *CAMPAIGNS[kind][1]]


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


def wanted_seeds(records, seeds):
    """Seeds that are not recorded."""
    return [seed for seed in range(1, seeds + 1) if seed not in records.seeds()]


def merge(program, folder, kind, records, seeds):
    """Merges shards, and records seeds that are whole by that. Returns whether it ended well."""
    every = range(1, 1 + max(seeds, SEEDS, *records.seeds()))  # a shard with none of the seeds that are named is refused
    ended_well, _ = compare(program, folder, [*options(kind, seeds_text(every)), "--merge"])
    if ended_well:
        records.add_whole_seeds(folder / "campaign")
    return ended_well


def state_here(program, folder, kind, records, seeds):
    """Merges shards of a campaign where no cluster is at work on it. Returns whether it may be run here."""
    campaign = folder / "campaign"
    if may_be_submitted(campaign):
        wanted = options(kind, seeds_text(wanted_seeds(records, seeds)))
        status = status_of(program, folder, wanted) if has_begun(campaign) else {}
        if status is None:
            return Here.FAILED
        if awaits_cluster(campaign, status.get("runs")):
            print_awaiting(campaign)
            return Here.AWAITS_CLUSTER
    elif has_shards(campaign) and not merge(program, folder, kind, records, seeds):
        return Here.FAILED
    return Here.FREE


def run_on_cluster(program, folder, kind, records, seeds):
    """Returns false where the campaign failed."""
    campaign = folder / "campaign"
    if has_shards(campaign) and not merge(program, folder, kind, records, seeds):
        return False
    wanted = wanted_seeds(records, seeds)
    if not wanted:
        return True
    # Slices are those of the seeds that were submitted, so that the status is of these alone; recorded runs have left the plan.
    arguments, recorded, merged = options(kind, seeds_text(wanted)), records.count(), 0
    if has_begun(campaign):
        status = status_of(program, folder, arguments)
        if status is None:
            return False
        merged = status["runs"]["merged"]
        if failed := failed_slices(campaign, status, recorded):
            print_failed(failed)
            return False
    submitted, said = compare(program, folder, [*arguments, "--slurm", *slurm_options()])
    if submitted:
        note_submission(campaign, recorded + merged, jobs_in(said))
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
    command = shlex.join(options(kind, seeds_text(range(1, seeds + 1))))
    lines = [f"## {title}", "", "```sh", f"saccade compare {command} --out DIR", "```", ""]
    every = records.with_runs_of(folder / "campaign")
    done = {}
    for entry in every.runs:
        if 1 <= int(entry["seed"]) <= seeds:
            done.setdefault((entry["scene"], entry["seed"]), set()).add(entry["strategy"])
    if not done:
        return [*lines, "Not run yet.", ""], 0, True
    whole = {key for key, strategies in done.items() if len(strategies) == len(STRATEGIES)}
    figures = Figures(*([one for one in table if (one["scene"], one["seed"]) in whole] for table in (every.runs, every.views)))
    if len({scene for scene, _ in whole}) < 2:
        return [*lines, f"{len(whole)} pairs of a scene and a seed so far: too few for figures.", ""], 0, True
    count, scenes = len(figures.runs), len({scene for scene, _ in whole})
    planned = SCENES * seeds * len(STRATEGIES)
    held = hold(figures, so_far=count < planned)
    names = ", ".join(sorted({seed for _, seed in whole}, key=int))
    lines += [f"{count:,} of {planned:,} runs: {scenes} scenes, {len(whole) / scenes:.1f} seeds each. Seeds: {names}.", "",
              *means(figures), "", *differences(figures), "", *held.lines, ""]
    return lines, held.missed, count < planned


def run_here(program, folder, records, seeds):
    """Seed by seed, so that all campaigns grow together. Returns those that failed."""
    states = {kind: state_here(program, folder / kind, kind, records[kind], seeds) for kind in CAMPAIGNS
              if wanted_seeds(records[kind], seeds)}
    failed = [kind for kind, state in states.items() if state is Here.FAILED]
    wanted = {kind: wanted_seeds(records[kind], seeds) for kind, state in states.items() if state is Here.FREE}
    for upto in range(1, 1 + max(map(len, wanted.values()), default=0)):
        for kind, of_kind in wanted.items():
            if kind in failed or len(of_kind) < upto:
                continue
            if not compare(program, folder / kind, options(kind, seeds_text(of_kind[:upto])))[0]:
                failed.append(kind)
            records[kind].add_whole_seeds(folder / kind / "campaign")
    return failed


def run(program, folder, records, seeds):
    """Runs what is not recorded. Returns the campaigns that failed."""
    for kind in CAMPAIGNS:
        records[kind].add_whole_seeds(folder / kind / "campaign")
    if cluster_answers():
        failed = [kind for kind in CAMPAIGNS if wanted_seeds(records[kind], seeds)
                  and not run_on_cluster(program, folder / kind, kind, records[kind], seeds)]
    else:
        failed = run_here(program, folder, records, seeds)
    for kind in CAMPAIGNS:
        if not wanted_seeds(records[kind], seeds):
            submitted_file(folder / kind / "campaign").unlink(missing_ok=True)
    return failed


def check(program, folder, records):
    """Runs the first and the last scene of each record again. Returns whether there is one, and nothing differs."""
    scenes = [f"clutter:{FIRST_SCENE}", f"clutter:{LAST_SCENE}"]
    outcomes = []
    for kind, seed in ((kind, seed) for kind in CAMPAIGNS for seed in records[kind].seeds()):
        home = folder / f"check-{kind}-{seed}"
        if home.exists():
            shutil.rmtree(home)  # runs of a check before this one would not be done again
        ended_well, _ = compare(program, home, options(kind, str(seed), ",".join(scenes)))
        different = records[kind].differences(seed, home / "campaign", scenes) if ended_well else [f"not run, see {home / 'log.txt'}"]
        print(f"  {kind}, seed {seed}: {'as recorded' if not different else 'differs: ' + '; '.join(different)}", flush=True)
        if not different:
            shutil.rmtree(home)
        outcomes.append(not different)
    if not outcomes:
        print("  there is no record to check")
    return bool(outcomes) and all(outcomes)


def write_document(program, folder, document, rest):
    """Runs what is asked for. Returns the exit status."""
    seeds = int(os.environ.get("SACCADE_HEADLINE_SEEDS", SEEDS))
    records = {kind: Records(document.with_suffix(""), kind, STRATEGIES, SCENES) for kind in CAMPAIGNS}
    if rest == ["check"]:
        return 0 if check(program, folder, records) else 2
    failed = [] if rest == ["table"] else run(program, folder, records, seeds)
    for kind in CAMPAIGNS:
        records[kind].add_whole_seeds(folder / kind / "campaign")
    kept = document.with_suffix("").name
    link = f"Seeds that are whole are kept run by run in [{kept}/]({kept}). " if any(one.rows for one in records.values()) else ""
    incomplete, missed = [], 0
    lines = ["# The headline figures", "",
             "Written by `make evidence` (`scripts/evidence_headline.py`). A hundred scenes of random clutter that nothing was chosen by, "
             "the noise of a Kinect v1, five views after the initial scan. Each scene counts once, with the mean of its seeds; "
             "± is half of the 95 % interval over scenes. Differences are paired by scene; bold ones differ from 0 by the paired "
             "t-test at 5 %, each by itself: nothing is corrected for the number of comparisons. Intervals of ratios are by the delta "
             "method on paired scenes; the ratio itself is held to its limit, not an end of its interval. While runs are missing, "
             "met and missed are said \"so far\". "
             f"{link}[Metrics](../reference/metrics.md), [strategies](../guides/exploration.md).", ""]
    for kind in CAMPAIGNS:
        told, missed_here, unfinished = section(kind, folder / kind, records[kind], seeds)
        if unfinished:
            incomplete.append(kind)
        lines += told
        missed += missed_here
    document.write_text("\n".join(lines).rstrip() + "\n")
    print(f"  {document}: {missed} missed; failed: {', '.join(failed) or 'none'}; not complete: {', '.join(incomplete) or 'none'}")
    return 2 if failed else 1 if missed else 3 if incomplete else 0


def main():
    program, folder, document, *rest = sys.argv[1:]
    try:
        return write_document(program, pathlib.Path(folder), pathlib.Path(document), rest)
    except RecordError as error:
        print(error, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())

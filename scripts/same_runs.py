#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tells whether two versions of the program choose the same views and make the same maps.

    scripts/same_runs.py run PROGRAM FILE [--set small|full] [--threads N] [--only TEXT]
    scripts/same_runs.py compare FILE FILE

`run` explores strategies × scenes × seeds × {free, arm} with coarse maps and few views, each once as a whole and once
interrupted and resumed, and updates and compares a few scenes. It writes one line of JSON per run: the result without
times, and the SHA-256 of the map. Runs that are in FILE already are not repeated. `compare` names every difference;
exit status 1 when there is one, or when there was nothing to compare."""
import argparse
import csv
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile

STRATEGIES = ["attention", "standard", "sphere", "random", "random-contours", "oracle"]
SCENES = ["tabletop-1", "tabletop-2", "tabletop-3", "tabletop-4", "clutter:1", "clutter:2", "clutter:3", "clutter:4"]
COARSE = ["--voxel-size", "0.012", "--gain-width", "80"]
VIEWS = ["--max-views", "3"]
# Keys in which two runs of one program differ.
TIMES = {"ms", "phases_s", "timings_ms", "out", "campaign", "seconds", "finished_at", "program_version"}


def explorations(scenes, seeds, strategies, robots):
    for scene in scenes:
        for seed in seeds:
            for strategy in strategies:
                for robot in robots:
                    for way in ["whole", "resumed"]:
                        yield ("explore", scene, strategy, robot, str(seed), way)


def runs_of(chosen):
    if chosen == "small":
        for strategy in STRATEGIES:
            robot = "comau" if strategy in ("attention", "sphere", "random") else "free"
            yield from explorations(["tabletop-2"], [1], [strategy], [robot])
        yield ("explore", "tabletop-1", "standard", "comau", "2", "good-enough")
        yield ("update", "bottle", "viewpoints", "free", "1", "")
        yield ("update", "jug", "motion", "comau", "1", "")
        yield ("compare", "clutter:1", "attention,random-contours,oracle", "free", "1", "")
        return
    yield from explorations(SCENES, [1, 2], STRATEGIES, ["free", "comau"])
    for scene in SCENES:
        for strategy in ["attention", "standard", "sphere"]:
            yield ("explore", scene, strategy, "comau", "2", "good-enough")
    for scene in ["bottle", "jug"]:
        for when, robot in [("viewpoints", "free"), ("viewpoints", "comau"), ("motion", "comau")]:
            yield ("update", scene, when, robot, "1", "")
    for robot in ["free", "comau"]:
        yield ("compare", "clutter:1,tabletop-1", ",".join(STRATEGIES), robot, "1", "")


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(inner) for key, inner in value.items() if key not in TIMES}
    if isinstance(value, list):
        return [without_times(inner) for inner in value]
    return value


def call(command, given=None):
    done = subprocess.run(command, input=given, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 5):
        sys.exit(f"{' '.join(command)}\n{done.stderr}status {done.returncode}")


def result_of(folder, name):
    return without_times(json.loads((folder / name).read_text())["result"])


def record_of(folder, name):
    digest = hashlib.sha256((folder / "map.sacmap").read_bytes()).hexdigest()
    return {"result": result_of(folder, name), "map": digest}


def explore(program, folder, run):
    _, scene, strategy, robot, seed, way = run
    command = program + ["explore", scene, "--strategy", strategy, "--robot", robot, "--seed", seed, "--no-pictures"]
    command += COARSE + (["--good-enough", "0.8"] if way == "good-enough" else [])
    if way != "resumed":
        call(command + VIEWS + ["--out", str(folder)])
        return record_of(folder, "run.json")
    # The answers end after the second view; the run stops there, and is gone on with.
    scanned = folder.parent / "scanned"
    call(command + ["--out", str(scanned), "--max-views", "0"])
    moves = result_of(scanned, "run.json")["initial"]["views"] + 2
    call(command + VIEWS + ["--out", str(folder), "--step"], "y\n" * moves)
    if (folder / "journal.json").exists():
        call(command + VIEWS + ["--out", str(folder), "--resume"])
    return record_of(folder, "run.json")


def update(program, folder, run):
    _, scene, when, robot, seed, _ = run
    call(program + ["update", "--scene", scene, "--fuse-when", when, "--robot", robot, "--seed", seed, "--no-pictures",
                    "--out", str(folder)] + COARSE + VIEWS)
    return record_of(folder, "update.json")


def compare_strategies(program, folder, run):
    _, scenes, strategies, robot, seed, _ = run
    call(program + ["compare", "--scenes", scenes, "--strategies", strategies, "--robot", robot, "--seeds", seed,
                    "--out", str(folder)] + COARSE + VIEWS)
    tables = {}
    for name in ["runs.csv", "views.csv"]:
        with open(folder / name, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        tables[name] = [{key: text for key, text in row.items() if key not in TIMES and not key.endswith("_ms")}
                        for row in rows]
    return tables


def read(path):
    lines = pathlib.Path(path).read_text(encoding="utf-8").splitlines() if pathlib.Path(path).exists() else []
    entries = [json.loads(line) for line in lines if line]
    return {tuple(entry["run"]): entry["record"] for entry in entries}


def run_all(options):
    program = [str(pathlib.Path(options.program).resolve()), "--threads", str(options.threads), "--quiet"]
    done = read(options.file)
    make = {"explore": explore, "update": update, "compare": compare_strategies}
    for run in runs_of(options.set):
        name = " ".join(run).strip()
        if run in done or (options.only and options.only not in name):
            continue
        with tempfile.TemporaryDirectory() as folder:
            record = make[run[0]](program, pathlib.Path(folder) / "run", run)
        with open(options.file, "a", encoding="utf-8") as file:
            file.write(json.dumps({"run": run, "record": record}) + "\n")
        print(name, flush=True)
    return 0


def differences(a, b, where=""):
    """Paths at which two values differ, with both."""
    if isinstance(a, dict) and isinstance(b, dict):
        for key in sorted(set(a) | set(b)):
            yield from differences(a.get(key), b.get(key), f"{where}.{key}")
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        for i, (in_a, in_b) in enumerate(zip(a, b)):
            yield from differences(in_a, in_b, f"{where}[{i}]")
    elif a != b:
        yield f"{where}: {json.dumps(a)[:80]} != {json.dumps(b)[:80]}"


def compare_files(options):
    first, second = read(options.first), read(options.second)
    common = [run for run in first if run in second]
    different = 0
    for run in common:
        found = list(differences(first[run], second[run]))
        different += bool(found)
        for line in found[:10]:
            print(f"{' '.join(run)}: {line}")
    views = sum(len(first[run].get("result", {}).get("views", [])) for run in common)
    print(f"{len(common)} runs with {views} views compared, {different} differ; "
          f"{len(first) + len(second) - 2 * len(common)} are in one file alone")
    return 1 if different or not common or not views else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    run = commands.add_parser("run")
    run.add_argument("program")
    run.add_argument("file")
    run.add_argument("--set", choices=["small", "full"], default="small")
    run.add_argument("--threads", type=int, default=2)
    run.add_argument("--only")
    compare = commands.add_parser("compare")
    compare.add_argument("first")
    compare.add_argument("second")
    options = parser.parse_args()
    sys.exit(run_all(options) if options.command == "run" else compare_files(options))


if __name__ == "__main__":
    main()

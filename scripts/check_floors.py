#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the ratios between ours and the peers to their floors, bench/floors.json. Fails naming every row that is below.

check_floors.py RESULTS                  what make bench left in a folder, every floor
check_floors.py --run PROGRAMS [GROUP]   measures some of the rows briefly and holds them to the looser floors for that;
                                         PROGRAMS is the folder of bench_*; exit status 77: GROUP is not installed
"""
import pathlib
import subprocess
import sys
import tempfile

from performance import floors
from performance.results import SUFFIX, Results, plain_name

SKIPPED = 77
TRIES = 2


def report(floor, ratio, least):
    """Prints one row; returns whether it holds."""
    held = ratio >= least
    print(f"{'holds' if held else 'BELOW ITS FLOOR'}: {floor['what']}: {ratio:.2f}×, floor {least:g}×")
    return held


def check_results(folder):
    results = Results(folder)
    failed = [f"{row}: {why}" for row, why in results.errors.items()]
    for line in failed:
        print(f"WRONG: {line}")
    for floor in floors.load():
        ratio = floors.ratio_of(floor, results)
        if ratio is not None:
            if not report(floor, ratio, floor["floor"]):
                failed.append(floor["what"])
        elif floors.lacks(floor) or floor["group"] != "own":
            print(f"skipped: {floor['what']}: {floors.lacks(floor) or floor['group'] + ' is not installed'}")
        else:
            print(f"NOT MEASURED: {floor['what']}")
            failed.append(floor["what"])
    return 1 if failed else 0


def benchmarks_of(program):
    """Empty where the program was not built."""
    if not program.exists():
        return set()
    listed = subprocess.run([program, "--benchmark_list_tests"], capture_output=True, text=True, check=True)
    return {plain_name(line.strip()) for line in listed.stdout.splitlines()}


def measure(programs, rows, folder):
    """Runs the rows briefly, those of one program in random order."""
    by_program = {}
    for row in rows:
        program, name = row.split(":", 1)
        by_program.setdefault(program, set()).add(name)
    for program, names in by_program.items():
        out = folder / f"{program}.json"
        subprocess.run([programs / f"bench_{program}", f"--benchmark_filter=^({'|'.join(sorted(names))})({SUFFIX})*$",
                        "--benchmark_min_time=0.05", "--benchmark_repetitions=3",
                        "--benchmark_enable_random_interleaving=true", f"--benchmark_out={out}",
                        "--benchmark_out_format=json"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
    return Results(folder)


def check_briefly(programs, group):
    present = {}
    wanted = [floor for floor in floors.load() if "smoke" in floor and group in (None, floor["group"])]
    failed = False
    measured = 0
    for floor in wanted:
        rows = floors.rows_of(floor)
        for program in {row.split(":", 1)[0] for row in rows}:
            if program not in present:
                present[program] = benchmarks_of(programs / f"bench_{program}")
        missing = [row for row in rows if row.split(":", 1)[1] not in present[row.split(":", 1)[0]]]
        why = floors.lacks(floor) or (f"{floor['group']} is not installed" if missing else None)
        if why and (floors.lacks(floor) or floor["group"] != "own"):
            print(f"skipped: {floor['what']}: {why}")
            continue
        if missing:
            print(f"NOT THERE: {floor['what']}: no benchmark {', '.join(missing)}")
            failed = True
            continue
        measured += 1
        failed = not holds_briefly(programs, floor) or failed
    if failed:
        return 1
    return 0 if measured else SKIPPED


def holds_briefly(programs, floor):
    for tries_left in reversed(range(TRIES)):
        with tempfile.TemporaryDirectory() as folder:
            results = measure(programs, floors.rows_of(floor), pathlib.Path(folder))
        for row, why in results.errors.items():
            print(f"WRONG: {row}: {why}")
        if results.errors:
            return False
        ratio = floors.ratio_of(floor, results, best=True)
        if ratio is None:
            print(f"NOT MEASURED: {floor['what']}")
            return False
        if report(floor, ratio, floor["smoke"]):
            return True
        if tries_left:
            print("measured once more")
    return False


if __name__ == "__main__":
    if len(sys.argv) in (3, 4) and sys.argv[1] == "--run":
        sys.exit(check_briefly(pathlib.Path(sys.argv[2]), sys.argv[3] if len(sys.argv) == 4 else None))
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(check_results(pathlib.Path(sys.argv[1])))

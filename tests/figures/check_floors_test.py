#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/check_floors.py on made-up results: holds, falls below a floor, is not measured, cannot be compared.
Usage: check_floors_test.py SCRIPT"""
import json
import pathlib
import subprocess
import sys
import tempfile

CHECK = pathlib.Path(sys.argv[1])
FLOORS = json.loads((CHECK.parents[1] / "bench" / "floors.json").read_text())["rows"]


def made_up(ratio_of_floor, groups):
    """Benchmarks by program: the peers take `ratio_of_floor` times what the floors ask for."""
    programs = {}
    for floor in FLOORS:
        if floor["group"] not in groups:
            continue
        if "counter" in floor:
            program, name = floor["of"].split(":", 1)
            run = {"real_time": 1.0, floor["counter"]: ratio_of_floor * floor["floor"]}
            programs.setdefault(program, []).append((name, run))
            continue
        program, name = floor["ours"].split(":", 1)
        programs.setdefault(program, []).append((name + "/repeats:3/real_time", {"real_time": 1.0}))
        program, name = floor["peer"].split(":", 1)
        programs.setdefault(program, []).append((name, {"real_time": ratio_of_floor * floor["floor"]}))
    return programs


def check(programs, fields=None):
    with tempfile.TemporaryDirectory() as folder:
        for program, runs in programs.items():
            benchmarks = [{"run_name": name, "run_type": "iteration", "time_unit": "ms", **run, **(fields or {})}
                          for name, run in runs]
            path = pathlib.Path(folder) / f"{program}.json"
            path.write_text(json.dumps({"context": {}, "benchmarks": benchmarks}))
        done = subprocess.run(["/usr/bin/python3", "-B", CHECK, folder], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


def expect(condition, what, output):
    if not condition:
        sys.exit(f"{what}:\n{output}")


ALL = {floor["group"] for floor in FLOORS}
status, output = check(made_up(1.1, ALL))
expect(status == 0 and output.count("holds:") == len(FLOORS), "ratios above their floors fail", output)
status, output = check(made_up(0.9, ALL))
expect(status == 1 and output.count("BELOW ITS FLOOR:") >= 4, "ratios below their floors pass", output)
expect("fusion beside Open3D: 2.43×, floor 2.7×" in output, "the row is not named", output)
status, output = check(made_up(1.1, ALL - {"Open3D"}))
expect(status == 0 and "skipped: fusion beside Open3D: Open3D is not installed" in output, "a missing peer fails", output)
status, output = check(made_up(1.1, ALL - {"own"}))
expect(status == 1 and "NOT MEASURED: evaluation, packets on and off" in output, "our own rows may be missing", output)
status, output = check(made_up(1.1, ALL), {"error_occurred": True, "error_message": "the gains differ"})
expect(status == 1 and "the gains differ" in output, "a wrong result passes", output)
print(f"{len(FLOORS)} floors checked in 5 ways")

#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Loops closed in rooms that the camera comes back to, and none where places look alike: a table of the results of
`saccade fuse --loops`, held to their limits.   Usage: evidence_loops.py FOLDER, with loop_SEED.json and alike_SEED.json"""
import json
import pathlib
import sys

END_M = 0.005     # largest error of the last pose with loops closed
DELAY_MS = 10.0   # longest that closing loops beside the run may delay a frame


def results(folder, kind):
    files = sorted(folder.glob(f"{kind}_[0-9]*.json"), key=lambda file: int(file.stem.split("_")[-1]))
    return [(int(file.stem.split("_")[-1]), json.loads(file.read_text())["result"]) for file in files]


def row(kind, seed, result, open_result):
    loops = result["loops"]
    error = result["trajectory_error_m"]
    before = f"{1e3 * open_result['trajectory_error_m']['last_pose']:.1f}" if open_result else "–"
    delay = "–" if loops["delay_ms_max"] is None else f"{loops['delay_ms_max']:.2f}"
    return (f"| {kind}:{seed} | {result['frames']} | {loops['candidates']} | {loops['closed']} | {before} | "
            f"{1e3 * error['last_pose']:.1f} | {delay} |")


def main():
    folder = pathlib.Path(sys.argv[1])
    wrong = []
    print("| scene | frames | candidates | closures | end without, mm | end, mm | longest delay, ms |\n|---|---|---|---|---|---|---|")
    for kind in ("loop", "online", "alike"):
        open_results = dict(results(folder, "open"))
        for seed, result in results(folder, kind):
            print(row(kind, seed, result, open_results.get(seed) if kind != "alike" else None))
            loops = result["loops"]
            end_m = result["trajectory_error_m"]["last_pose"]
            if kind != "alike" and (loops["closed"] == 0 or end_m > END_M):
                wrong.append(f"{kind}:{seed} has {loops['closed']} closures and ends {1e3 * end_m:.1f} mm off")
            if kind == "alike" and loops["closed"] > 0:
                wrong.append(f"alike:{seed} has {loops['closed']} closures")
            if loops["delay_ms_max"] is not None and loops["delay_ms_max"] > DELAY_MS:
                wrong.append(f"{kind}:{seed} delayed a frame by {loops['delay_ms_max']:.1f} ms")
    print("\n".join(wrong))
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()

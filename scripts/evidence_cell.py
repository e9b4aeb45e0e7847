#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures a simulated real cell: camera and joints are processes of their own, with delay, clocks of their own and faults.

    scripts/evidence_cell.py compare OUT   coverage through the pipes beside the simulation in one process
    scripts/evidence_cell.py faults OUT    each program killed, hung, slowed or lying at random instants
    scripts/evidence_cell.py update OUT    a ball that a hand moves from one random place to another

Runs that are there already are not made again. Figures go to standard output."""
import argparse
import json
import os
import pathlib
import random
import statistics
import subprocess
import sys

try:
    import numpy as np
except ModuleNotFoundError:
    np = None  # needed by `update` alone (Debian: python3-numpy)

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build/release"
ARM_FAULTS = ["hang", "die", "lie", "drift", "slow", "nonsense", "error"]
CAMERA_FAULTS = ["hang", "die", "nonsense", "error"]
# Views of the tabletop scenes, coarse enough that a run takes seconds.
COMMON = ["--voxel-size", "0.01", "--no-pictures", "--quiet", "--frame-on-way", "0.3", "--radius", "0.6"]


def write_cell(folder, scene, arm=(), camera=()):
    """Adds devices to a built-in scene. Its objects are for the simulated camera alone; Saccade knows its fixtures."""
    folder.mkdir(parents=True, exist_ok=True)
    joints = [str(BUILD / "saccade-simulated-arm"), "--state", "state", "--log", "log", "--scene", scene, *arm]
    eyes = [str(BUILD / "saccade-simulated-camera"), "--scene", scene, "--state", "state", "--width", "160",
            "--log", "log", *camera]
    devices = {"arm": {"robot": "comau_smart_six", "speed": 0.5},
               "joints": {"command": " ".join(joints), "watchdog": 0.08, "timeout": 5},
               "camera": {"command": " ".join(eyes), "timeout": 2}}
    keys = "".join(f"{key}: {json.dumps(value)}\n" for key, value in devices.items())
    (folder / "cell.yaml").write_text((ROOT / "scenes" / f"{scene}.yaml").read_text() + keys)
    return folder / "cell.yaml"


def log_of(folder):
    """The first time of each event in a cell's log, and the number of contacts."""
    times = {}
    contacts = 0
    for line in (folder / "log").read_text().splitlines() if (folder / "log").exists() else []:
        at, what = line.split()
        # The arm may have been told to stop before, by an observer; what counts comes after the fault.
        if what != "stop" or "fault" in times:
            times.setdefault(what, float(at))
        contacts += what == "contact"
    return times, contacts


def explore(cell, out, views, *more):
    command = [str(BUILD / "saccade"), "explore", str(cell), "--out", str(out), "--max-views", str(views), "--json", "-",
               *COMMON, *more]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, (json.loads(done.stdout)["result"] if done.stdout else None), done.stderr


def faults(out, count, views, shard):
    rng = random.Random(1)
    rows = []
    for i in range(count):
        of_arm = rng.random() < 0.6
        kind = rng.choice(ARM_FAULTS if of_arm else CAMERA_FAULTS)
        after = rng.uniform(0.2, 6.0) if of_arm else rng.randint(3, 40)
        folder = out / f"fault-{i:03d}"
        result = folder / "result.json"
        if result.exists():
            rows.append(json.loads(result.read_text()))
        if result.exists() or i % shard[1] != shard[0]:
            continue
        fault = ["--fault", kind, "--after", f"{after:.2f}"]
        rate = ["--rate", "2"]
        cell = write_cell(folder, "tabletop-1", (*rate, *fault) if of_arm else rate, () if of_arm else fault)
        (folder / "log").unlink(missing_ok=True)
        status, _, error = explore(cell, folder / "run", views, "--force")
        first, _ = log_of(folder)
        times = {what: at for what, at in first.items() if what in ("fault", "stop")}
        kept = (folder / "run/journal.json").exists() or status == 0
        write_cell(folder, "tabletop-1", rate)
        resumed = status == 0 or explore(cell, folder / "run", views, "--resume" if kept else "--force")[0] == 0
        contacts = log_of(folder)[1]  # also those after it was resumed
        row = {"kind": kind, "of": "arm" if of_arm else "camera", "after": after, "status": status, "kept": kept,
               "resumed": resumed, "contacts": contacts, "error": error.strip(),
               "stop_ms": 1e3 * (times["stop"] - times["fault"]) if {"stop", "fault"} <= times.keys() else None}
        result.write_text(json.dumps(row))
        rows.append(row)
        print(f"{i + 1} of {count}: {row}", file=sys.stderr, flush=True)
    print(f"{len(rows)} faults, {sum(r['kept'] for r in rows)} with what was seen kept, "
          f"{sum(r['resumed'] for r in rows)} complete after --resume; the arm touched something in "
          f"{sum(r['contacts'] > 0 for r in rows)}")
    for who, kinds in (("arm", ARM_FAULTS), ("camera", CAMERA_FAULTS)):
        for kind in kinds:
            those = [r for r in rows if r["of"] == who and r["kind"] == kind]
            stops = [r["stop_ms"] for r in those if r["stop_ms"] is not None]
            told = f"told to stop after {statistics.median(stops):.0f} ms (at most {max(stops):.0f})" if stops else ""
            print(f"{who:7}{kind:10}{len(those):4} runs, {sum(r['status'] != 0 for r in those):4} ended  {told}")


BALL_M = 0.05  # radius of the ball of examples/cell


def ball_points(mesh, at):
    """How many vertices of a mesh lie on a ball that stands on the table at (x, y)."""
    vertices = read_vertices(mesh)
    away = np.linalg.norm(vertices - np.array([*at, BALL_M]), axis=1)
    return int(np.count_nonzero((np.abs(away - BALL_M) < 0.006) & (vertices[:, 2] > 0.02)))


def read_vertices(path):
    """Positions in a binary PLY as Saccade writes it: floats first."""
    data = path.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    sizes = {"float": 4, "uchar": 1, "int": 4, "double": 8}
    count = stride = 0
    inside = False
    for line in head.decode().splitlines():
        words = line.split()
        if words[0] == "element":
            inside = words[1] == "vertex"
            count = int(words[2]) if inside else count
        elif words[0] == "property" and inside:
            stride += sizes[words[1]]
    rows = np.frombuffer(body[:count * stride], np.uint8).reshape(count, stride)
    return rows[:, :12].copy().view("<f4").astype(float)


def update(out, count):
    """A hand moves the ball of examples/cell; the arm looks again, through processes of their own."""
    rng = random.Random(1)
    found = 0
    for i in range(count):
        places = []
        while len(places) < 2:  # clear of parcel and tin, and of each other
            x, y = rng.uniform(-0.25, 0.25), rng.uniform(-0.25, 0.25)
            clear = all(np.hypot(x - a, y - b) > d for a, b, d in [(-0.08, 0.08, 0.2), (0.14, -0.06, 0.13)])
            if clear and all(np.hypot(x - a, y - b) > 0.2 for a, b in places):
                places.append((round(x, 3), round(y, 3)))
        folder = out / f"task-{i:02d}"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "changed").unlink(missing_ok=True)
        scene = (ROOT / "examples/cell/scene.yaml").read_text()
        for name, (x, y) in zip(("scene.yaml", "scene-after.yaml"), places):
            (folder / name).write_text(scene.replace("at: [-0.12, -0.14, 0]", f"at: [{x}, {y}, 0]"))
        (folder / "arm.urdf").write_text((ROOT / "robots/ur_like.urdf").read_text())
        cell = (ROOT / "examples/cell/cell.yaml").read_text()
        (folder / "cell.yaml").write_text(cell.replace("--when changed\n", f"--when changed --seed {i}\n"))
        program = str(BUILD / "saccade")
        calibrated = subprocess.run([program, "calibrate", str(folder / "cell.yaml"), "--quiet", "--json", "-"],
                                    capture_output=True, text=True, check=False)
        if calibrated.returncode != 0:
            print(f"task {i + 1}: not calibrated: {calibrated.stderr.strip()}")
            continue
        result = json.loads(calibrated.stdout)["result"]
        cell = (folder / "cell.yaml").read_text()
        cell = cell.replace("\narm:\n", f"\narm:\n  T_flange_camera: {result['T_flange_camera']}\n")
        cell = cell.replace("\ncamera:\n", f"\ncamera:\n  clock_offset: {result['clock_offset_s'] or 0.0}\n")
        (folder / "cell.yaml").write_text(cell)
        # The map before the task, for the old place of the ball.
        common = ["--force", "--quiet", "--no-pictures"]
        scanned = subprocess.run([program, "explore", str(folder / "cell.yaml"), "--out", str(folder / "before"),
                                  "--max-views", "2", *common], capture_output=True, text=True, check=False)
        run = subprocess.run([program, "update", str(folder / "cell.yaml"), "--map", str(folder / "before/map.sacmap"),
                              "--out", str(folder / "run"), *common], capture_output=True, text=True, check=False)
        if scanned.returncode != 0 or run.returncode != 0:
            print(f"task {i + 1}: {scanned.stderr.strip()} {run.stderr.strip()}")
            continue
        was, is_ = places
        old = [ball_points(folder / mesh / "mesh.ply", was) for mesh in ("before", "run")]
        new = [ball_points(folder / mesh / "mesh.ply", is_) for mesh in ("before", "run")]
        good = new[1] > 100 and new[1] > 10 * new[0] and old[1] < 0.1 * old[0]
        found += good
        print(f"task {i + 1}: ball from {was} to {is_} m; vertices on it at the old place {old[0]} -> {old[1]}, at the new "
              f"place {new[0]} -> {new[1]}: {'found' if good else 'not found'}", flush=True)
    print(f"{found} of {count} tasks: the ball is where it was put, and gone from where it was")


def compare(out, views):
    """Calibrates a cell whose mount is 8 mm and 2° off and whose clocks are 35 ms apart, and explores it then."""
    off = ["--mount", "0.005,-0.004,0.0045,1.2,-1.2,1", "--clock", "-0.035", "--delay", "0.02", "--width", "320"]
    common = [option for option in COMMON if option not in ("--frame-on-way", "0.3")]
    for scene in ("tabletop-1", "tabletop-2", "tabletop-3", "tabletop-4"):
        folder = out / scene
        cell = write_cell(folder, scene, ["--delay", "0.02"], off)
        done = subprocess.run([str(BUILD / "saccade"), "calibrate", str(cell), "--quiet", "--json", "-"],
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            print(f"{scene}: not calibrated: {done.stderr.strip()}")
            continue
        found = json.loads(done.stdout)["result"]
        text = cell.read_text().replace('"robot": "comau_smart_six"',
                                        f'"robot": "comau_smart_six", "T_flange_camera": {found["T_flange_camera"]}')
        clock = found["clock_offset_s"]
        cell.write_text(text.replace('"timeout": 2}', f'"timeout": 2, "clock_offset": {clock or 0.0}}}'))
        here = [str(BUILD / "saccade"), "explore", scene, "--out", str(folder / "here"), "--max-views", str(views),
                "--image-size", "320,240", "--json", "-", "--force", *common]
        there = [str(BUILD / "saccade"), "explore", str(cell), "--truth", "--out", str(folder / "run"), "--max-views",
                 str(views), "--json", "-", "--force", *common]
        covered = []
        for command in (here, there):
            run = subprocess.run(command, capture_output=True, text=True, check=False)
            covered.append(json.loads(run.stdout)["result"]["final"]["coverage"] if run.returncode == 0 else None)
        clock_ms = "none" if clock is None else f"{1e3 * clock:.1f} ms"
        print(f"{scene}: clock {clock_ms}, mount sure to {1e3 * found['translation_sigma_m']:.2f} mm; "
              f"coverage here {covered[0]}, through the pipes {covered[1]}", flush=True)


def main():
    global BUILD
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=["compare", "faults", "update"])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--count", type=int, help="faults (200) or tasks (10)")
    parser.add_argument("--views", type=int, default=5)
    parser.add_argument("--shard", default="0/1", help="I/N: make those faults alone whose number leaves I when divided by N")
    parser.add_argument("--build", type=pathlib.Path, default=BUILD, help="folder of the programs")
    arguments = parser.parse_args()
    BUILD = arguments.build.resolve()
    arguments.out.mkdir(parents=True, exist_ok=True)
    os.environ["PATH"] = f"{BUILD}:{os.environ['PATH']}"
    if arguments.what == "faults":
        faults(arguments.out, arguments.count or 200, arguments.views, [int(n) for n in arguments.shard.split("/")])
    elif arguments.what == "update":
        update(arguments.out, arguments.count or 10)
    else:
        compare(arguments.out, arguments.views)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/results/performance.md and its plots from what scripts/bench.sh left: performance_table.py RESULTS DOCUMENT."""
import json
import os
import pathlib
import re
import subprocess
import sys

from performance import bounds, peers, phases, savings, scaling
from performance.results import Results

PROGRAM = "build/release/saccade"
NOTES = pathlib.Path(__file__).parents[1] / "bench/notes.md"  # results of other machines and other hours
USUAL_REPETITIONS = 7  # default of scripts/bench.sh
PACKAGES = [("libbenchmark-dev", "Google Benchmark"), ("libembree-dev", "Embree"), ("libopen3d-dev", "Open3D"),
            ("libopencv-contrib-dev", "OpenCV"), ("libpcl-dev", "PCL")]


def version(package):
    """Returns the version of a Debian package; None: not installed."""
    asked = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True, check=False)
    return asked.stdout if asked.returncode == 0 and asked.stdout else None


def system():
    """Name of the distribution and version of the kernel."""
    release = pathlib.Path("/etc/os-release")
    names = [line.split("=", 1)[1].strip('"') for line in (release.read_text().splitlines() if release.exists() else [])
             if line.startswith("PRETTY_NAME=")]
    kernel = subprocess.run(["uname", "-s"], capture_output=True, text=True, check=True).stdout.strip()
    return ", ".join([*names, kernel])


def generation():
    """Returns the family and model of the processor, which virtual machines omit from its name."""
    about = pathlib.Path("/proc/cpuinfo")
    family = re.search(r"^cpu family\s*: (\d+)\nmodel\s*: (\d+)$", about.read_text() if about.exists() else "", re.MULTILINE)
    return f" (family {family[1]}, model {family[2]})" if family else ""


def machine(results, repetitions):
    command = "make bench" if repetitions == USUAL_REPETITIONS else f"SACCADE_BENCH_REPETITIONS={repetitions} make bench"
    asked = subprocess.run([PROGRAM, "info", "--json", "-"], capture_output=True, text=True, check=True)
    about = json.loads(asked.stdout)["result"]
    caches = ", ".join(f"L{cache['level']} {cache['size'] // 1024:,} KiB" for cache in results.context.get("caches", [])
                       if cache["type"] in ("Unified", "Data")) or "unknown"
    versions = ", ".join(f"{name} {version(package)}" for package, name in PACKAGES if version(package))
    load = ", ".join(f"{load:.1f}" for load in results.context.get("load_avg", [])) or "unknown"
    simd = os.environ.get("SACCADE_BENCH_SIMD") or about["simd_target"]
    return [f"- Command: `{command}`, {results.context.get('date', 'undated')[:10]}; a Release build.",
            f"- Machine: {about['processor']}{generation()}, {about['cores']} cores, kernels on {simd}; caches {caches}. "
            f"Load at the start: {load}.",
            f"- Versions: {about['compiler']}, oneTBB {about['dependencies']['onetbb']}, {versions}; {system()}.", ""]


def main(folder, document):
    results = Results(folder)
    if not results.times:
        sys.exit(f"{folder} holds no results: run make bench")
    images = document.parent.parent / "images"
    repetitions = max(len(times) for times in results.times.values())
    beside_peers, held = peers.section(results)
    lines = ["# Performance", "",
             f"Written by `make bench`: medians in milliseconds of {repetitions} repetitions, with the fastest and slowest; "
             "ours and",
             "the peers run in one process, on the same data, warm, in random order. Frames are those of the 7-Scenes kitchen",
             "(`bench/frames.cpp`); views look at a table with clutter (`bench/table_map.cpp`). Results are compared before",
             "or while they are timed. Ratios must not fall below `bench/floors.json`, which `make bench` checks at its end",
             "and the tests check loosely.", "", *machine(results, repetitions), *beside_peers, *NOTES.read_text().splitlines(), "",
             *savings.section(results, images),
             *scaling.section(results, images), *phases.section(results), *bounds.section(results),
             *peers.everything(results)]
    document.write_text("\n".join(lines).rstrip() + "\n")
    print(f"written: {document}" + ("" if held else "; some targets are not held"))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))

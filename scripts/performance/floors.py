# SPDX-License-Identifier: Apache-2.0
"""The stored floors of bench/floors.json, and whether results hold them."""
import json
import pathlib
import statistics

FLOORS = pathlib.Path(__file__).resolve().parents[2] / "bench" / "floors.json"


def load():
    return json.loads(FLOORS.read_text())["rows"]


def rows_of(floor):
    """The benchmarks that a floor needs."""
    return [floor["of"]] if "counter" in floor else [floor["ours"], floor["peer"]]


def ratio_of(floor, results, best=False):
    """None where a benchmark is missing. `best`: the fastest repetition of each, else the median."""
    of_times = min if best else statistics.median
    if "counter" in floor:
        values = results.counters.get(floor["of"], {}).get(floor["counter"])
        return None if not values else max(values) if best else statistics.median(values)
    times = [results.times.get(row) for row in rows_of(floor)]
    return of_times(times[1]) / of_times(times[0]) if all(times) else None


def lacks(floor):
    """Why a floor cannot be held to on this machine, or None."""
    needed = floor.get("needs_cpu")
    if needed and needed not in processor_flags():
        return f"the processor has no {needed}"
    return None


def processor_flags():
    path = pathlib.Path("/proc/cpuinfo")
    text = path.read_text() if path.exists() else ""
    flags = next((line for line in text.splitlines() if line.startswith("flags")), "")
    return set(flags.split())

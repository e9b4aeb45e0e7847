# SPDX-License-Identifier: Apache-2.0
"""Results: what the benchmarks left, one file of Google Benchmark per program."""
import json
import pathlib
import re
import statistics

MILLISECONDS = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}
SUFFIX = "/(real_time|manual_time|process_time|(repeats|iterations|min_time):[0-9.]+)"


def plain_name(run_name):
    """Without what Google Benchmark appends."""
    return re.sub(SUFFIX, "", run_name)


class Results:
    """Rows are called program:benchmark."""

    def __init__(self, folder):
        self.times = {}  # ms of every repetition
        self.counters = {}  # name → values of every repetition
        self.errors = {}
        self.context = {}
        for path in sorted(pathlib.Path(folder).glob("*.json")):
            self._read(path)

    def _read(self, path):
        document = json.loads(path.read_text())
        self.context = self.context or document["context"]
        for run in document["benchmarks"]:
            if run["run_type"] != "iteration":
                continue
            row = f"{path.stem}:{plain_name(run['run_name'])}"
            if run.get("error_occurred"):
                self.errors[row] = run["error_message"]
                continue
            self.times.setdefault(row, []).append(run["real_time"] * MILLISECONDS[run["time_unit"]])
            counters = self.counters.setdefault(row, {})
            for name, value in run.items():
                if isinstance(value, float) and name not in ("real_time", "cpu_time"):
                    counters.setdefault(name, []).append(value)

    def median_ms(self, row):
        """None where it was not measured."""
        times = self.times.get(row)
        return statistics.median(times) if times else None

    def counter(self, row, name):
        values = self.counters.get(row, {}).get(name)
        return statistics.median(values) if values else None

    def by_argument(self, prefix):
        """(argument, ms) of the rows program:benchmark/name:argument, ascending."""
        found = []
        for row in self.times:
            match = re.fullmatch(re.escape(prefix) + r"/\w+:(\d+)", row)
            if match:
                found.append((int(match.group(1)), self.median_ms(row)))
        return sorted(found)


def figure(value):
    """Milliseconds, or anything else of that kind, to three digits or so."""
    if value < 0.1:
        return f"{value:.3f}"
    if value < 10:
        return f"{value:.2f}"
    return f"{value:.1f}" if value < 1000 else f"{value:,.0f}"


def spread(times):
    return f"{figure(statistics.median(times))} ({figure(min(times))} to {figure(max(times))})"

#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Sums up what make test ran: skipped tests and why, the slowest tests, phases against their budgets, failures, and last
`N passed, N failed`.

Usage: test_summary.py RESULTS BUDGET. RESULTS is the folder that scripts/test.sh fills, BUDGET is tests/budget.json. Each
phase counts as one more test. Exit status 1 on any failure, and when nothing ran. A phase or a test that takes twice its
budget is reported; one that takes four times its budget fails. Budgets grow with the machine's slowness, of which
machine_speed.txt holds a reading before each phase and one at the end: the slowest counts."""
import json
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

SLOWEST = 40
REPORTED, FAILED = 2.0, 4.0  # times the budget


def reason_of(output):
    """The message of GTEST_SKIP: the line after the one that says where it is."""
    lines = output.splitlines()
    for index, line in enumerate(lines):
        if re.search(r": Skipped$", line) and index + 1 < len(lines):
            return lines[index + 1].strip()
    return "no reason given"


class Tests:
    """Outcomes of all tests, and the processor seconds of those that GoogleTest ran."""

    def __init__(self):
        self.passed, self.failed, self.skipped, self.seconds = 0, [], {}, {}

    def skip(self, name, reason):
        self.skipped.setdefault(reason, []).append(name)

    def read(self, results):
        for path in sorted(results.glob("*.xml")):
            for case in ElementTree.parse(path).getroot().iter("testcase"):
                shard = results / path.stem / f"{case.get('name')}.xml"
                if shard.exists():
                    self.read_shard(path.stem, shard, case)
                else:
                    self.read_case(path.stem, case)

    def read_case(self, phase, case):
        """One test of ctest or Playwright. A shard that crashed has left no file of its own, and counts here."""
        name = f"{phase}: {case.get('name')}"
        output = case.findtext("system-out") or ""
        broken = case.find("failure") is not None or case.find("error") is not None
        status = case.get("status") or ("fail" if broken else "run")  # ctest says it, Playwright does not
        if case.find("skipped") is not None or status == "notrun":
            self.skip(name, reason_of(output))
        elif status == "run":
            self.passed += 1
        else:
            self.failed.append(name)

    def read_shard(self, phase, path, shard):
        """The tests of one process of GoogleTest. One that fails although none of its tests does (a leak that
        AddressSanitizer found at the end, say) is a failure, too."""
        program = path.name.rsplit(".", 2)[0]
        failed_before = len(self.failed)
        for case in ElementTree.parse(path).getroot().iter("testcase"):
            name = f"{phase}: {program}.{case.get('classname')}.{case.get('name')}"
            skipped = case.find("skipped")
            if case.get("status") != "run":
                continue
            if case.find("failure") is not None:
                self.failed.append(name)
            elif skipped is not None:
                self.skip(name, reason_of(f"x: Skipped\n{message_of(skipped)}"))
            else:
                self.passed += 1
            for item in case.iter("property"):
                if item.get("name") == "processor_s":
                    self.seconds[name] = float(item.get("value"))
        if shard.get("status") == "fail" and len(self.failed) == failed_before:
            self.failed.append(f"{phase}: {shard.get('name')}, after its last test")


def message_of(skipped):
    """GoogleTest 1.12 writes file, line and message; only the message is of interest."""
    text = (skipped.get("message") or skipped.text or "").strip()
    return text.splitlines()[-1] if text else ""


def cache_of(path):
    """Compilations that the cache answered, and all."""
    if not path.exists():
        return 0, 0
    lines = path.read_text().splitlines()
    hits = sum(line in ("direct_cache_hit", "preprocessed_cache_hit") for line in lines)
    return hits, hits + sum(line == "cache_miss" for line in lines)


def judge(name, took, allowed, unit):
    """Reports what took much longer than it may.  @return it where that is a failure."""
    if took <= REPORTED * allowed:
        return []
    text = f"{name} took {took:.1f} s{unit}; it may take {allowed:.1f} s here (tests/budget.json)"
    if took > FAILED * allowed:
        return [text]
    print(f"Slow: {text}")
    return []


def failed_targets(results, phase):
    """@return what a phase without JUnit results says of its failures, such as the fuzz targets."""
    path = results / f"{phase}-failed.txt"
    return [f"{phase}: {line}" for line in path.read_text().splitlines()] if path.exists() else []


def print_phases(results, budgets, slowness):
    """@return the names of failed phases, those that took four times their budget included."""
    failed, total_s, total_budget = [], 0, 0
    print(f"{'phase':<9}{'build s':>9}{'run s':>7}{'budget':>8}  compiler cache")
    for line in (results / "phases.tsv").read_text().splitlines():
        name, build, run, outcome = line.split("\t")
        hits, compiled = cache_of(results / f"ccache-{name}.log")
        share = hits / compiled if compiled else 1.0
        budget = budgets[name]
        allowed = slowness * (budget["warm_s"] + (1.0 - share) * (budget["cold_s"] - budget["warm_s"]))
        took = int(build) + int(run)
        total_s, total_budget = total_s + took, total_budget + allowed
        note = f"{hits} of {compiled}" if compiled else "-"
        if compiled and share < 0.5:
            note += ": fewer than half"
        print(f"{name:<9}{build:>9}{run:>7}{allowed:>8.0f}  {note}")
        if outcome != "passed":
            failed.append(f"phase {name}")
            failed += failed_targets(results, name)
        else:
            failed += judge(f"phase {name}", took, allowed, "")
    print(f"{'in all':<9}{total_s:>16}{total_budget:>8.0f}")
    return failed


def slow_tests(tests, budget, slowness):
    """@return what took twice its processor time or more, and prints the slowest."""
    release = {name.split(": ", 1)[1]: s for name, s in tests.seconds.items() if name.startswith("release: ")}
    if not release:
        return []
    slowest = sorted(release, key=lambda name: -release[name])[:SLOWEST]
    print(f"The {len(slowest)} tests that took the most processor time, of {sum(release.values()):.0f} s in all:")
    for name in slowest:
        print(f"  {release[name]:6.1f} s  {name}")
    long_tests = budget["long"]
    for name in long_tests:
        if name not in release:
            yield f"{name} is a long test by tests/budget.json, but there is no such test"
    if len(long_tests) > budget["most_long"]:
        yield f"{len(long_tests)} long tests in tests/budget.json; at most {budget['most_long']}"
    for name in slowest:
        allowed = slowness * budget["long_s" if name in long_tests else "test_s"]
        yield from judge(name, release[name], allowed, " of processor time")


def main():
    results, budget = pathlib.Path(sys.argv[1]), json.loads(pathlib.Path(sys.argv[2]).read_text())
    speeds = [float(text) for text in (results / "machine_speed.txt").read_text().split()]
    slowness = max(1.0, *speeds)
    tests = Tests()
    tests.read(results)
    for reason, names in tests.skipped.items():
        print(f"Skipped, {reason}:")
        for name in names:
            print(f"  {name}")
    failed = tests.failed + list(slow_tests(tests, budget["tests"], slowness))
    print(f"Work takes {min(speeds):.2f} to {max(speeds):.2f} times as long here as where the budgets were measured.")
    phases = (results / "phases.tsv").read_text().splitlines()
    failed_phases = print_phases(results, budget["phases"], slowness)
    failed += failed_phases
    for name in failed:
        print(f"Failed: {name}")
    print(f"{sum(len(names) for names in tests.skipped.values())} skipped")
    print(f"{tests.passed + len(phases) - len(failed_phases)} passed, {len(failed)} failed")
    sys.exit(1 if failed or not tests.passed else 0)


if __name__ == "__main__":
    main()

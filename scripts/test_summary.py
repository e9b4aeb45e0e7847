#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Sums up what make test ran: the skipped tests and why, the failed ones, and last `N passed, N failed`.

Reads the JUnit files that ctest and Playwright left in a folder. Every phase counts as one more test. Exit status 1 on any failure, and
when nothing ran."""
import argparse
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree


def reason_of(output):
    """The message of GTEST_SKIP: the line after the one that says where it is."""
    lines = output.splitlines()
    for index, line in enumerate(lines):
        if re.search(r": Skipped$", line) and index + 1 < len(lines):
            return lines[index + 1].strip()
    return "no reason given"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("--phases", default="")
    parser.add_argument("--failed", default="")
    arguments = parser.parse_args()

    passed, failed, skipped = 0, [], {}
    for path in sorted(arguments.results.glob("*.xml")):
        for case in ElementTree.parse(path).getroot().iter("testcase"):
            name = f"{path.stem}: {case.get('name')}"
            output = case.findtext("system-out") or ""
            broken = case.find("failure") is not None or case.find("error") is not None
            status = case.get("status") or ("fail" if broken else "run")  # ctest says it, Playwright does not
            if case.find("skipped") is not None or status == "notrun":
                skipped.setdefault(reason_of(output), []).append(name)
            elif status == "run":
                passed += 1
            else:
                failed.append(name)
    for reason, names in skipped.items():
        print(f"Skipped, {reason}:")
        for name in names:
            print(f"  {name}")
    for name in failed:
        print(f"Failed: {name}")
    failed_phases = arguments.failed.split()
    for name in failed_phases:
        print(f"Failed: phase {name}")
    count_skipped = sum(len(names) for names in skipped.values())
    phases = len(arguments.phases.split())
    total_failed = len(failed) + len(failed_phases)
    print(f"{count_skipped} skipped")
    print(f"{passed + phases - len(failed_phases)} passed, {total_failed} failed")
    sys.exit(1 if total_failed or not passed else 0)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the arrows between rooms: fails when a room includes another that it does not include in arrows.json, and when
a file includes an internal header of a room it does not belong to.

Usage: check_arrows.py [--write] ROOT. --write stores the arrows of today. check_layers.py says which arrows are allowed at
all; this one keeps their number from growing unseen."""
import json
import pathlib
import re
import sys

import rooms

ARROWS = "tests/layers/arrows.json"
FOLDERS = ["lib", "apps", "tests", "bench", "examples"]
MAY_INCLUDE_INTERNAL = {"tests", "bench", "cuda"}
SOURCES = {".hpp", ".cpp", ".cu", ".cuh"}
MIN_FILES = 5
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"](saccade/[^>"]+)[>"]', re.MULTILINE)


def arrows_of(root):
    """Returns {room: {included room: "file:line: include"}}, violations of the rule for internal headers, and the number of
    files that were read."""
    names = rooms.rooms_of(root)
    arrows, violations, read = {name: {} for name in names}, [], 0
    for name, path in rooms.files_below(root, FOLDERS):
        if path.suffix not in SOURCES:
            continue
        read += 1
        text, place = path.read_text(), rooms.place_of(name, names)
        for include in INCLUDE.finditer(text):
            where = f"{name}:{text.count(chr(10), 0, include.start(1)) + 1}: includes {include[1]}"
            other = rooms.room_of_include(include[1], names)
            if other is None:
                violations.append(f"{where}, which is in no room")
            elif other != place:
                if "internal" in include[1].split("/") and place not in MAY_INCLUDE_INTERNAL:
                    violations.append(f"{where}; internal headers are for {other} and tests alone")
                if place in arrows:
                    arrows[place].setdefault(other, where)
    return arrows, violations, read


def compare(arrows, before):
    """Returns the violations against the arrows before, and notes on those that are gone."""
    violations, notes = [], []
    for room in sorted(set(arrows) | set(before)):
        had, has = set(before.get(room, [])), arrows.get(room, {})
        violations += [f"new arrow {room} → {other}: {has[other]}" for other in sorted(set(has) - had)]
        notes += [f"arrow {room} → {other} is gone" for other in sorted(had - set(has))]
    return violations, notes


def main():
    root = pathlib.Path(sys.argv[-1])
    path = root / ARROWS
    arrows, violations, read = arrows_of(root)
    notes = []
    if sys.argv[1] == "--write":
        lines = (f'  "{room}": {json.dumps(sorted(others))}' for room, others in sorted(arrows.items()))
        path.write_text("{\n" + ",\n".join(lines) + "\n}\n")
    else:
        against, notes = compare(arrows, json.loads(path.read_text()) if path.exists() else {})
        if against:
            against.append("If the new arrows are meant, or rooms have new names: tests/layers/check_arrows.py --write ROOT")
        if notes:
            notes.append("To keep it so: tests/layers/check_arrows.py --write ROOT")
        violations += against
    for line in [*violations, *notes]:
        print(line)
    numbers = ", ".join(f"{room} {len(others)}" for room, others in sorted(arrows.items()))
    print(f"{read} files read, {sum(map(len, arrows.values()))} arrows: {numbers}")
    sys.exit(1 if violations or read < MIN_FILES else 0)


if __name__ == "__main__":
    main()

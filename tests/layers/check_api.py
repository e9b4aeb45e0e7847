#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the list of the library's public names, docs/reference/api.txt, to the headers, so that growth of the API shows in
review.

Usage: check_api.py [--write] ROOT. --write stores the list of today. Public headers are those of the rooms that are
neither in a folder internal nor *-inl.hpp; their names are what declarations.py finds in them."""
import pathlib
import sys

import declarations
import rooms

API = "docs/reference/api.txt"
FIRST_LINES = ["# Public names of the library, by header. Written by tests/layers/check_api.py --write ROOT."]
MIN_NAMES = 3


def names_of(root):
    """Returns {header: ["kind name"]} and violations: headers in which braces do not match."""
    names, violations = {}, []
    room_names = rooms.rooms_of(root)
    for name, path in rooms.files_below(root, [rooms.LIBRARY]):
        header = name[len("lib/"):]
        if path.suffix not in (".hpp", ".cuh") or path.stem.endswith("-inl") or "internal" in header.split("/"):
            continue
        if rooms.room_of_include(header, room_names) is None:
            violations.append(f"{name}: in no room")
        try:
            found = declarations.declarations(path.read_text())
        except declarations.Unbalanced as unbalanced:
            violations.append(f"{name}: {unbalanced}")
            continue
        if found:
            names[header] = [f"{kind} {declared}" for declared, kind in found]
    return names, violations


def text_of(names):
    lines = list(FIRST_LINES)
    for header in sorted(names):
        lines += ["", header, *(f"  {name}" for name in names[header])]
    return "\n".join(lines) + "\n"


def read(text):
    """Returns {header: ["kind name"]} of a list that text_of has written."""
    names, header = {}, None
    for line in text.splitlines():
        if line.startswith("  "):
            names[header].append(line.strip())
        elif line and not line.startswith("#"):
            header = line
            names[header] = []
    return names


def compare(names, before):
    """Returns one line per name that was added, removed or moved to another header."""
    def pairs(of):
        return {(header, name) for header, listed in of.items() for name in listed}
    added, removed = pairs(names) - pairs(before), pairs(before) - pairs(names)
    lines = []
    for header, name in sorted(removed):
        new_headers = sorted(other for other, added_name in added if added_name == name)
        if new_headers:
            lines.append(f"moved: {name}, from {header} to {new_headers[0]}")
            added.remove((new_headers[0], name))
        else:
            lines.append(f"removed: {name} of {header}")
    return lines + [f"added: {name} in {header}" for header, name in sorted(added)]


def main():
    root = pathlib.Path(sys.argv[-1])
    path = root / API
    names, violations = names_of(root)
    if sys.argv[1] == "--write":
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text_of(names))
    else:
        text = path.read_text() if path.exists() else ""
        differences = compare(names, read(text))
        if differences or text != text_of(names):
            differences.append(f"{API} differs from the headers; if that is meant: tests/layers/check_api.py --write ROOT")
        violations += differences
    for violation in violations:
        print(violation)
    number = sum(map(len, names.values()))
    print(f"{len(names)} headers, {number} public names")
    sys.exit(1 if violations or number < MIN_NAMES else 0)


if __name__ == "__main__":
    main()

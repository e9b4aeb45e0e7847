#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the commands of apps/cli to their scaffold: a command neither prints nor names an exit status.

Usage: check_commands.py [--write] ROOT. Prints one line per violation, then what was checked. Files that are not yet
converted stand in commands.json; a file that is listed there and has nothing wrong must leave the list, and none may be
added. --write takes files off the list. Exit status 1 on any violation."""
import json
import pathlib
import re
import sys

import check_layers

LISTED = "tests/layers/commands.json"
# Files that print and end the program on behalf of all commands.
SCAFFOLD = {"command_line.cpp", "exit_status.cpp", "exit_status.hpp", "interrupt.hpp", "json_output.cpp", "main.cpp", "progress_bar.cpp",
            "scaffold.cpp", "serve.cpp", "start_reproduce.cpp"}
FORBIDDEN = re.compile(r"\bstd::(?:cout|cerr)\b|\bExitStatus\b|\bprint_error\s*\(|\binterrupt_status\s*\(|"
                       r"\b(?:std::)?(?:exit|_Exit|abort)\s*\(")


def violations_of(root):
    """Returns the first thing that each command's file must not have, by the file's name."""
    found = {}
    folder = root / "apps" / "cli"
    for path in sorted(folder.rglob("*")):
        if path.suffix not in (".cpp", ".hpp") or path.name in SCAFFOLD:
            continue
        match = FORBIDDEN.search(check_layers.code_only(path.read_text()))
        if match:
            found[path.relative_to(folder).as_posix()] = match.group().strip(" (")
    return found


def main():
    write = "--write" in sys.argv[1:-1]
    root = pathlib.Path(sys.argv[-1])
    listed = set(json.loads((root / LISTED).read_text()))
    found = violations_of(root)
    if write:
        listed &= set(found)
        (root / LISTED).write_text(json.dumps(sorted(listed), indent=2) + "\n")
    failed = 0
    for name in sorted(set(found) - listed):
        failed += 1
        print(f"apps/cli/{name}: has {found[name]}; a command returns an Outcome (command.hpp)")
    for name in sorted(listed - set(found)):
        failed += 1
        print(f"{LISTED}: {name} is converted; take it off the list with --write")
    checked = len(list((root / "apps" / "cli").rglob("*.cpp")))
    print(f"{checked} files checked, {len(listed)} not yet converted, {failed} violations")
    sys.exit(1 if failed or checked < 2 else 0)


if __name__ == "__main__":
    main()

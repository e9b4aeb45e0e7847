#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Counts wordings that are to go, room by room, in comments, messages and docs, and fails when a count rises above
wording.json. Names the places of a pattern in a room whose count rose, and what to write instead.

Usage: check_wording.py [--write | --list] ROOT. --write stores the counts of today, unless the total of a pattern rises;
--list prints every place."""
import collections
import json
import pathlib
import re
import sys

import prose
import rooms

COUNTS = "tests/layers/wording.json"
FOLDERS = ["lib", "apps", "devices", "tests", "bench", "examples", "scripts", "cmake", "web", "docs"]
PAGES = ["README.md", "CONTRIBUTING.md"]  # the changelog says what was, and is not rewritten
# Two name what they look for; the reference is made from strings in apps/cli, which are counted there.
OWN = {"tests/layers/check_wording.py", "tests/layers/check_wording_test.py", "docs/reference/cli.md"}
MIN_FILES = 5

Pattern = collections.namedtuple("Pattern", "name kinds expression hint")
ALL = {"comment", "string", "markdown"}
PATTERNS = [
    Pattern("genitive", {"comment"}, r"^(?:[Oo]f|[Ww]hose)\b",
            'begin with a verb ("Returns …", "Projects …") or a noun ("Length of …"), never with "of" or "whose"'),
    Pattern("so many", ALL, r"(?i)\bso many\b(?! that no)", 'name the number: "kStep cells", "up to max_gaussians"'),
    Pattern("what became", ALL, r"(?i)\bwhat (?:became|has become|becomes)\b", '"result of …", "newly known voxels"'),
    Pattern("whoever, nobody", ALL, r"(?i)\b(?:whoever|nobody)\b", "name who it is: the caller, the client, the thread"),
    Pattern("the one who", ALL, r"(?i)\bthe ones? who\b", "name who it is: the caller, the client, the thread"),
    Pattern("that there are", ALL, r"(?i)\b(?:all|those|ones) that there (?:are|were)\b", "leave it out"),
    Pattern("The same", {"comment", "markdown"}, r"\bThe same\b",
            'name the subject: "Returns the gains of …", "As f(), for …"'),
    Pattern("What", {"comment"}, r"^What (?!is\b|became\b|has become\b|becomes\b)",
            'begin with a noun: "Result of …", "Content of …", "Parameters of …"'),
    Pattern("somebody", {"comment"}, r"(?i)\b(?:anybody|somebody|everybody)\b", "name who it is: the user, a client, a thread"),
    Pattern("is no", ALL,
            r"(?<!there )\b(?:is|are) no (?:number|whole number|YAML|JSON|path|rotation|rigid|pose|journal|folder)\b",
            'write "is not a …"'),
    Pattern("riddle", {"comment"}, r"(?i)\b(?:hangs? together|worth going to|of its own making|what (?:comes|came) of|"
            r"than there are|(?:is|are|was) gone through)\b",
            'say it plainly: "connected", "worth taking", "visited", "result of …"'),
]


def places(root):
    """Returns {pattern: {room: ["file:line: words around"]}} and the number of files that were read."""
    names = rooms.rooms_of(root)
    found, read = {pattern.name: {} for pattern in PATTERNS}, 0
    files = [*rooms.files_below(root, FOLDERS), *((page, root / page) for page in PAGES if (root / page).exists())]
    for name, path in files:
        language = prose.language_of(path)
        if language is None or name in OWN:
            continue
        read += 1
        room = rooms.place_of(name, names)
        for passage in prose.passages(language, path.read_text()):
            for pattern in PATTERNS:
                for hit in re.finditer(pattern.expression, passage.text) if passage.kind in pattern.kinds else ():
                    words = passage.text[max(0, hit.start() - 40):hit.end() + 40].strip()
                    found[pattern.name].setdefault(room, []).append(f"{name}:{passage.line_of(hit.start())}: … {words} …")
    return found, read


def counts_of(found):
    return {name: {room: len(hits) for room, hits in sorted(by_room.items())} for name, by_room in found.items()}


def compare(found, before):
    """Returns the violations against the counts before, and notes on what fell."""
    violations, notes = [], []
    for pattern in PATTERNS:
        old, new = before.get(pattern.name, {}), found[pattern.name]
        for room in sorted(set(old) | set(new)):
            had, has = old.get(room, 0), len(new.get(room, []))
            if has > had:
                violations.append(f'{room}: "{pattern.name}" {has} times, {had} before; instead: {pattern.hint}. Places:')
                violations += [f"    {place}" for place in new[room]]
            elif has < had:
                notes.append(f'{room}: "{pattern.name}" {has} times, {had} before')
    return violations, notes


def write(path, counts, before):
    """Stores the counts; rooms may have other names than before. Stores nothing when the total of a pattern rose, and
    returns one line for each of these."""
    risen = [f'"{name}": {sum(by_room.values())} in all, {sum(before[name].values())} before; not written'
             for name, by_room in counts.items() if name in before and sum(by_room.values()) > sum(before[name].values())]
    if not risen:
        path.write_text(json.dumps(counts, indent=1, ensure_ascii=False) + "\n")
    return risen


def main():
    option, root = sys.argv[1] if len(sys.argv) > 2 else "", pathlib.Path(sys.argv[-1])
    path = root / COUNTS
    found, read = places(root)
    before = json.loads(path.read_text()) if path.exists() else {}
    violations, notes = [], []
    if option == "--list":
        notes = [place for by_room in found.values() for hits in by_room.values() for place in hits]
    elif option == "--write":
        violations = write(path, counts_of(found), before)
    else:
        violations, notes = compare(found, before)
        if notes:
            notes.append("Counts fell; to keep them there: tests/layers/check_wording.py --write ROOT")
    for line in [*violations, *notes]:
        print(line)
    totals = ", ".join(f'"{name}" {sum(map(len, by_room.values()))}' for name, by_room in found.items())
    print(f"{read} files read: {totals}")
    sys.exit(1 if violations or read < MIN_FILES else 0)


if __name__ == "__main__":
    main()

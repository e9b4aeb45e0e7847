#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the tree to its own rules: which room may include which, what core rooms may link, SPDX lines, length of files.

Usage: check_layers.py ROOT. Prints one line per violation, then what was checked; exit status 1 on any violation and when
there was next to nothing to check."""
import pathlib
import re
import sys

import rooms

# Rooms that each room may include: those named here and what those may include, itself, and core (docs/design/architecture.md).
TABLE = {
    "core": [],
    "io/files": [],
    "sensor": [],
    "io/frames": ["io/files", "sensor"],
    "cloud": [],
    "map": ["sensor"],
    "surfel": ["sensor"],
    "io/clouds": ["io/files", "cloud", "map", "surfel"],
    "io/maps": ["io/files", "map"],
    "io/messages": ["io/files"],
    "io/bags": ["io/files", "io/frames", "io/messages", "sensor"],
    "tracking": ["sensor", "map", "surfel"],
    "loops": ["map", "tracking"],
    "segment": ["cloud", "map", "surfel"],
    "attention": ["cloud", "map", "segment"],
    "views": ["map", "attention"],
    "robot": ["map"],
    "explore": ["tracking", "attention", "views", "robot"],
    "arm": ["robot", "views", "io/clouds"],
    "devices": ["io/files", "io/frames", "io/messages", "robot"],
    "io/runs": ["io/frames", "io/clouds", "io/maps", "io/messages", "explore"],
    "scene": ["io/clouds", "devices"],
    "trial": ["scene", "arm", "io/runs"],
    "annotate": ["cloud"],
    "io/sessions": ["io/files", "annotate"],
    "report": ["io/frames", "surfel", "views", "arm", "attention"],
    "cuda": ["map", "tracking", "views"],
}


def closure(room):
    """Returns every room that a room may include, without itself."""
    found = {"core"} - {room}
    for below in TABLE[room]:
        found |= {below} | closure(below)
    return found


ALLOWED = {room: closure(room) for room in TABLE}

# Rooms that embed the loop: they need only the libraries below.
CORE_ROOMS = {"core", "sensor", "cloud", "map", "tracking", "surfel", "segment", "attention", "views", "robot", "explore",
              "annotate"}
CORE_LIBRARIES = {"Eigen", "oneapi", "tbb", "hwy", "zstd.h", "malloc.h", "fcntl.h", "sys", "unistd.h"}  # first part of the path in <…>
CORE_PACKAGES = {"Eigen3", "TBB", "HWY", "hwy", "zstd"}

MAX_LINES = 400
SOURCES = {".hpp", ".cpp", ".cu", ".cuh"}
PAGE = {".ts", ".css", ".mjs"}
NEED_SPDX = SOURCES | PAGE | {".cmake", ".in", ".sh", ".py", ".yaml"}
NOT_OURS = {"__pycache__", "corpus", "node_modules", "dist"}
KEYWORDS = {"SOURCES", "ROOMS", "PACKAGES", "PUBLIC", "PRIVATE", "FUZZED", "FUZZED_SOURCES"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
PRINTS = re.compile(r"\bstd::(?:cout|cerr|clog)\b|\b(?:std::)?(?:f?printf|puts|exit|abort|_Exit|quick_exit)\s*\(")
COMMENT = re.compile(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)


def code_only(text):
    """Comments and string literals blanked, so that prose about printf is no violation; includes are read before."""
    return COMMENT.sub(" ", text)


def check_library_source(name, room, text):
    for mark, path in INCLUDE.findall(text):
        first, *rest = path.split("/")
        if first == "saccade" and rest:
            other = rooms.room_of_include(path, TABLE) or rest[0]
            if other != room and other not in ALLOWED[room]:
                yield f"{name}: room {room} includes {path}; it may include {sorted(ALLOWED[room]) or 'no other room'}"
        elif path.startswith("apps/") or ".." in path.split("/"):
            yield f"{name}: includes {path}; the library knows no app, and paths start at lib/"
        elif mark == '"':
            yield f'{name}: includes "{path}"; own headers are named from lib/: "saccade/…"'
        elif room in CORE_ROOMS and (len(rest) > 0 or path.endswith((".h", ".hpp"))):
            if first not in CORE_LIBRARIES:
                yield f"{name}: core room {room} includes <{path}>; core rooms use only {sorted(CORE_LIBRARIES)}"
        if path == "iostream":
            yield f"{name}: includes <iostream>; the library never prints"
    found = PRINTS.search(code_only(text))
    if found:
        yield f"{name}: {found.group().strip()} in the library; it never prints and never exits"


def folder_of(target):
    """Returns the room that a target such as io_clouds is built from."""
    return target.replace("_", "/")


def check_room_cmake(name, room, text):
    text = re.sub(r"#[^\n]*", "", text)
    call = re.search(r"saccade_room\((.*?)\)", text, re.DOTALL)
    if not call:
        yield f"{name}: no saccade_room(…)"
        return
    words = re.findall(r'"[^"]*"|\S+', call.group(1))
    if folder_of(words[0]) != room:
        yield f"{name}: saccade_room({words[0]}) in the folder {room}"
    current = None
    for word in words[1:]:
        if word in KEYWORDS:
            current = word
        elif current == "ROOMS" and folder_of(word) not in ALLOWED[room]:
            yield f"{name}: room {room} links {word}; it may link {sorted(ALLOWED[room]) or 'no other room'}"
        elif current == "PACKAGES" and room in CORE_ROOMS and word.strip('"').split()[0] not in CORE_PACKAGES:
            yield f"{name}: core room {room} needs {word}; core rooms need only {sorted(CORE_PACKAGES)}"
        elif current in ("PUBLIC", "PRIVATE") and word.startswith("saccade"):
            yield f"{name}: room {room} links {word} outside ROOMS"


def links_of(text):
    call = re.search(r"saccade_room\((.*?)\)", re.sub(r"#[^\n]*", "", text), re.DOTALL)
    words = re.findall(r'"[^"]*"|\S+', call.group(1)) if call else []
    linked = []
    if "ROOMS" in words:
        for word in words[words.index("ROOMS") + 1:]:
            if word in KEYWORDS:
                break
            linked.append(folder_of(word))
    return set(linked)


def check_links_match(root, room, texts):
    """Every room that is included is linked too, itself or through a room below."""
    library = root / "lib" / "saccade"
    reachable, queue = set(), [room]
    while queue:
        cmake = library / queue.pop() / "CMakeLists.txt"
        for other in links_of(cmake.read_text()) if cmake.exists() else set():
            if other not in reachable:
                reachable.add(other)
                queue.append(other)
    included = {rooms.room_of_include(path, TABLE) for text in texts for _, path in INCLUDE.findall(text)}
    for other in sorted(included - reachable - {room, None}):
        yield f"lib/saccade/{room}/CMakeLists.txt: {other} is included but not linked (ROOMS)"


def files_below(root, folders):
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.is_file() and not NOT_OURS & set(path.parts):
                yield path


def check_text(name, path, text):
    lines = text.splitlines()
    if path.suffix in NEED_SPDX or path.name in ("CMakeLists.txt", "Makefile"):
        if not any("SPDX-License-Identifier: Apache-2.0" in line for line in lines[:2]):
            yield f"{name}: no SPDX line at the top"
    if path.suffix in SOURCES | {".ts", ".mjs", ".py", ".sh", ".cmake"} and len(lines) >= MAX_LINES:
        yield f"{name}: {len(lines)} lines; files stay under {MAX_LINES}"
    once = re.search(r"^#pragma once$|^// No include guard", text, re.MULTILINE)
    if path.suffix in (".hpp", ".cuh") and not once:
        yield f"{name}: no #pragma once"


def check_page(root):
    """Compares the table of docs/design/architecture.md with TABLE."""
    page = root / "docs/design/architecture.md"
    rows = re.findall(r"^\| `([a-z/]+)` \|.*\| ([a-z/, –]+) \|$", page.read_text(), re.MULTILINE) if page.exists() else []
    for room, below in rows:
        below = [] if below == "–" else below.split(", ")
        if room not in TABLE or below != TABLE[room]:
            yield f"docs/design/architecture.md: {room} may include {below}; the layer test says {TABLE.get(room, 'nothing of it')}"
    built = {room for room in TABLE if (root / "lib" / "saccade" / room / "CMakeLists.txt").exists()}
    for room in sorted(built - {room for room, _ in rows} if page.exists() else []):
        yield f"docs/design/architecture.md: {room} is not in the table of rooms"


def check(root):
    violations, checked = list(check_page(root)), 0
    library = root / "lib" / "saccade"
    files = [path.relative_to(library) for path in library.rglob("*") if path.is_file() and path.parent != library]
    for room in sorted({rooms.room_of(path.as_posix(), TABLE) or path.parent.as_posix() for path in files}):
        if room not in ALLOWED:
            violations.append(f"lib/saccade/{room}: no such room in the order of the layers")
            continue
        texts = []
        for path in files_below(root, [f"lib/saccade/{room}"]):
            name, text = str(path.relative_to(root)), path.read_text()
            if path.suffix in SOURCES:
                texts.append(text)
                violations += check_library_source(name, room, text)
            elif path.name == "CMakeLists.txt":
                violations += check_room_cmake(name, room, text)
        violations += check_links_match(root, room, texts)
    for path in files_below(root, ["lib", "apps", "devices", "tests", "examples", "bench", "scripts", "cmake", "web"]):
        if path.suffix in NEED_SPDX or path.name == "CMakeLists.txt":
            checked += 1
            violations += check_text(str(path.relative_to(root)), path, path.read_text())
    return violations, checked


def main():
    root = pathlib.Path(sys.argv[1])
    violations, checked = check(root)
    for violation in violations:
        print(violation)
    print(f"{checked} files checked, {len(violations)} violations")
    sys.exit(1 if violations or checked < 5 else 0)


if __name__ == "__main__":
    main()

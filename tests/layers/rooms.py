# SPDX-License-Identifier: Apache-2.0
"""Rooms of a tree, read from the tree: folders of lib/saccade whose CMakeLists.txt calls saccade_room. A room may lie in
another folder: lib/saccade/io/clouds is the room io/clouds."""
import re

NOT_OURS = {"__pycache__", "corpus", "node_modules", "dist", "test-results"}
LIBRARY = "lib/saccade/"
ROOM_CALL = re.compile(r"^\s*saccade_room\s*\(", re.MULTILINE)


def rooms_of(root):
    """Returns the names of the rooms, sorted."""
    library = root / "lib" / "saccade"
    return sorted(cmake.parent.relative_to(library).as_posix() for cmake in library.glob("*/**/CMakeLists.txt")
                  if ROOM_CALL.search(cmake.read_text()))


def room_of(path, rooms):
    """Returns the room of a path below lib/saccade, by the longest folder that is a room; None outside all rooms."""
    folders = path.split("/")[:-1]
    for length in range(len(folders), 0, -1):
        if "/".join(folders[:length]) in rooms:
            return "/".join(folders[:length])
    return None


def room_of_include(path, rooms):
    """Returns the room of an include path such as saccade/io/clouds/ply.hpp; None where it names no room."""
    first, _, rest = path.partition("/")
    return room_of(rest, rooms) if first == "saccade" else None


def place_of(name, rooms):
    """Returns the room of a file named from the root. Each folder of apps counts as one room, and so does every other
    top folder."""
    if name.startswith(LIBRARY):
        return room_of(name[len(LIBRARY):], rooms) or "lib/saccade"
    first, _, rest = name.partition("/")
    if not rest:
        return "docs"  # README.md, CONTRIBUTING.md
    return f"apps/{rest.split('/')[0]}" if first == "apps" and "/" in rest else first


def files_below(root, folders):
    """Yields (name from the root, path) of the project's own files, sorted by folder and name."""
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.is_file() and not NOT_OURS & set(path.parts):
                yield path.relative_to(root).as_posix(), path

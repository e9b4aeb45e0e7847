#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the guides to the code: commands, options and types that pages name, components and options of docs/guides/embed.md,
new names of docs/guides/upgrading.md.   Usage: check_guides.py ROOT [PROGRAM]"""
import functools
import pathlib
import re
import subprocess
import sys

BLOCK = re.compile(r"^```(?:sh)?\n(.*?)^```", re.MULTILINE | re.DOTALL)
DEBIAN = {  # packages of CMake → those of Debian
    "Eigen3": ["libeigen3-dev"], "TBB": ["libtbb-dev"], "hwy": ["libhwy-dev"], "ZLIB": ["zlib1g-dev"],
    "nlohmann_json": ["nlohmann-json3-dev"], "yaml-cpp": ["libyaml-cpp-dev"], "SQLite3": ["libsqlite3-dev"],
    "ImageCodecs": ["libpng-dev", "libtiff-dev", "libturbojpeg0-dev"], "assimp": ["libassimp-dev"], "zstd": ["libzstd-dev"],
    "orocos_kdl": ["liborocos-kdl-dev"], "OMPL": ["libompl-dev"], "urdfdom": ["liburdfdom-dev"],
    "embree": ["libembree-dev"], "Freetype": ["libfreetype-dev", "fonts-dejavu-core"],
    "OpenEXR": ["libopenexr-dev"], "Ceres": ["libceres-dev"]}
MIN_COMMANDS = 60


def rows_below(text, heading):
    """Cells of the table that follows the heading, without its first two lines."""
    table = text.split(f"## {heading}\n", 1)[1].split("\n## ", 1)[0]
    lines = [line for line in table.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def quoted(cell):
    return re.findall(r"`([^`]+)`", cell)


@functools.cache
def help_of(program, words):
    done = subprocess.run([program, *words, "--help"], capture_output=True, text=True, timeout=60)
    return done.stdout if done.returncode == 0 else None


def commands_of(text):
    """Commands of the page's blocks that begin with saccade; lines that end in a backslash go on."""
    for block in BLOCK.findall(text):
        for line in block.replace("\\\n", " ").splitlines():
            if line.startswith("saccade ") and not line.startswith("saccade --"):
                yield line.split("#")[0].split()[1:]


def check_commands(root, program):
    seen = 0
    everywhere = help_of(program, ())
    for page in [root / "README.md", *sorted(root.glob("docs/*/*.md"))]:
        if page.parent.name in ("decisions", "results"):  # these say what was
            continue
        for words in commands_of(page.read_text()):
            seen += 1
            name = page.relative_to(root)
            text = help_of(program, tuple(words[:1]))
            if text is None:
                yield f"{name}: there is no saccade {words[0]}"
                continue
            below = text.split("Subcommands:")[1:]
            if len(words) > 1 and below and re.search(rf"^  {re.escape(words[1])} ", below[0], re.MULTILINE):
                text += help_of(program, tuple(words[:2])) or ""
            text += everywhere
            for option in (word.split("=")[0] for word in words[1:] if re.match(r"--[a-z]", word)):
                if not re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", text):
                    yield f"{name}: saccade {words[0]} knows no {option}"
    if seen < MIN_COMMANDS:
        yield f"docs: only {seen} commands of the program were found, {MIN_COMMANDS} expected"


def check_components(root, package):
    """Components and packages of docs/guides/embed.md are those of the package that is installed."""
    config = package.read_text()
    rooms = re.search(r'_saccade_all_rooms "([^"]*)"', config)[1].split(";")
    said = {}
    for names, _, packages in rows_below((root / "docs/guides/embed.md").read_text(), "Components and their packages"):
        said.update({name: quoted(packages) for name in quoted(names)})
    for room in rooms:
        wanted = re.search(rf'_saccade_packages_of_{room} "([^"]*)"', config)[1]
        packages = [debian for entry in wanted.split(";") if entry for debian in DEBIAN[entry.split()[0]]]
        if room not in said:
            yield f"docs/guides/embed.md: the component {room} is missing"
        elif sorted(said[room]) != sorted(packages):
            yield f"docs/guides/embed.md: {room} needs {packages or 'no package of its own'}, not {said[room]}"
    for name in set(said) - set(rooms):
        yield f"docs/guides/embed.md: there is no component {name}"


def check_options(root):
    declared = set(re.findall(r"^(?:option|set)\((SACCADE_\w+) .*(?:CACHE|ON|OFF|TOP_LEVEL\})", (root / "CMakeLists.txt").read_text(),
                              re.MULTILINE))
    said = {option for cells in rows_below((root / "docs/guides/embed.md").read_text(), "Options") for option in quoted(cells[0])}
    for option in declared ^ said:
        yield f"docs/guides/embed.md: {option} is {'not in the table' if option in declared else 'no option of CMakeLists.txt'}"


def check_upgrading(root):
    """The present name of each name of 0.1 is a public name, in the header that is said."""
    headers = {}
    for part in re.split(r"\n(?=saccade/)", (root / "docs/reference/api.txt").read_text())[1:]:
        header, *names = part.split("\n")
        headers[header.removeprefix("saccade/")] = {name.split()[-1] for name in names if name.strip()}
    rows = rows_below((root / "docs/guides/upgrading.md").read_text(), "Types and functions")
    for _, now, where in rows:
        public = set().union(*(headers.get(header, set()) for header in quoted(where)))
        missing = [header for header in quoted(where) if header not in headers]
        names = [re.match(r"\w+", name)[0] for name in quoted(now)]
        if missing:
            yield f"docs/guides/upgrading.md: no header {missing}"
        elif not public & set(names):
            yield f"docs/guides/upgrading.md: {where} declares none of {names}"
    if len(rows) < 20:
        yield "docs/guides/upgrading.md: fewer than 20 rows were found"


def check_names(root):
    """Types and their members that pages name occur in the code."""
    sources = [path for folder in ("lib", "apps", "tests", "bench", "examples", "devices") for path in (root / folder).rglob("*")
               if path.suffix in (".hpp", ".cpp", ".py")]
    words = {word for path in sources for word in re.findall(r"\w+", path.read_text(errors="ignore"))}
    for page in [*root.glob("docs/guides/*.md"), *root.glob("docs/reference/*.md"), *root.glob("docs/design/*.md")]:
        if page.name in ("upgrading.md", "moved-headers.md"):  # these name what was
            continue
        for name in re.findall(r"`([A-Z][a-z]+[A-Z]\w*(?:::\w+)*)`", page.read_text()):
            if name != "FetchContent" and (missing := [part for part in name.split("::") if part not in words]):
                yield f"{page.relative_to(root)}: the code has no {missing[0]} ({name})"


def main():
    root = pathlib.Path(sys.argv[1])
    problems = [*check_options(root), *check_upgrading(root), *check_names(root)]
    if len(sys.argv) > 2:
        program = pathlib.Path(sys.argv[2])
        problems += check_commands(root, str(program))
        if (package := program.parent / "package/saccadeConfig.cmake").exists():
            problems += check_components(root, package)
    for problem in problems:
        print(problem)
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()

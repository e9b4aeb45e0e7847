#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Holds README.md and docs/ to the tree: code blocks marked with a file are that file, links lead somewhere, and the
commands shown are understood by the program.   Usage: check_readme.py ROOT [PROGRAM]"""
import pathlib
import re
import subprocess
import sys

MARKED = re.compile(r"<!-- (\S+) -->\n```\w*\n(.*?)```", re.DOTALL)
LINK = re.compile(r"\]\(([^)#:]+)(?:#[^)]*)?\)")
COMMAND = re.compile(r"^saccade (\w+)(.*?)(?:#.*)?$", re.MULTILINE)


def check_blocks(root, text):
    marked = MARKED.findall(text)
    if not marked:
        yield "README.md: no marked code block"
    for name, block in marked:
        if (root / name).read_text() != block:
            yield f"README.md: the block of {name} differs from the file"


def check_links(root):
    for document in [root / "README.md", *sorted(root.glob("docs/**/*.md")), root / "CONTRIBUTING.md"]:
        for target in LINK.findall(document.read_text()):
            if not (document.parent / target).exists():
                yield f"{document.relative_to(root)}: link to {target} leads nowhere"


def check_paths(root):
    """Files named in the paper map and the architecture are there."""
    for name in ["docs/paper-map.md", "docs/architecture.md", "docs/defaults.md"]:
        for path in re.findall(r"`((?:lib|tests|apps|docs|scripts)/[\w./-]+)`", (root / name).read_text()):
            if not (root / path).exists():
                yield f"{name}: {path} is not there"


def check_commands(text, program):
    commands = COMMAND.findall(text)
    if not commands:
        yield "README.md: no command of the program"
    for subcommand, rest in commands:
        help_text = subprocess.run([program, subcommand, "--help"], capture_output=True, text=True, timeout=60)
        if help_text.returncode != 0:
            yield f"README.md: saccade {subcommand} --help gives exit status {help_text.returncode}"
        for option in re.findall(r"--[a-z-]+", rest):
            if option not in help_text.stdout:
                yield f"README.md: saccade {subcommand} knows no {option}"


def main():
    root = pathlib.Path(sys.argv[1])
    text = (root / "README.md").read_text()
    problems = [*check_blocks(root, text), *check_links(root), *check_paths(root)]
    if len(sys.argv) > 2:
        problems += check_commands(text, sys.argv[2])
    for problem in problems:
        print(problem)
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()

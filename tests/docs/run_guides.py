#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of guides whose blocks are marked ```sh, one after the other, in an empty folder.
Usage: run_guides.py ROOT PROGRAM"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

GUIDES = {  # page → files that its commands leave
    "docs/guides/label-a-scan.md": ["table/mesh.ply", "segments.ply", "segments.png", "corrected.ply"],
    "docs/guides/compare-your-planner.md": ["try/index.html", "try/runs.csv", "try/views.csv", "try/summary.csv"]}


def run(page, text, program, files):
    commands = [line for block in re.findall(r"^```sh\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
                for line in block.splitlines() if line]
    assert commands, f"{page} has no commands to run"
    environment = {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}"}
    with tempfile.TemporaryDirectory() as folder:
        for command in commands:
            done = subprocess.run(["sh", "-c", command], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                  capture_output=True, text=True, timeout=240)
            if done.returncode != 0:
                sys.exit(f"{page}: {command}\nexit status {done.returncode}\n{done.stdout}{done.stderr}")
        for name in files:
            if not (pathlib.Path(folder) / name).exists():
                sys.exit(f"{page}: its commands leave no {name}")
    print(f"{page}: {len(commands)} commands run")


def main():
    root, program = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
    for page, files in GUIDES.items():
        run(page, (root / page).read_text(), program, files)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy (checks: .clang-tidy, every warning is an error) over lib/ and apps/, several sources of a room at a
time as the preset tidy puts them together: most of its time goes into the headers that they share.

What was found clean is not looked at again while it stays the same: the key of a compilation is a hash of its
preprocessed text with comments, of .clang-tidy and of clang-tidy's version; clean keys lie beside the compiler's cache.
SACCADE_TIDY_CACHE=off looks at all. Needs the preset tidy configured; scripts/tidy.sh does that."""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import time

CHECKED = re.compile(r"/(lib/saccade|apps)/.*\.c(pp|xx)$")
KEPT_DAYS = 60


def output_of(command, folder=None):
    return subprocess.run(command, capture_output=True, cwd=folder, check=True).stdout


class CleanKeys:
    """The folder of clean keys: an empty file for each."""

    def __init__(self):
        self.folder = None
        if os.environ.get("SACCADE_TIDY_CACHE") == "off":
            return
        cache = os.environ.get("CCACHE_DIR") or pathlib.Path.home() / ".cache" / "ccache"
        self.folder = pathlib.Path(cache).parent / "saccade-tidy"
        self.folder.mkdir(parents=True, exist_ok=True)
        for path in self.folder.iterdir():
            if time.time() - path.stat().st_mtime > KEPT_DAYS * 86400:
                path.unlink(missing_ok=True)

    def holds(self, key):
        if self.folder is None or not (self.folder / key).exists():
            return False
        os.utime(self.folder / key)
        return True

    def add(self, key):
        if self.folder is not None:
            (self.folder / key).touch()


def key_of(entry, rules):
    """Hash of what clang-tidy would read. Comments count, as some of them speak to it; paths of the checkout do not."""
    command = [word for word in shlex.split(entry["command"]) if not word.startswith("-ffile-prefix-map=")]
    output = command.index("-o")
    command[output:output + 2] = []
    command[0] = "clang++"
    command[command.index("-c")] = "-E"
    text = output_of(command + ["-C", "-P", "-w", "-Wno-error"], entry["directory"])
    return hashlib.sha256(rules + text).hexdigest()


def check(entry, rules, clean, folder):
    """@return whether it was known to be clean, and what is wrong; None: nothing."""
    key = key_of(entry, rules)
    if clean.holds(key):
        return True, None
    run = subprocess.run(["clang-tidy", "-quiet", f"-p={folder}", entry["file"]], capture_output=True, text=True, check=False)
    if run.returncode == 0:
        clean.add(key)
        return False, None
    found = [line for line in run.stdout.splitlines() if line.strip()]
    return False, "\n".join(found) or run.stderr


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    folder = root / "build" / "tidy"
    entries = [entry for entry in json.loads((folder / "compile_commands.json").read_text())
               if CHECKED.search("/" + os.path.relpath(entry["file"], root))
               and os.path.exists(entry["file"])]  # a source that the build makes is not there yet
    if not entries:
        sys.exit("tidy: nothing to check in build/tidy/compile_commands.json")
    rules = (root / ".clang-tidy").read_bytes() + output_of(["clang-tidy", "--version"])
    clean = CleanKeys()
    with concurrent.futures.ThreadPoolExecutor(int(sys.argv[1]) if len(sys.argv) > 1 else os.cpu_count()) as pool:
        outcomes = list(pool.map(lambda entry: check(entry, rules, clean, folder), entries))
    wrong = [text for _, text in outcomes if text is not None]
    for text in wrong:
        print(text)
    known = sum(known for known, _ in outcomes)
    if "CCACHE_STATSLOG" in os.environ:  # test_summary.py counts both caches
        with open(os.environ["CCACHE_STATSLOG"], "a") as log:
            log.writelines("direct_cache_hit\n" if was_known else "cache_miss\n" for was_known, _ in outcomes)
    print(f"clang-tidy: {len(entries)} compilations, {known} known to be clean, {len(wrong)} with findings")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Finishes the files of the Debian packages before CPack packs them: changelogs, compression, permissions, times.

Usage: stage.py FOLDER VERSION MAINTAINER BUILD. FOLDER has one folder per component, BUILD is where they were built. Times are SOURCE_DATE_EPOCH (scripts/package.sh
sets it), so that the same sources give the same packages."""
import gzip
import os
import pathlib
import subprocess
import sys
import time
from email.utils import formatdate

import sbom

ROOT = pathlib.Path(__file__).resolve().parent.parent


def write_compressed(path, data):
    """Writes PATH as gzip -9n does: neither name nor time in the file."""
    with open(path, "wb") as out, gzip.GzipFile("", "wb", 9, out, mtime=0) as packed:
        packed.write(data)


def package_of(stage):
    """Returns the name of the package: the folder of documentation that has a copyright file bears it."""
    (copyright_file,) = stage.glob("usr/share/doc/*/copyright")
    return copyright_file.parent.name


def debian_changelog(version, maintainer, epoch):
    return (f"saccade ({version}) unstable; urgency=medium\n\n  * Built from source. CHANGELOG.md.gz has what changed.\n\n"
            f" -- {maintainer}  {formatdate(epoch)}\n")


def add_changelogs(stage, version, maintainer, epoch):
    """Adds both changelogs to the documentation folder of the package."""
    copyright_file = stage / f"usr/share/doc/{package_of(stage)}/copyright"
    write_compressed(copyright_file.with_name("CHANGELOG.md.gz"), (ROOT / "CHANGELOG.md").read_bytes())
    write_compressed(copyright_file.with_name("changelog.gz"), debian_changelog(version, maintainer, epoch).encode())


def add_device_manuals(stage, version, day):
    """Adds a manual page for each program that has none: those of devices, whose options stand in the documentation."""
    template = (ROOT / "packaging/man/saccade-devices.1.in").read_text()
    for program in sorted((stage / "usr/bin").glob("*")):
        page = stage / "usr/share/man/man1" / f"{program.name}.1"
        if not page.exists():
            page.parent.mkdir(parents=True, exist_ok=True)
            values = {"@PROGRAM@": program.name.upper(), "@program@": program.name, "@version@": version, "@date@": day}
            text = template
            for key, value in values.items():
                text = text.replace(key, value.replace("-", "\\-") if key == "@program@" else value)
            page.write_text(text)


def compress_manuals(stage, day):
    """Puts the date into pages that have none, and packs them."""
    for page in sorted(stage.glob("usr/share/man/man*/*.[1-9]")):
        text = page.read_text().replace(' 1 "" ', f' 1 "{day}" ', 1)
        write_compressed(page.with_name(page.name + ".gz"), text.encode())
        page.unlink()


def strip_archives(stage):
    """Takes debugging symbols, comments and times out of static libraries."""
    for archive in sorted(stage.rglob("*.a")):
        subprocess.run(["strip", "--strip-debug", "--remove-section=.comment", "--remove-section=.note",
                        "--enable-deterministic-archives", str(archive)], check=True)


def normalise(stage, epoch):
    """Sets permissions and times, children before their folders."""
    for path in sorted(stage.rglob("*"), reverse=True):
        if not path.is_symlink():
            runs = path.is_dir() or (os.access(path, os.X_OK) and path.suffix != ".so")
            path.chmod(0o755 if runs else 0o644)
        os.utime(path, (epoch, epoch), follow_symlinks=False)


def main():
    folder, version, maintainer, build = sys.argv[1:]
    if "SOURCE_DATE_EPOCH" not in os.environ:
        sys.exit("stage.py: SOURCE_DATE_EPOCH is not set; make packages by scripts/package.sh (make package)")
    epoch = int(os.environ["SOURCE_DATE_EPOCH"])
    day = time.strftime("%Y-%m-%d", time.gmtime(epoch))
    stages = sorted(path for path in pathlib.Path(folder).iterdir() if (path / "usr").is_dir())
    if not stages:
        sys.exit(f"stage.py: no package is staged in {folder}")
    for stage in stages:
        add_changelogs(stage, version, maintainer, epoch)
        add_device_manuals(stage, version, day)
        compress_manuals(stage, day)
        strip_archives(stage)
        sbom.write_bill(stage, package_of(stage), version, epoch, build)
        normalise(stage, epoch)


if __name__ == "__main__":
    main()

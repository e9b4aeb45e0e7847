# SPDX-License-Identifier: Apache-2.0
"""write_source_archive: the sources as a .tar.gz that pip takes (PEP 517), the same bytes for the same files."""
import gzip
import io
import os
import shutil
import subprocess
import tarfile

LEFT_OUT = {".git", "build", "out", ".cache", "__pycache__", "node_modules", "test-results"}


def source_files(root):
    """What git tracks; where git does not say, as in an unpacked archive, all but what building makes."""
    git = shutil.which("git") if (root / ".git").exists() else None
    listed = git and subprocess.run([git, "ls-files", "-z"], cwd=root, capture_output=True, text=True).stdout
    if listed:
        return sorted(name for name in listed.split("\0") if name and (root / name).is_file())
    return sorted(path.relative_to(root).as_posix() for path in root.rglob("*")
                  if path.is_file() and not LEFT_OUT & set(path.relative_to(root).parts) and path.name != "PKG-INFO")


def write_source_archive(root, metadata, folder):
    top = f"{metadata.name}-{metadata.version}"
    date = int(os.environ.get("SOURCE_DATE_EPOCH", 0))
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / f"{top}.tar.gz", "wb") as file, gzip.GzipFile("", "wb", 9, file, mtime=0) as packed:
        with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
            def add(name, data, runs):
                entry = tarfile.TarInfo(f"{top}/{name}")
                entry.size, entry.mtime, entry.mode = len(data), date, 0o755 if runs else 0o644
                archive.addfile(entry, io.BytesIO(data))

            for name in source_files(root):
                add(name, (root / name).read_bytes(), os.access(root / name, os.X_OK))
            add("PKG-INFO", metadata.core().encode(), False)
    return f"{top}.tar.gz"

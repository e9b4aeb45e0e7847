# SPDX-License-Identifier: Apache-2.0
"""Metadata: what pyproject.toml says of the distribution; WheelFile: writes a wheel (PEP 427), the same bytes for the same
files; wheel_tag: the Python and the platform of this interpreter."""
import base64
import dataclasses
import hashlib
import os
import pathlib
import re
import sys
import sysconfig
import time
import zipfile


@dataclasses.dataclass(frozen=True)
class Metadata:
    name: str
    version: str
    description: str
    requires_python: str
    dependencies: tuple
    scripts: tuple  # lines NAME = MODULE:FUNCTION
    readme: str
    license_text: str

    @staticmethod
    def read(root):
        """Reads pyproject.toml line by line, since Python has a reader of TOML from 3.11 on alone."""
        project = (root / "pyproject.toml").read_text().split("[project]")[1]

        def value(key):
            return re.search(rf"^{key} = (.*)$", project, re.MULTILINE)[1]

        quoted = re.compile(r'"([^"]*)"')
        version = re.search(r"project\(saccade VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text())[1]
        return Metadata(quoted.match(value("name"))[1], version, quoted.match(value("description"))[1],
                        quoted.match(value("requires-python"))[1], tuple(quoted.findall(value("dependencies"))),
                        tuple(f"{name} = {function}" for name, function in re.findall(r'([\w-]+) = "([^"]*)"', value("scripts"))),
                        (root / "README.md").read_text(), (root / "LICENSE").read_text())

    @property
    def info_folder(self):
        return f"{self.name}-{self.version}.dist-info"

    def core(self):
        """Core metadata (METADATA in a wheel, PKG-INFO in a source archive)."""
        lines = ["Metadata-Version: 2.1", f"Name: {self.name}", f"Version: {self.version}", f"Summary: {self.description}",
                 "License: Apache-2.0", f"Requires-Python: {self.requires_python}",
                 *(f"Requires-Dist: {dependency}" for dependency in self.dependencies),
                 "Description-Content-Type: text/markdown", "", self.readme]
        return "\n".join(lines)

    def files(self):
        """Files of the folder .dist-info, without RECORD."""
        return {"METADATA": self.core(),
                "WHEEL": f"Wheel-Version: 1.0\nGenerator: saccade_build\nRoot-Is-Purelib: false\nTag: {wheel_tag()}\n",
                "entry_points.txt": "[console_scripts]\n" + "".join(f"{script}\n" for script in self.scripts),
                "LICENSE": self.license_text}


def wheel_tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub(r'[-.]', '_', sysconfig.get_platform())}"


class WheelFile:
    """Adds files one after the other; RECORD and the metadata come last."""

    def __init__(self, path, metadata):
        self.metadata = metadata
        self.records = []
        self.archive = zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED)
        self.date = time.gmtime(max(int(os.environ.get("SOURCE_DATE_EPOCH", 0)), 315532800))[:6]  # ZIP begins in 1980

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        with self.archive:
            if kind is None:
                self.finish()

    def add(self, name, data, runs=False):
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        self.records.append(f"{name},sha256={digest},{len(data)}\n")
        self.write(name, data, runs)

    def write(self, name, data, runs=False):
        entry = zipfile.ZipInfo(name, self.date)
        entry.external_attr = (0o100755 if runs else 0o100644) << 16
        entry.compress_type = zipfile.ZIP_DEFLATED
        self.archive.writestr(entry, data)

    def finish(self):
        folder = self.metadata.info_folder
        for name, text in self.metadata.files().items():
            self.add(f"{folder}/{name}", text.encode())
        self.write(f"{folder}/RECORD", ("".join(self.records) + f"{folder}/RECORD,,\n").encode())

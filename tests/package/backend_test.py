#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Messages of pip install . where a tool or a library is missing; the back end runs with made programs in PATH."""
import contextlib
import io
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "packaging/python"))
import saccade_build  # noqa: E402

NO_EIGEN = """-- Saccade: the Python module is left out, for lack of python3-dev or pybind11-dev
CMake Error at CMakeLists.txt:40 (find_package):
  Could not find a package configuration file provided by "Eigen3"

-- Configuring incomplete, errors occurred!"""


class Errors(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        patched = mock.patch.dict(os.environ, {"PATH": str(self.folder / "bin"), "CXX": ""})
        patched.start()
        self.addCleanup(patched.stop)

    def program(self, name, text):
        (self.folder / "bin").mkdir(exist_ok=True)
        file = self.folder / "bin" / name
        file.write_text(f"#!/bin/sh\n{text}\n")
        file.chmod(0o755)

    def said(self):
        """Returns the message with which build_wheel exits."""
        with self.assertRaises(SystemExit) as stopped, contextlib.redirect_stdout(io.StringIO()):
            saccade_build.build_wheel(self.folder, {"build-dir": str(self.folder / "build")})
        return str(stopped.exception)

    def test_no_cmake(self):
        self.assertRegex(self.said(), "CMake 3.25 or later is not in PATH.*apt-get install cmake")

    def test_an_old_cmake(self):
        self.program("cmake", "echo cmake version 3.18.4")
        self.assertRegex(self.said(), "CMake 3.25 or later is needed; .*cmake is 3.18")

    def test_no_compiler(self):
        self.program("cmake", "echo cmake version 3.25.1")
        self.assertRegex(self.said(), "no C.*20 compiler: c.., g.. and clang.. not in PATH")
        os.environ["CXX"] = "icpx -O2"
        self.assertRegex(self.said(), "no C.*20 compiler: icpx not in PATH")

    def test_a_library_is_missing(self):
        self.program("c++", "exit 0")
        self.program("cmake", f"[ $1 = --version ] && echo cmake version 3.25.1 && exit 0\necho '{NO_EIGEN}'\nexit 1")
        said = self.said()
        for part in ("configuring failed", "Could not find a package configuration file provided by \"Eigen3\"",
                     "left out, for lack of python3-dev", "packages.txt"):
            self.assertIn(part, said)
        self.assertNotIn("Configuring incomplete", said)


if __name__ == "__main__":
    unittest.main()

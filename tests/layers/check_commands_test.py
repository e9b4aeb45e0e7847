#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Plants commands that print or name an exit status and expects check_commands to name each, and nothing else."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import check_commands


class CheckCommands(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.plant("apps/cli/scaffold.cpp", "void write() { std::cout << 1; }\n")
        self.plant("apps/cli/good.cpp", "// prints to std::cout\nint value() { return 1; }\n")
        self.plant("apps/cli/old.cpp", "void run() { std::cout << 1; }\n")
        self.list_files("old.cpp")
        self.assertEqual(self.check()[0], 0)

    def plant(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)

    def list_files(self, *names):
        self.plant(check_commands.LISTED, json.dumps(names))

    def check(self, *options):
        done = subprocess.run([sys.executable, "-B", "check_commands.py", *options, self.root], capture_output=True,
                              text=True, timeout=60)
        return done.returncode, done.stdout.splitlines()[:-1]

    def test_commands_that_print_or_end_the_program(self):
        for text, what in {"std::cerr << 1;": "std::cerr", "return ExitStatus::done;": "ExitStatus",
                           'print_error("a", "b");': "print_error", "std::_Exit(3);": "std::_Exit"}.items():
            self.plant("apps/cli/new.cpp", text)
            line = f"apps/cli/new.cpp: has {what}; a command returns an Outcome (command.hpp)"
            self.assertEqual(self.check(), (1, [line]))

    def test_a_converted_file_leaves_the_list(self):
        self.plant("apps/cli/old.cpp", "void run() {}\n")
        self.assertEqual(self.check()[0], 1)
        self.assertEqual(self.check("--write"), (0, []))
        self.assertEqual(json.loads((self.root / check_commands.LISTED).read_text()), [])

    def test_the_list_does_not_grow(self):
        self.plant("apps/cli/new.cpp", "std::cout << 1;")
        self.assertEqual(self.check("--write")[0], 1)


if __name__ == "__main__":
    unittest.main()

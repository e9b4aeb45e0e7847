#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Plants wordings in small trees and expects check_wording to count each, where it is, and nothing else."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import check_wording

SPDX = "// SPDX-License-Identifier: Apache-2.0\n"
TREE = {
    "lib/saccade/CMakeLists.txt": "# saccade_room() is called below; of no interest\n",
    "lib/saccade/core/CMakeLists.txt": "saccade_room(core SOURCES a.cpp)\n",
    "lib/saccade/core/a.hpp": SPDX + "/// Length of a path.\nint nobody;  // so many that no page shows them\n"
                             "int b;  // so that there are two\n",
    "lib/saccade/io/clouds/CMakeLists.txt": "saccade_room(io_clouds SOURCES a.cpp)\n",
    "lib/saccade/io/clouds/a.cpp": SPDX + "/// Returns the length\n/// of each path.\nint f();\n",
    "apps/cli/main.cpp": SPDX + "int main() {}\n",
    "docs/page.md": "Of 20 views `nobody` takes one.\n```\nso many\n```\n",
}
CORE, CLOUDS, CLI, PAGE = ("lib/saccade/core/a.hpp", "lib/saccade/io/clouds/a.cpp", "apps/cli/main.cpp", "docs/page.md")


class CheckWording(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / check_wording.COUNTS).parent.mkdir(parents=True)
        for name, text in TREE.items():
            self.plant(name, text)

    def plant(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)

    def found(self):
        found, read = check_wording.places(self.root)
        self.assertEqual(read, sum(1 for path in self.root.rglob("*") if path.is_file() and path.name != "wording.json"))
        return {name: by_room for name, by_room in found.items() if by_room}

    def check(self, *options):
        done = subprocess.run([sys.executable, "-B", "check_wording.py", *options, self.root], capture_output=True,
                              text=True, timeout=60)
        return done.returncode, done.stdout

    def expect(self, pattern, name, room, text, *lines):
        self.plant(name, text)
        found = self.found()
        self.assertEqual(list(found), [pattern])
        self.assertEqual(list(found[pattern]), [room])
        self.assertEqual([place.split(": ")[0] for place in found[pattern][room]], [f"{name}:{line}" for line in lines])

    def test_clean_tree(self):
        self.assertEqual(self.found(), {})

    def test_genitives(self):
        self.expect("genitive", CORE, "core",
                    SPDX + "// Of all members.\nint a;  ///< of a point\nint b;  // whose end\n/* Of\n * one */\n"
                    "/// A point.\n/// Of two.\n"
                    'const char* s = "Of a";  // a count\n', 2, 3, 4, 5)

    def test_genitive_below_code_begins_anew(self):
        self.expect("genitive", CLOUDS, "io/clouds", "int a;  // a name\n// of b\n  // of c\n", 2, 3)

    def test_so_many_across_lines(self):
        self.expect("so many", CLOUDS, "io/clouds", SPDX + "/// Rows of so\n/// many cells, so many.\nint so_many;\n", 2, 3)

    def test_so_many_in_strings(self):
        self.expect("so many", CLI, "apps/cli", 'auto help = "use at most so "\n    "many frames";\n', 1)

    def test_what_became(self):
        self.expect("what became", CORE, "core", "/// What became of a frame, and what becomes of it.\n", 1, 1)

    def test_whoever_and_nobody(self):
        self.expect("whoever, nobody", PAGE, "docs", "# Title\n\nWhoever asks,\nnobody's answer.\n", 3, 4)

    def test_the_one_who(self):
        self.expect("the one who", CORE, "core", "int x;  // the one who asks\n", 1)

    def test_that_there_are(self):
        self.expect("that there are", CORE, "core", "/// Lists those that there are.\n", 1)

    def test_the_same(self):
        self.expect("The same", CORE, "core", "/// Adds the same.\n/// The same for many poses.\n", 2)

    def test_what(self):
        self.expect("What", CORE, "core", "/// What a frame holds.\nint a;  // What is it?\nint b;  // see what\n", 1)

    def test_somebody(self):
        self.expect("somebody", CORE, "core", "/// Waits until somebody asks.\n", 1)

    def test_is_no(self):
        self.expect("is no", CLI, "apps/cli", 'auto a = "is no number";\nauto b = "there is no path";\n', 1)

    def test_riddles(self):
        self.expect("riddle", CORE, "core", "/// Points that hang together.\n/// Views worth going to.\n", 1, 2)

    def test_other_languages(self):
        self.expect("whoever, nobody", "scripts/run.sh", "scripts",
                    "echo nobody ${x#nobody}\n# nobody\nx=1 # nobody\n", 2, 3)
        self.plant("scripts/run.sh", "\n")
        self.expect("whoever, nobody", "web/src/a.ts", "web", "const nobody = `nobody`; // x\n/** Nobody. */\n", 1, 2)
        self.plant("web/src/a.ts", "\n")
        self.expect("genitive", "tests/a.py", "tests", '"""of a row"""\nx = "nobodys"  # of b\n', 1, 2)

    def test_a_rise_fails(self):
        self.plant(CORE, "// so many\n")
        self.assertEqual(self.check("--write")[0], 0)
        self.assertEqual(self.check()[0], 0)
        self.plant(CORE, "// so many\nint x;\n// so many\n")
        status, output = self.check()
        self.assertEqual(status, 1)
        for words in ['core: "so many" 2 times, 1 before', "name the number", f"{CORE}:1: ", f"{CORE}:3: "]:
            self.assertIn(words, output)

    def test_a_rise_in_one_room_is_not_made_up_for_in_another(self):
        self.plant(CORE, "// so many\n// so many\n")
        self.assertEqual(self.check("--write")[0], 0)
        self.plant(CORE, "\n")
        self.plant(CLI, "// so many\n")
        status, output = self.check()
        self.assertEqual(status, 1)
        self.assertIn('apps/cli: "so many" 1 times, 0 before', output)

    def test_a_fall_passes_with_a_note(self):
        self.plant(CORE, "// so many, so many\n")
        self.check("--write")
        self.plant(CORE, "// so many\n")
        status, output = self.check()
        self.assertEqual(status, 0)
        self.assertIn('core: "so many" 1 times, 2 before', output)
        self.assertIn("check_wording.py --write ROOT", output)

    def test_write_refuses_a_rise(self):
        self.plant(CORE, "// so many\n")
        self.check("--write")
        before = (self.root / check_wording.COUNTS).read_text()
        self.plant(CLI, "// so many\n")
        status, output = self.check("--write")
        self.assertEqual(status, 1)
        self.assertIn('"so many": 2 in all, 1 before; not written', output)
        self.assertEqual((self.root / check_wording.COUNTS).read_text(), before)

    def test_write_takes_new_names_of_rooms(self):
        self.plant(CORE, "// so many\n")
        self.check("--write")
        (self.root / "lib/saccade/core").rename(self.root / "lib/saccade/io/files")
        self.assertEqual(self.check()[0], 1)
        self.assertEqual(self.check("--write")[0], 0)
        self.assertEqual(self.check()[0], 0)
        self.assertIn('"io/files": 1', (self.root / check_wording.COUNTS).read_text())

    def test_nothing_to_check_fails(self):
        with tempfile.TemporaryDirectory() as empty:
            (pathlib.Path(empty) / "lib/saccade").mkdir(parents=True)
            self.root = empty
            self.assertEqual(self.check()[0], 1)


if __name__ == "__main__":
    unittest.main()

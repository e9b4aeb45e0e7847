#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Plants arrows between the rooms of a small tree and expects check_arrows to name each, and nothing else."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import check_arrows
import rooms

TREE = {
    "lib/saccade/core/CMakeLists.txt": "saccade_room(core SOURCES a.cpp)\n",
    "lib/saccade/core/a.hpp": "#include <vector>\n",
    "lib/saccade/map/CMakeLists.txt": "saccade_room(map SOURCES m.cpp ROOMS core)\n",
    "lib/saccade/map/m.cpp": '#include "saccade/core/a.hpp"\n#include "saccade/map/internal/m.hpp"\n',
    "lib/saccade/map/internal/m.hpp": '#include "saccade/core/a.hpp"\n',
    "lib/saccade/io/CMakeLists.txt": "# saccade_room() is called in the folders\nadd_subdirectory(clouds)\n",
    "lib/saccade/io/clouds/CMakeLists.txt": "saccade_room(io_clouds SOURCES a.cpp)\n",
    "lib/saccade/io/clouds/a.cpp": '#include "saccade/map/m.hpp"\n#include "saccade/io/clouds/internal/a.hpp"\n',
    "tests/unit/map/m_test.cpp": '#include "saccade/map/internal/m.hpp"\n',
    "apps/cli/main.cpp": '#include "saccade/io/clouds/a.hpp"\n',
}


class CheckArrows(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / check_arrows.ARROWS).parent.mkdir(parents=True)
        for name, text in TREE.items():
            self.plant(name, text)
        self.assertEqual(self.check("--write")[0], 0)
        self.assertEqual(self.check(), (0, ["6 files read, 2 arrows: core 0, io/clouds 1, map 1"]))

    def plant(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)

    def check(self, *options):
        done = subprocess.run([sys.executable, "-B", "check_arrows.py", *options, self.root], capture_output=True, text=True,
                              timeout=60)
        return done.returncode, done.stdout.splitlines()

    def expect(self, name, text, *lines):
        self.plant(name, TREE.get(name, "") + text)
        status, output = self.check()
        self.assertEqual((status, [line for line in output[:-1] if "--write" not in line]), (1, list(lines)))

    def test_rooms_of_include_paths(self):
        names = rooms.rooms_of(self.root)
        self.assertEqual(names, ["core", "io/clouds", "map"])
        expected = {"saccade/io/clouds/a.hpp": "io/clouds", "saccade/io/clouds/internal/a.hpp": "io/clouds",
                    "saccade/map/internal/m.hpp": "map", "saccade/io/a.hpp": None, "other/map/m.hpp": None,
                    "saccade/a.hpp": None}
        for path, room in expected.items():
            self.assertEqual(rooms.room_of_include(path, names), room, path)

    def test_longest_folder_is_the_room(self):
        self.assertEqual(rooms.room_of("io/clouds/a.hpp", ["io", "io/clouds"]), "io/clouds")
        self.assertEqual(rooms.room_of("io/runs/a.hpp", ["io", "io/clouds"]), "io")

    def test_new_arrow(self):
        self.expect("lib/saccade/core/a.hpp", '#  include "saccade/map/m.hpp"\n',
                    "new arrow core → map: lib/saccade/core/a.hpp:2: includes saccade/map/m.hpp")

    def test_new_arrow_to_a_room_in_a_folder(self):
        self.expect("lib/saccade/map/n.hpp", '\n#include "saccade/io/clouds/a.hpp"\n',
                    "new arrow map → io/clouds: lib/saccade/map/n.hpp:2: includes saccade/io/clouds/a.hpp")

    def test_new_room(self):
        self.plant("lib/saccade/view/CMakeLists.txt", "saccade_room(view SOURCES v.cpp)\n")
        self.expect("lib/saccade/view/v.cpp", '#include "saccade/core/a.hpp"\n',
                    "new arrow view → core: lib/saccade/view/v.cpp:1: includes saccade/core/a.hpp")

    def test_include_of_no_room(self):
        self.expect("apps/cli/main.cpp", '#include "saccade/io/a.hpp"\n',
                    "apps/cli/main.cpp:2: includes saccade/io/a.hpp, which is in no room")

    def test_internal_header_of_another_room(self):
        self.expect("lib/saccade/io/clouds/a.cpp", '#include "saccade/map/internal/m.hpp"\n',
                    "lib/saccade/io/clouds/a.cpp:3: includes saccade/map/internal/m.hpp; "
                    "internal headers are for map and tests alone")

    def test_internal_header_in_an_app(self):
        self.expect("apps/cli/main.cpp", '#include "saccade/map/internal/m.hpp"\n',
                    "apps/cli/main.cpp:2: includes saccade/map/internal/m.hpp; "
                    "internal headers are for map and tests alone")

    def test_an_arrow_less_passes_with_a_note(self):
        self.plant("lib/saccade/io/clouds/a.cpp", "\n")
        status, output = self.check()
        self.assertEqual((status, output[0]), (0, "arrow io/clouds → map is gone"))
        self.assertIn("--write ROOT", output[1])

    def test_write_takes_new_names_of_rooms(self):
        (self.root / "lib/saccade/core").rename(self.root / "lib/saccade/ground")
        for name in ["lib/saccade/map/m.cpp", "lib/saccade/map/internal/m.hpp"]:
            self.plant(name, TREE[name].replace("core", "ground"))
        self.assertEqual(self.check()[0], 1)
        self.assertEqual(self.check("--write")[0], 0)
        self.assertEqual(self.check()[0], 0)

    def test_nothing_to_check_fails(self):
        with tempfile.TemporaryDirectory() as empty:
            (pathlib.Path(empty) / "lib/saccade").mkdir(parents=True)
            self.root = empty
            self.assertEqual(self.check()[0], 1)


if __name__ == "__main__":
    unittest.main()

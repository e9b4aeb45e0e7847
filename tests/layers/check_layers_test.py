#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Plants violations in small trees and expects check_layers to name each, and nothing else."""
import pathlib
import tempfile
import unittest

import check_layers

SPDX = "// SPDX-License-Identifier: Apache-2.0\n"
CMAKE_SPDX = "# SPDX-License-Identifier: Apache-2.0\n"


def clean_tree():
    return {
        "lib/saccade/core/CMakeLists.txt": CMAKE_SPDX + "saccade_room(core SOURCES a.cpp PACKAGES \"Eigen3 3.4\" TBB)\n",
        "lib/saccade/core/a.hpp": SPDX + "#pragma once\n#include <vector>\n#include <Eigen/Core>\n",
        "lib/saccade/core/a.cpp": SPDX + '#include "saccade/core/a.hpp"\n// printf() is not called\n',
        "lib/saccade/map/CMakeLists.txt": CMAKE_SPDX + "saccade_room(map SOURCES m.cpp ROOMS core)\n",
        "lib/saccade/map/m.cpp": SPDX + '#include "saccade/core/a.hpp"\n#include <oneapi/tbb/parallel_for.h>\n',
        "lib/saccade/io/maps/CMakeLists.txt": CMAKE_SPDX + "saccade_room(io_maps SOURCES i.cpp ROOMS core map PACKAGES zstd)\n",
        "lib/saccade/io/maps/i.cpp": SPDX + '#include "saccade/map/m.hpp"\n#include <opencv2/imgcodecs.hpp>\n',
        "apps/cli/main.cpp": SPDX + "#include <iostream>\n",
    }


class CheckLayers(unittest.TestCase):
    def violations(self, changes):
        tree = clean_tree()
        tree.update(changes)
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in tree.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            found, checked = check_layers.check(root)
            self.assertEqual(checked, len([name for name in tree if not name.startswith("docs/")]))
            return found

    def expect(self, name, text, *words):
        found = self.violations({name: text})
        self.assertEqual(len(found), 1, found)
        for word in (name, *words):
            self.assertIn(word, found[0])

    def test_clean_tree_passes(self):
        self.assertEqual(self.violations({}), [])

    def test_include_upwards(self):
        found = self.violations({"lib/saccade/core/a.cpp": SPDX + ' #  include "saccade/map/m.hpp"\n'})
        self.assertTrue(any("room core includes saccade/map/m.hpp" in line for line in found), found)

    def test_core_room_includes_a_format(self):
        found = self.violations({"lib/saccade/map/m.cpp": SPDX + '#include "saccade/io/maps/i.hpp"\n'})
        self.assertTrue(any("room map includes saccade/io/maps/i.hpp" in line for line in found), found)

    def test_link_upwards(self):
        self.expect("lib/saccade/map/CMakeLists.txt", CMAKE_SPDX + "saccade_room(map SOURCES m.cpp ROOMS core io_maps)\n",
                    "room map links io_maps")

    def test_included_but_not_linked(self):
        found = self.violations({"lib/saccade/map/CMakeLists.txt": CMAKE_SPDX + "saccade_room(map SOURCES m.cpp)\n"})
        self.assertEqual(found, ["lib/saccade/map/CMakeLists.txt: core is included but not linked (ROOMS)"])

    def test_page_differs(self):
        page = "| room | what | may include |\n|---|---|---|\n| `core` | a | – |\n| `map` | b | {} |\n| `io/maps` | c | io/files, map |\n"
        self.assertEqual(self.violations({"docs/design/architecture.md": page.format("sensor")}), [])
        found = self.violations({"docs/design/architecture.md": page.format("surfel").replace("| `io/maps`", "| io/maps")})
        self.assertEqual(found, ["docs/design/architecture.md: map may include ['surfel']; the layer test says ['sensor']",
                                 "docs/design/architecture.md: io/maps is not in the table of rooms"])

    def test_unknown_room(self):
        found = self.violations({"lib/saccade/utils/u.hpp": SPDX + "#pragma once\n"})
        self.assertEqual(found, ["lib/saccade/utils: no such room in the order of the layers"])

    def test_opencv_in_core_room(self):
        self.expect("lib/saccade/map/m.cpp", SPDX + "#include <opencv2/core.hpp>\n", "core room map")

    def test_package_of_core_room(self):
        self.expect("lib/saccade/map/CMakeLists.txt",
                    CMAKE_SPDX + "saccade_room(map SOURCES m.cpp ROOMS core PACKAGES OpenCVImages)\n", "OpenCVImages")

    def test_app_in_library(self):
        self.expect("lib/saccade/map/m.cpp", SPDX + '#include "apps/cli/main.hpp"\n', "knows no app")

    def test_printing(self):
        self.expect("lib/saccade/io/maps/i.cpp", SPDX + "void f() { std::cerr << 1; }\n", "never prints")

    def test_missing_spdx(self):
        self.expect("apps/cli/main.cpp", "int main() {}\n", "SPDX")

    def test_long_file(self):
        self.expect("apps/cli/main.cpp", SPDX + "\n" * 400, "401 lines")

    def test_pragma_once(self):
        self.expect("lib/saccade/core/a.hpp", SPDX, "#pragma once")


if __name__ == "__main__":
    unittest.main()

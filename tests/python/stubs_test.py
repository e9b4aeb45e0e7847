#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The type stubs are those of the module as it is, and everything in it says what it is for."""
import inspect
import pathlib
import sys
import unittest

import saccade

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import python_stubs  # noqa: E402


def documented(module):
    """Names of the module's functions, classes and methods, and their docstrings behind the signature."""
    for name, value in vars(module).items():
        if name.startswith("_") or inspect.ismodule(value):
            continue
        if not inspect.isclass(value):
            yield name, value.__doc__.partition("\n")[2].strip()
            continue
        yield name, (value.__doc__ or "").strip()
        for member, method in vars(value).items():
            if not member.startswith("_") and not isinstance(method, property):
                method = method.__func__ if isinstance(method, staticmethod) else method
                yield f"{name}.{member}", (method.__doc__ or "").partition("\n")[2].strip()


class Stubs(unittest.TestCase):
    def test_they_are_up_to_date(self):
        for name, text in python_stubs.stubs().items():
            compile(text, name, "exec")
            self.assertEqual((ROOT / "apps/python/saccade" / name).read_text(), text,
                             "run PYTHONPATH=build/release/python /usr/bin/python3 scripts/python_stubs.py apps/python/saccade")

    def test_everything_has_a_docstring(self):
        for module in (saccade._saccade, saccade.trial):
            for name, doc in documented(module):
                self.assertTrue(doc, f"{name} has no docstring")

    def test_the_submodule_can_be_imported(self):
        from saccade.trial import scenes
        self.assertIn("tabletop-1", scenes())

    def test_no_type_is_left_in_words_of_cpp(self):
        for name, text in python_stubs.stubs().items():
            self.assertNotRegex(text, r"::|_saccade\.", name)


if __name__ == "__main__":
    unittest.main()

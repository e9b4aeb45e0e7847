#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Type stubs of the Python module, from the signatures and docstrings that pybind11 gives it.

python_stubs.py FOLDER   writes __init__.pyi and trial.pyi there (apps/python/saccade); PYTHONPATH names the built module"""
import inspect
import pathlib
import re
import sys

HEAD = '''# SPDX-License-Identifier: Apache-2.0
# Made by scripts/python_stubs.py.
from typing import Any, Callable, Dict, Iterable, Iterator, List, Optional, Sequence, Set, Tuple, Union

import numpy
import numpy.typing
'''
TYPES = ((r"\bsaccade\._saccade\.trial\.", ""), (r"\bsaccade\._saccade\.", ""), (r"numpy\.ndarray\[([\w.]+)\]", r"numpy.typing.NDArray[\1]"),
         (r"\bos\.PathLike\b", "Any"), (r"\bhandle\b|\bobject\b", "Any"), (r"\bfunction\b", "Callable[..., Any]"), (r"\biterable\b", "Iterable[Any]"), (r"\bsequence\b", "Sequence[Any]"))
ARRAY = r"\bnumpy\.ndarray\b"  # as an argument: an array with elements of any type


def split_signature(line):
    """Name, arguments and result of "name(a: A, b: B = 1) -> R"; None where it is none."""
    match = re.fullmatch(r"(\w*)\((.*)\) -> (.+)", line)
    return match.groups() if match else None


def typed(text):
    for pattern, replacement in TYPES:
        text = re.sub(pattern, replacement, text)
    return text


def split_arguments(text):
    """At the commas that lie outside of brackets and quotes."""
    parts, depth, quote, begin = [], 0, None, 0
    for i, c in enumerate(text):
        if quote:
            quote = None if c == quote else quote
        elif c in "'\"":
            quote = c
        elif c in "[({<":
            depth += 1
        elif c in "])}>":
            depth -= 1
        elif c == "," and depth == 0:
            parts.append(text[begin:i].strip())
            begin = i + 1
    return [part for part in parts + [text[begin:].strip()] if part]


def argument(text):
    name, _, rest = text.partition(": ")
    kind, has_default, _ = rest.partition(" = ")
    if name.startswith("*") or not rest:
        return name
    if name == "self":
        return name
    kind = re.sub(ARRAY, "numpy.typing.NDArray[Any]", typed(kind))
    return f"{name}: {kind}{' = ...' if has_default else ''}"


def text_of(doc, indent):
    return f'{indent}"""{doc}"""\n' if doc else ""


def function_stub(name, doc, indent, decorator=""):
    line, _, rest = (doc or "").partition("\n")
    signature = split_signature(line)
    if signature is None:
        raise SystemExit(f"{name} has no signature: {line!r}")
    arguments = ", ".join(argument(part) for part in split_arguments(signature[1]))
    body = text_of(" ".join(rest.split()), indent + "    ") or f"{indent}    ...\n"
    return f"{decorator}{indent}def {name}({arguments}) -> {typed(signature[2])}:\n{body}"


def property_stub(name, value, indent):
    line, _, rest = (value.fget.__doc__ or "").partition("\n")
    signature = split_signature(line)
    result = typed(signature[2]) if signature else "Any"
    body = text_of(" ".join((value.__doc__ or rest).split()), indent + "    ") or f"{indent}    ...\n"
    stub = f"{indent}@property\n{indent}def {name}(self) -> {result}:\n{body}"
    if value.fset is not None:
        stub += f"{indent}@{name}.setter\n{indent}def {name}(self, value: Any) -> None: ...\n"
    return stub


def class_stub(name, cls):
    lines = [f"class {name}:\n", text_of(" ".join((cls.__doc__ or "").split()), "    ")]
    for member, value in cls.__dict__.items():
        if member.startswith("_") and member not in ("__init__", "__len__", "__getitem__", "__iter__", "__next__"):
            continue
        if isinstance(value, property):
            lines.append(property_stub(member, value, "    "))
        elif isinstance(value, staticmethod):
            lines.append(function_stub(member, value.__func__.__doc__, "    ", "    @staticmethod\n"))
        elif member == "__init__" and not split_signature((value.__doc__ or "").partition("\n")[0]):
            continue
        elif callable(value):
            lines.append(function_stub(member, value.__doc__, "    "))
    if len(lines) == 2 and not lines[1]:
        lines.append("    ...\n")
    return "".join(lines)


def module_stub(module, imports=""):
    parts = [HEAD + imports]
    for name, value in sorted(vars(module).items()):
        if name.startswith("_") or inspect.ismodule(value):
            continue
        parts.append(class_stub(name, value) if inspect.isclass(value) else function_stub(name, value.__doc__, ""))
    return "\n\n".join(part.strip("\n") for part in parts) + "\n"


def stubs():
    import saccade
    module = saccade._saccade
    names = ", ".join(sorted(name for name, value in vars(module).items() if inspect.isclass(value)))
    return {"__init__.pyi": module_stub(module, "\nfrom . import trial as trial\n"),
            "trial.pyi": module_stub(module.trial, f"\nfrom . import {names}\n")}


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for name, text in stubs().items():
        compile(text, name, "exec")
        (pathlib.Path(sys.argv[1]) / name).write_text(text)

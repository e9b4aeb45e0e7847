#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Holds README.md and docs/ to the tree: code blocks marked with a file are that file, links lead to pages and headings that
are there, tests named in docs/reference/formats.md are, and docs/README.md leads to every page.   Usage: check_readme.py ROOT"""
import pathlib
import re
import sys

MARKED = re.compile(r"<!-- (\S+) -->\n```\w*\n(.*?)```", re.DOTALL)
LINK = re.compile(r"\]\(([^)#:]*)(?:#([^)]*))?\)")


def pages(root):
    return [root / "README.md", *sorted(root.glob("docs/**/*.md")), root / "CONTRIBUTING.md"]


def check_blocks(root):
    for document in pages(root):
        marked = [(name, block) for name, block in MARKED.findall(document.read_text()) if "/" in name]
        if not marked and document.name == "README.md" and document.parent == root:
            yield "README.md: no marked code block"
        for name, block in marked:
            if (root / name).read_text() != block:
                yield f"{document.relative_to(root)}: the block of {name} differs from the file"


def anchors(text):
    """Anchors that links may name behind #: headings in lower case, without punctuation, blanks as hyphens."""
    headings = re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL), re.MULTILINE)
    plain = [re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading) for heading in headings]
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in plain}


def check_links(root):
    for document in pages(root):
        for target, anchor in LINK.findall(document.read_text()):
            page = document.parent / target if target else document
            if not page.exists():
                yield f"{document.relative_to(root)}: link to {target} leads nowhere"
            elif anchor and page.suffix == ".md" and anchor not in anchors(page.read_text()):
                yield f"{document.relative_to(root)}: {target} has no heading #{anchor}"


def check_index(root):
    """docs/README.md leads to every page; of decisions, to their own index."""
    index = root / "docs" / "README.md"
    named = {(index.parent / target).resolve() for target, _ in LINK.findall(index.read_text())}
    for page in sorted(root.glob("docs/*/*.md")):
        if page.resolve() not in named and (page.parent.name != "decisions" or page.name == "README.md"):
            yield f"docs/README.md: no link to {page.relative_to(root)}"


def check_paths(root):
    """Files named in the paper map and the architecture are there."""
    for name in ["docs/thesis/paper-map.md", "docs/design/architecture.md", "docs/reference/defaults.md"]:
        for path in re.findall(r"`((?:lib|tests|apps|docs|scripts)/[\w./-]+)`", (root / name).read_text()):
            if not (root / path).exists():
                yield f"{name}: {path} is not there"


def check_tests(root):
    """Tests named in the page of formats are there."""
    text = (root / "docs/reference/formats.md").read_text()
    tests = {".".join(found) for path in root.glob("tests/**/*.cpp")
             for found in re.findall(r"^TEST(?:_F|_P)?\((\w+), (\w+)", path.read_text(), re.MULTILINE)}
    named = re.findall(r"`([A-Z]\w+\.[A-Z]\w+)`", text)
    if not named:
        yield "docs/reference/formats.md: no test is named"
    for test in named:
        if test not in tests:
            yield f"docs/reference/formats.md: there is no test {test}"
    for path in re.findall(r"`((?:tests|web)/[\w./-]+)`", text):
        if not (root / path).exists():
            yield f"docs/reference/formats.md: {path} is not there"
    for target in re.findall(r"`(fuzz_\w+)`", text):
        if not (root / "tests/fuzz" / f"{target}.cpp").exists():
            yield f"docs/reference/formats.md: there is no fuzzer {target}"


def main():
    root = pathlib.Path(sys.argv[1])
    problems = [*check_blocks(root), *check_links(root), *check_index(root), *check_paths(root),
                *check_tests(root)]
    for problem in problems:
        print(problem)
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()

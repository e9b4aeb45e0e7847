# SPDX-License-Identifier: Apache-2.0
"""Prose of source files: comments and string literals of C++, TypeScript, CSS, Python, shell and CMake; Markdown without its
code. Lines of one comment are joined, so that a sentence is found across them."""
import bisect
import re

CPP, PYTHON, HASH, MARKDOWN = "cpp", "python", "hash", "markdown"
LANGUAGES = {".hpp": CPP, ".cpp": CPP, ".cu": CPP, ".cuh": CPP, ".ts": CPP, ".mjs": CPP, ".css": CPP, ".py": PYTHON,
             ".sh": HASH, ".cmake": HASH, ".yaml": HASH, ".yml": HASH, ".md": MARKDOWN}
TOKENS = {
    CPP: re.compile(r'(?P<raw>R"(?P<delimiter>[^\s()\\]{0,16})\(.*?\)(?P=delimiter)")'
                    r'|(?P<string>"(?:\\.|[^"\\\n])*"|`(?:\\.|[^`\\])*`)'
                    r"|(?P<single>(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])*')"
                    r"|(?P<line>//[^\n]*)|(?P<block>/\*.*?\*/)", re.DOTALL),
    PYTHON: re.compile(r'(?P<block>""".*?""")|(?P<string>"(?:\\.|[^"\\\n])*"'
                       r"|'(?:\\.|[^'\\\n])*')|(?P<line>#[^\n]*)", re.DOTALL),
    HASH: re.compile(r"(?P<line>(?:(?<=\s)|^)\#(?=[\s!])[^\n]*)", re.MULTILINE),
}
SPDX = "SPDX-License-Identifier"
CODE = re.compile(r"^```.*?^```[^\n]*$|`[^`\n]+`", re.DOTALL | re.MULTILINE)
MARKS = re.compile(r"^\s*(?:///?<?|//!|#+|/\*+<?|\*+/?)?\s*")


class Passage:
    """One comment, run of string literals or Markdown page: its text, and the line of every place in it."""

    def __init__(self, kind):
        self.kind = kind
        self.text = ""
        self._starts, self._lines = [], []

    def add(self, text, line):
        if self.text and self.kind != "string":
            self.text += " "
        self._starts.append(len(self.text))
        self._lines.append(line)
        self.text += text

    def line_of(self, offset):
        return self._lines[bisect.bisect_right(self._starts, offset) - 1]


def language_of(path):
    """Returns the language of a file by its name, None for files without prose."""
    if path.name in ("CMakeLists.txt", "Makefile"):
        return HASH
    return LANGUAGES.get(path.with_suffix("").suffix if path.suffix == ".in" else path.suffix, None)


def passages(language, text):
    """Returns the passages of a file. A comment that has its line to itself continues one at the same column in the line
    before; string literals with nothing but space between them are one passage. The licence line is left out."""
    if language == MARKDOWN:
        return _markdown(text)
    starts = [0] + [end.end() for end in re.finditer("\n", text)]
    found, last_end, last_place = [], 0, None
    for token in TOKENS[language].finditer(text):
        line = bisect.bisect_right(starts, token.start())
        if token["line"] is not None:
            before = text[starts[line - 1]:token.start()]
            if SPDX in token["line"]:
                last_place = None
            else:
                if before.strip() or last_place != (line - 1, len(before)):
                    found.append(Passage("comment"))
                found[-1].add(MARKS.sub("", token["line"]).rstrip(), line)
                last_place = (line, len(before))
        elif token.groupdict().get("block") is not None:
            found.append(Passage("comment"))
            for number, piece in enumerate(token["block"].strip('"').split("\n")):
                found[-1].add(MARKS.sub("", piece).replace("*/", "").strip(), line + number)
        else:
            if not (found and found[-1].kind == "string" and not text[last_end:token.start()].strip()):
                found.append(Passage("string"))
            for number, piece in enumerate(token.group().strip("\"'`").split("\n")):
                found[-1].add(piece, line + number)
        last_end = token.end()
    return found


def _markdown(text):
    """Returns a page as one passage, its code blanked."""
    page = Passage("markdown")
    without_code = CODE.sub(lambda code: re.sub(r"[^\n]", "_", code.group()), text)
    for number, line in enumerate(without_code.split("\n")):
        page.add(line, number + 1)
    return [page]

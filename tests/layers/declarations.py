# SPDX-License-Identifier: Apache-2.0
"""Names that a C++ header declares at namespace scope, read without a compiler: declarations(text) follows braces and
namespaces, and reads each statement's head. Members, friends, forward declarations, specialisations and names in anonymous
namespaces or in ones called detail or internal are left out."""
import re

OUTER_NAMESPACE = "saccade"
NOT_PUBLIC = re.compile(r"^$|^internal$|(?:^|_)detail$")
BLANKED = re.compile(r'R"([^\s()\\]{0,16})\(.*?\)\1"|"(?:\\.|[^"\\\n])*"'
                     r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])*'|//[^\n]*|/\*.*?\*/", re.DOTALL)
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE)
MACRO = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(SACCADE_\w+)", re.MULTILINE)
GROUPED = r"\([^()]*(?:\([^()]*(?:\([^()]*\)[^()]*)*\)[^()]*)*\)"  # parentheses, three deep
NOISE = re.compile(r"\[\[.*?\]\]|\b(?:alignas|noexcept|explicit|decltype|__attribute__|__declspec|requires)\s*" + GROUPED
                   + r"|\bSACCADE_HD\b|\bHWY_\w+\b", re.DOTALL)
OPERATOR = re.compile(r"\boperator\s*(\(\s*\)|\[\s*\]|\"\"\s*\w+|[^\s\w(]+|[\w:\s]+?)\s*\(")
TYPE = re.compile(r"^(?:typedef\s+)?(enum\s+(?:class|struct)|enum|class|struct|union)\b(.*)$", re.DOTALL)


class Unbalanced(Exception):
    """Braces that do not match: what the scanner found is not to be trusted."""


def declarations(text):
    """Returns the sorted, distinct (name, kind) that the header declares in namespace saccade, names of nested namespaces
    with these in front, and macros SACCADE_*."""
    code = BLANKED.sub(lambda found: '""' if found.group()[0] in 'R"' else " ", text)
    found = {(name, "macro") for name in MACRO.findall(code)}
    for scope, statement in _statements(DIRECTIVE.sub("", code)):
        if scope[:1] == [OUTER_NAMESPACE] and not any(map(NOT_PUBLIC.search, scope)):
            for name, kind in _declared(statement):
                found.add(("::".join([*scope[1:], name]), kind))
    return sorted(found)


def _statements(code):
    """Yields (namespaces, statement) of every statement at namespace scope; what stands in its braces becomes {}."""
    scopes, position, begin, pieces = [], 0, 0, []
    while position < len(code):
        character = code[position]
        if character in "([":
            position = _behind_group(code, position)
            continue
        if character == "{":
            head = ("".join(pieces) + code[begin:position]).strip()
            opened = _namespaces(head)
            if opened is not None:
                scopes.append(opened)
                pieces, begin, position = [], position + 1, position + 1
                continue
            end = _behind_group(code, position)
            pieces += [code[begin:position], "{}"]
            begin = position = end
            statement = "".join(pieces)
            if _ends_with_braces(statement, code[end:end + 200].lstrip()[:1]):
                yield sum(scopes, []), statement
                pieces = []
            continue
        if character == ";":
            yield sum(scopes, []), "".join(pieces) + code[begin:position]
            pieces, begin = [], position + 1
        elif character == "}":
            if not scopes:
                raise Unbalanced("a } too many")
            scopes.pop()
            pieces, begin = [], position + 1
        position += 1
    if scopes:
        raise Unbalanced("a } is missing")


def _namespaces(head):
    """Returns the namespaces that a head in front of { opens, [""] for an anonymous one, [] for extern "C"; None for other
    heads."""
    if re.fullmatch(r'extern\s+""', head):
        return []
    found = re.fullmatch(r"(?:inline\s+)?namespace\b(?:\s*\[\[.*?\]\])?\s*([\w:\s]*)", head, re.DOTALL)
    return [re.sub(r"^inline\s+", "", part.strip()) for part in found[1].split("::")] if found else None


def _ends_with_braces(statement, next_character):
    """Returns whether the braces at the end of a statement so far are a function's body, which ends it."""
    head = _head(statement)
    if next_character in (",", "{", ";") or re.match(r"(?:concept|typedef|using)\b", head):
        return False
    return "(" in head and _initializer(head) is None


def _behind_group(code, begin):
    """Returns the place behind the bracket that closes the one at begin."""
    closing, open_brackets = {"(": ")", "[": "]", "{": "}"}, []
    for position in range(begin, len(code)):
        character = code[position]
        if character in closing:
            open_brackets.append(closing[character])
        elif open_brackets and character == open_brackets[-1]:
            open_brackets.pop()
            if not open_brackets:
                return position + 1
        elif character in ")]}":
            raise Unbalanced(f"a {character} where none belongs")
    raise Unbalanced(f"no {closing[code[begin]]} for a {code[begin]}")


def _without_angles(text):
    """Returns the text without template arguments; comparisons stay where no > closes them. Arrows and operators stay."""
    kept, starts, position = [], [], 0
    while position < len(text):
        operator = re.compile(r"operator\s*(?:<=>|<<=?|>>=?|<=|>=|<|>|->\*?)|->|<=|>=").match(text, position)
        if operator:
            kept.append(operator.group())
            position = operator.end()
            continue
        character = text[position]
        if character in "([{":
            end = _behind_group(text, position)
            kept.append(text[position:end])
            position = end
            continue
        if character == "<":
            starts.append(len(kept))
        elif character == ">" and starts:
            del kept[starts.pop():]
            kept.append("<>")
            position += 1
            continue
        kept.append(character)
        position += 1
    return "".join(kept)


def _head(statement):
    """Returns the statement without attributes and template parameters; template arguments of names become <>."""
    head = _without_angles(NOISE.sub(" ", statement)).strip()
    while True:
        shorter = re.sub(r"^(?:template\s*<>|requires\s*\{\})\s*", "", head, count=1)
        if shorter == head:
            return head
        head = shorter


def _initializer(head):
    """Returns the place of the = that begins an initializer; None where there is none."""
    plain = re.sub(r"operator\s*[^\s\w(]+", lambda name: "o" * len(name.group()), _no_groups(head))
    found = re.search(r"(?<![=!<>+\-*/%&|^])=(?!=)", plain)
    return found.start() if found else None


def _no_groups(head):
    """Returns the head with what stands in parentheses blanked; all else stays at its place."""
    return re.sub(GROUPED, lambda group: "(" + " " * (len(group.group()) - 2) + ")", head)


def _declared(statement):
    """Yields the (name, kind) that a statement at namespace scope declares."""
    if re.match(r"\s*template\s+(?:class|struct|union)\b|\s*(?:extern\s+)?template\s+[^<\s]", statement):
        return  # explicit instantiation
    head = _head(statement)
    if not head or re.match(r"(?:static_assert|namespace|friend|asm)\b|using\s+(?:namespace|enum)\b", head):
        return
    concept = re.match(r"concept\s+(\w+)", head)
    if concept:
        yield concept[1], "concept"
    elif re.match(r"using\b", head):
        alias = re.match(r"using\s+(\w+)\s*=", head) or re.match(r"using\s+(?:[\w:<>\s]*::)(\w+)$", head)
        if alias:
            yield alias[1], "alias"
    elif re.match(r"typedef\b", head):
        alias = re.search(r"\(\s*\*\s*(\w+)\s*\)", head) or re.search(r"(\w+)\s*(?:\[[^\]]*\])*$", head)
        yield alias[1], "alias"
    else:
        types = _type(head)
        yield from _function_or_variables(head) if types is None else types


def _type(head):
    """Returns the type that the head defines, in a list; an empty list for forward declarations, specialisations and types of
    members; None for what is no type."""
    type_head = TYPE.match(head)
    if not type_head:
        return None
    before_bases = re.split(r"(?<!:):(?!:)|\{\}", type_head[2])[0].strip()
    name = re.match(r"(?:\w+\s+)*?([\w:]+)(<>)?(?:\s+final)?\s*$", before_bases)
    if not name:
        return None
    if "{}" not in head:
        return [] if re.fullmatch(r"\s*[\w:]+(?:<>)?\s*(?::[\w:\s]+)?", type_head[2]) else None
    return [] if "::" in name[1] or name[2] else [(name[1], type_head[1].split()[0])]


def _function_or_variables(head):
    initializer = _initializer(head)
    declarator = head[:initializer] if initializer is not None else head
    operator = OPERATOR.search(declarator)
    if operator:
        if not re.search(r"::\s*$", declarator[:operator.start()]):
            yield "operator" + re.sub(r"\s+", "" if not operator[1][:1].isalpha() else " ", operator[1].strip()), "function"
        return
    call = re.search(r"([\w:~]+)(?:\s*<>)?\s*\(", declarator)
    brace = declarator.find("{}")
    if call and (brace < 0 or call.start() < brace):
        if "::" not in call[1] and "~" not in call[1]:
            yield call[1], "function"
        return
    kind = "constant" if re.search(r"\b(?:constexpr|const|constinit)\b", declarator) else "variable"
    for part in _no_groups(head).split(","):
        name = re.search(r"([\w:]+)\s*(?:<>)?\s*(?:\[[^\]]*\]\s*)*$", re.split(r"=|\{\}", part)[0])
        if name and "::" not in name[1]:
            yield name[1], kind

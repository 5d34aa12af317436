"""Small defects in C++, each behind a switch (mutant.h): found by rules in text that clang-format has laid out."""
from __future__ import annotations

import re
from dataclasses import dataclass

OPERATORS = {"<": ("Less", ">"), ">": ("Greater", "<"), "<=": ("AtMost", ">="), ">=": ("AtLeast", "<="),
             "==": ("Equal", "!="), "!=": ("Unequal", "=="), "+": ("Plus", "-"), "-": ("Minus", "+"),
             "*": ("Times", "/"), "/": ("Over", "*")}
WRONG = {"<": "<=", ">": ">=", "<=": "<", ">=": ">", "==": "!=", "!=": "==", "+": "-", "-": "+", "*": "/", "/": "*"}
NOT_IN = re.compile(r"\b(constexpr|static_assert|template|using|case|enum|operator|typedef|friend|concept|requires)\b")


@dataclass(frozen=True)
class Point:
    """One possible defect.

    rule:   "comparison", "sign", "constant", "condition", "error", "dropped", "swapped"
    edits:  (position, length of what is replaced, what stands there instead; {k} is the number of the mutant)
    """

    file: str
    line: int
    rule: str
    what: str
    edits: tuple[tuple[int, int, str], ...]


def masked(text: str) -> str:
    """The text with blanks for comments, for what stands in quotes, and for the preprocessor's lines."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\''
                         r'|^[ \t]*#(?:[^\n]*\\\n)*[^\n]*', re.S | re.M)

    def blank(match: re.Match) -> str:
        found = match.group(0)
        if found[0] == "'" and match.start() and text[match.start() - 1].isalnum():
            return found  # 10'000
        return re.sub(r"[^\n]", " ", found)
    return pattern.sub(blank, text)


def in_code(code: str) -> list[bool]:
    """Of each letter, whether it lies in the body of a function."""
    inside, stack, begin = [], [], 0
    for position, letter in enumerate(code):
        if letter == "{":
            head = code[begin:position]
            is_type = re.search(r"\b(struct|class|union|enum|namespace)\b[^()]*$", head)
            is_body = not is_type and (")" in head or (bool(stack) and stack[-1]))
            stack.append(bool(is_body))
        inside.append(bool(stack) and stack[-1])
        if letter == "}" and stack:
            stack.pop()
        if letter in "{};":
            begin = position + 1
    return inside


def closing(code: str, opening: int) -> int:
    """The position of the parenthesis that closes the one at `opening`."""
    depth = 0
    for position in range(opening, len(code)):
        depth += {"(": 1, ")": -1}.get(code[position], 0)
        if depth == 0:
            return position
    return -1


def points(file: str, text: str) -> list[Point]:
    """Every possible defect of a file."""
    code = masked(text)
    inside = in_code(code)
    found = []

    def sentence(position: int) -> str:
        begin = max(code.rfind(mark, 0, position) for mark in ";{}") + 1
        return code[begin:position]

    def add(rule: str, what: str, *edits: tuple[int, int, str]) -> None:
        first = edits[0][0]
        if inside[first] and not NOT_IN.search(sentence(first)):
            found.append(Point(file, text.count("\n", 0, first) + 1, rule, what, edits))

    for match in re.finditer(r"(?<=[\w)\]] )(<=|>=|==|!=|[-<>+*/])(?=\s)", code):
        operator = match.group(1)
        name, last = OPERATORS[operator]
        rule = "comparison" if operator[0] in "<>=!" else "sign"
        add(rule, f"{operator} is {WRONG[operator]}", (match.start(), len(operator),
                                                       f"{operator} shaken_mutants::{name}{{{{{{k}}}}}} {last}"))
    for match in re.finditer(r"(?<![\w.\[])(\d+(?:\.\d+)?(?:e-?\d+)?)(?![\w.'\]])", code):
        number = match.group(1)
        wrong = str(int(number) + 1) if number.isdigit() else "1.0" if float(number) == 0 else f"2 * {number}"
        add("constant", f"{number} is {wrong}", (match.start(), len(number),
                                                 f"shaken_mutants::either({{k}}, {number}, {wrong})"))
    for match in re.finditer(r"\bif \(", code):
        end = closing(code, match.end() - 1)
        condition = code[match.end():end]
        begin = match.end() + condition.rfind(";") + 1
        if end < 0 or re.match(r"\s*(const )?auto\b[^;]*=[^=]", code[begin:end]):
            continue
        is_error = ";" in condition and code[begin:end].strip().startswith("!") and re.match(
            r"\)\s*\{?\s*return\b", code[end:])
        call = "ignored" if is_error else "flipped"
        add("error" if is_error else "condition", "the error is ignored" if is_error else "the condition is turned",
            (begin, 0, f" shaken_mutants::{call}({{k}}, "), (end, 0, ")"))
    for match in re.finditer(r"^[ ]+((?:[\w.]|->|::|\[[^\]\n]*\])+)(\(| [-+*/|&]?= )", code, re.M):
        before = code[:match.start()].rstrip()
        if not before or before[-1] not in ";{})" or match.group(1).startswith(("->", ".")) or match.group(1).split(
                "::")[0] in ("return", "if", "for", "while", "switch", "else", "throw", "delete", "do"):
            continue
        end = code.find(";", match.end())
        depth = code[match.end():end].count("(") - code[match.end():end].count(")")
        if end < 0 or "{" in code[match.end():end] or depth != (-1 if match.group(2) == "(" else 0):
            continue
        start = match.start() + len(match.group(0)) - len(match.group(0).lstrip())
        add("dropped", "the statement is left out", (start, 0, "{{ if (!shaken_mutants::is_on({k})) "),
            (end + 1, 0, " }}"))
    for match in re.finditer(r"(?<=[\w])\(([a-zA-Z_]\w*), ([a-zA-Z_]\w*)\)(?!\s*(?:const)?\s*[{:])", code):
        one, two = match.group(1), match.group(2)
        if one != two:
            add("swapped", f"{one} and {two} are swapped",
                (match.start(1), len(one), f"shaken_mutants::either_of({{k}}, {one}, {two})"),
                (match.start(2), len(two), f"shaken_mutants::either_of({{k}}, {two}, {one})"))
    return found


def mutated(text: str, chosen: dict[int, Point]) -> tuple[str, dict[int, set[int]]]:
    """The text with all of these mutants (number -> Point), and the numbers of those on each of its lines."""
    edits = sorted(((position, length, k, new) for k, point in chosen.items()
                    for position, length, new in point.edits), key=lambda edit: (edit[0], edit[1] > 0, -edit[2]))
    parts, at, lines = [], 0, {}
    for position, length, k, new in edits:
        if position < at:
            continue  # within what another one has replaced
        parts += [text[at:position], new.format(k=k)]
        at = position + length
        lines.setdefault(text.count("\n", 0, position) + 2, set()).add(k)
    parts.append(text[at:])
    first, rest = "".join(parts).split("\n", 1)
    return f'{first}\n#include "base/core/mutant.h"\n{rest}', lines

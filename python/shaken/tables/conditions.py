"""The conditions of `--where`: which rows are kept."""
import operator
import re
import sys
from dataclasses import dataclass
from typing import Any, Callable, Iterable, Iterator, NamedTuple, Sequence

from ..catalogue import KEYS, UNITS
from ..errors import ShakenError, nearest
from ..rows import Row, Target, add_from_scenes, aggregated, field_named, field_names
from ..text import printable, value_text
from ..units import NUMBER, quantity

_COMPARE: dict[str, Callable[[Any, Any], bool]] = {
    "=": operator.eq, "==": operator.eq, "!=": operator.ne, "<": operator.lt, "<=": operator.le, ">": operator.gt,
    ">=": operator.ge}
_TOKEN = re.compile(r"""(?P<open>\()|(?P<close>\))|(?P<quoted>"[^"]*"|'[^']*'|["'].*)|(?P<sign>[<>=!]+)"""
                    r"""|(?P<word>[^ \t\r\n<>=!()"']+)""", re.S)
_JOINTS = {"&&": "and", "&": "and", "||": "or", "|": "or"}
#: Parentheses and `not` within each other; more are no condition that a person writes.
_DEEPEST = 100
_Test = Callable[[Row], bool]


class Problem(NamedTuple):
    """Something wrong with a condition, and the character at which."""

    at: int
    message: str


class _Token(NamedTuple):
    kind: str
    text: str
    at: int

    def is_word(self, *words: str) -> bool:
        return self.kind == "word" and self.text in words

    @property
    def is_value(self) -> bool:
        """Whether it may be a name or a value."""
        return self.kind == "quoted" or (self.kind == "word" and self.text not in ("and", "or", "not"))

    @property
    def shown(self) -> str:
        return "the end" if self.kind == "end" else f"'{printable(self.text)}'"


@dataclass
class _Comparison:
    name: _Token
    sign: _Token
    value: _Token
    field: str = ""
    number: float | None = None

    def holds(self, row: Row) -> bool:
        value = row.fields.get(self.field)
        if self.field not in row.fields:
            return False
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if is_number and self.number is not None:
            return _COMPARE[self.sign.text](value, self.number)
        if self.sign.text not in ("=", "==", "!="):
            return False
        word = value if isinstance(value, str) else value_text(value) or "null"
        return (not is_number and word == self.value.text) == (self.sign.text != "!=")


def _always(_: Row) -> bool:
    return True


class Condition:
    """A condition on a row, of comparisons FIELD OP VALUE with OP one of = == != < <= > >=, joined by `and`, `or`,
    `not` and parentheses; `not` binds most, `or` least:

        rods.length<=4.5mm and (order.mean>0.5 or not state=done)

    FIELD is the name of a field (Row) or the path of any key of a scene. VALUE is a number, of a key with its unit
    where that is not the default one, or a word; what holds spaces or signs stands in quotes. Two numbers are compared
    as numbers, texts and booleans for equality only. A comparison is false for a row without the field.

    `problems` has all that is wrong with its form, in the order of the text:

        any = all {"or" all};  all = one {"and" one};  one = "not" one | "(" any ")" | name sign value [unit]
    """

    def __init__(self, text: str) -> None:
        self.text, self.problems, self.comparisons = text, list[Problem](), list[_Comparison]()
        self._at, self._depth, self._is_too_deep = 0, 0, False
        self._tokens = list(self._read(text))
        self._test = self._whole()
        while self._next.kind == "close":
            self._problem(self._take(), "this ) closes nothing")
            self._skip()
            if self._next.is_word("and", "or"):
                self._take()
                self._whole()
        self.problems.sort(key=lambda problem: problem.at)

    def __call__(self, row: Row) -> bool:
        """Whether it holds, after `bind` without problems."""
        return self._test(row)

    def _read(self, text: str) -> Iterator[_Token]:
        for match in _TOKEN.finditer(text):
            kind, found = match.lastgroup or "", match[0]
            if kind == "quoted":
                is_closed = len(found) > 1 and found[-1] == found[0]
                if not is_closed:
                    self.problems.append(Problem(match.start(), "this quote is never closed"))
                found = found[1:-1] if is_closed else found[1:]
            yield _Token(kind, found, match.start())
        yield _Token("end", "", len(text))

    @property
    def _next(self) -> _Token:
        return self._tokens[self._at]

    def _take(self) -> _Token:
        token = self._next
        self._at += token.kind != "end"
        return token

    def _problem(self, token: _Token, message: str) -> None:
        self.problems.append(Problem(token.at, message))

    def _skip(self) -> None:
        """To where the next comparison may be joined."""
        while not self._next.is_word("and", "or") and self._next.kind not in ("close", "end"):
            self._take()

    def _whole(self) -> _Test:
        """Up to a ) or the end."""
        first = self._any()
        while self._next.kind not in ("close", "end"):
            left = self._take()
            hint = nearest(_JOINTS.get(left.text, left.text), ("and", "or")) if left.kind == "word" else ""
            self._problem(left, f"{left.shown} follows a whole comparison: join them by and, or{hint}")
            self._skip()
            while self._next.is_word("and", "or"):
                self._take()
                self._any()
        return first

    def _any(self) -> _Test:
        return self._joined("or", self._all, any)

    def _all(self) -> _Test:
        return self._joined("and", self._one, all)

    def _joined(self, word: str, part: Callable[[], _Test], holds: Callable[[Iterable[bool]], bool]) -> _Test:
        parts = [part()]
        while self._next.is_word(word):
            self._take()
            parts.append(part())
        return parts[0] if len(parts) == 1 else lambda row: holds(one(row) for one in parts)

    def _one(self) -> _Test:
        is_not = self._next.is_word("not")
        if not is_not and self._next.kind != "open":
            return self._comparison()
        if self._depth == _DEEPEST:
            self._problem(self._next, f"more than {_DEEPEST} parentheses and nots within each other")
            self._is_too_deep = True
            self._at = len(self._tokens) - 1  # what closes them would only be the same again
            return _always
        self._depth += 1
        opened = self._take()
        inner = self._one() if is_not else self._whole()
        if not is_not and self._next.kind == "close":
            self._take()
        elif not is_not and not self._is_too_deep:
            self._problem(opened, "this ( is never closed")
        self._depth -= 1
        return (lambda row: not inner(row)) if is_not else inner

    def _comparison(self) -> _Test:
        name = self._next
        if not name.is_value:
            self._problem(name, f"a comparison is missing before {name.shown}: FIELD OP VALUE, for example "
                          "order.mean>0.5")
            if name.kind == "sign":
                self._take()
            if not name.is_word("and", "or", "not"):
                self._skip()
            return _always
        self._take()
        sign, called = self._next, printable(name.text)
        if sign.kind != "sign":
            self._problem(sign, f"a comparison is missing behind '{called}': {called}>0.5, or {called}=true")
            self._skip()
            return _always
        self._take()
        if sign.text not in _COMPARE:
            self._problem(sign, f"'{sign.text}' compares nothing; one of = != < <= > >= does")
        value = self._next
        if not value.is_value:
            self._problem(value, f"a value is missing before {value.shown}")
            if value.kind in ("sign", "open"):
                self._skip()
            return _always
        self._take()
        if value.kind == "word" and NUMBER.fullmatch(value.text) and self._next.is_word(*UNITS):
            value = value._replace(text=f"{value.text} {self._take().text}")
        made = _Comparison(name, sign, value)
        self.comparisons.append(made)
        return made.holds

    def bind(self, rows: Sequence[Row], all_known: bool = True) -> list[Problem]:
        """Looks the names up in rows (field_named), and values in the units of their fields. Returns everything that is
        wrong: a name that no row has, a value that cannot be compared with it. Keys of a scene are never wrong; neither
        is any other name unless `all_known`, that is if the rows have all names that there can be.
        """
        names = field_names(rows)
        return [problem for of in self.comparisons for problem in _bound(of, names, rows, all_known)]


def _bound(of: _Comparison, names: Sequence[str], rows: Sequence[Row], all_known: bool
           ) -> Iterator[Problem]:
    found, called, is_quoted = field_named(names, of.name.text), printable(of.name.text), of.value.kind == "quoted"
    of.field = found or of.name.text
    if found is None and of.name.text not in KEYS and all_known and rows:
        yield Problem(of.name.at, f"no row has a field '{called}'{nearest(of.name.text, [*names, *KEYS])}")
        return
    wrong = f"{called} is a number: without quotes"
    try:
        number = quantity(of.value.text, KEYS.get(of.name.text, {}).get("of", "plain number"))
        of.number = None if is_quoted else number
    except ShakenError as problem:
        wrong = wrong if is_quoted else printable(str(problem))
    kinds = {type(row.fields[of.field]) for row in rows if row.fields.get(of.field) is not None}
    is_number, is_equality = bool(kinds & {int, float}), of.sign.text in ("=", "==", "!=")
    if kinds and not is_equality and not is_number:
        kind = "a text" if str in kinds else "true or false"
        yield Problem(of.sign.at, f"{called} is {kind}: only = and != compare it")
    elif is_number and of.number is None and not (is_equality and str in kinds):
        yield Problem(of.value.at, wrong)
    elif kinds == {bool} and of.value.text not in ("true", "false"):
        yield Problem(of.value.at, f"{called} is true or false")


def marked(text: str, problems: Sequence[Problem]) -> str:
    """The text, and below it each problem with a caret at its place."""
    return "\n".join([f"  {printable(text)}", *(f"  {' ' * len(printable(text[:at]))}^ {message}"
                                                for at, message in problems)])


def read(texts: Sequence[str]) -> list[Condition]:
    """All of the --where of a command line, of which every one must hold. Raises ShakenError with everything that is
    wrong with the form of all of them."""
    conditions = [Condition(text) for text in texts]
    _refuse([(condition, condition.problems) for condition in conditions])
    return conditions


def _refuse(wrong: Sequence[tuple[Condition, Sequence[Problem]]], after: str = "") -> None:
    if any(problems for _, problems in wrong):
        raise ShakenError("--where:\n" + "\n".join(marked(condition.text, problems) for condition, problems in wrong
                                                   if problems) + after)


def names_in(conditions: Sequence[Condition]) -> list[str]:
    """Every field that is compared, as written, each once."""
    return list(dict.fromkeys(of.name.text for condition in conditions for of in condition.comparisons))


def matching(rows: Sequence[Row], conditions: Sequence[Condition], all_known: bool
             ) -> tuple[list[Row], dict[str, int]]:
    """(the rows for which all conditions hold, the fields that some rows lack and how many do). Raises ShakenError for
    names and values that are wrong."""
    _refuse([(condition, condition.bind(rows, all_known)) for condition in conditions],
            "\n`shaken results --csv` shows all names")
    compared = sorted({of.field for condition in conditions for of in condition.comparisons})
    lacking = {name: sum(name not in row.fields for row in rows) for name in compared}
    return ([row for row in rows if all(condition(row) for condition in conditions)],
            {name: n for name, n in lacking.items() if n})


def selected(target: Target, conditions: Sequence[Condition], aggregate: bool) -> list[Row]:
    """The runs or the points for which the conditions hold. Conditions are on what is shown: with `aggregate` on
    means."""
    add_from_scenes(target, names_in(conditions))
    rows = aggregated(target.rows) if aggregate else target.rows
    # without any summary nobody knows which numbers there will be
    all_known = any(row.source.get("summary") for row in target.rows)
    kept, lacking = matching(rows, conditions, all_known)
    for name, n in lacking.items():
        print(f"{n} of {len(rows)} {'points' if aggregate else 'runs'} lack {printable(name)}: comparisons with it are "
              "false for them", file=sys.stderr)
    return kept

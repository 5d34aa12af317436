"""Small defects in Python, each behind a switch: found and written by way of the syntax tree."""
from __future__ import annotations

import ast
import copy
from dataclasses import dataclass
from typing import Iterator

COMPARED = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
            ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In}
COMPUTED = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult}
JOINED = {ast.And: ast.Or, ast.Or: ast.And}


@dataclass(frozen=True)
class Point:
    """One possible defect: the node that it is about, and the rule by which it changes."""

    file: str
    line: int
    rule: str
    what: str
    node: int  #: its place in the order of `ast.walk`


def wrong(node: ast.AST) -> tuple[str, str, ast.AST] | None:
    """Rule, words and the node as the mutant has it; None where no rule fits."""
    new = copy.deepcopy(node)
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        new.ops = [COMPARED[type(node.ops[0])]()]
        return "comparison", f"{ast.unparse(node)} is {ast.unparse(new)}", new
    if isinstance(node, ast.BinOp) and type(node.op) in COMPUTED and not isinstance(node.left, ast.JoinedStr):
        new.op = COMPUTED[type(node.op)]()
        return "sign", f"{ast.unparse(node)} is {ast.unparse(new)}", new
    if isinstance(node, ast.BoolOp):
        new.op = JOINED[type(node.op)]()
        return "condition", f"{ast.unparse(node)} is {ast.unparse(new)}", new
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        new.value = node.value + 1 if isinstance(node.value, int) else 2 * node.value or 1.0
        return "constant", f"{node.value} is {new.value}", new
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        return "condition", f"{ast.unparse(node)} is {ast.unparse(node.operand)}", ast.Call(
            ast.Name("bool", ast.Load()), [node.operand], [])
    if isinstance(node, ast.Call) and len(node.args) == 2 and not node.keywords and all(
            isinstance(argument, ast.Name) for argument in node.args):
        new.args.reverse()
        return "swapped", f"{ast.unparse(node)} is {ast.unparse(new)}", new
    if isinstance(node, (ast.Expr, ast.AugAssign)) and not isinstance(getattr(node, "value", None), (
            ast.Constant, ast.Yield, ast.YieldFrom, ast.Await)):
        return "dropped", f"{ast.unparse(node)} is left out", ast.Pass()
    return None


def _inner(tree: ast.Module) -> Iterator[tuple[int, ast.AST]]:
    """Every node within a function, but annotations and what format strings are made of, with its place in the walk."""
    skipped = set()
    bodies = set()
    for node in ast.walk(tree):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            for part in node.body:
                bodies.update(map(id, ast.walk(part)))
            for part in (node.args, node.returns, *node.decorator_list):
                skipped.update(map(id, ast.walk(part)) if part else ())
        if isinstance(node, (ast.JoinedStr, ast.AnnAssign, ast.Match if hasattr(ast, "Match") else ast.JoinedStr)):
            skipped.update(map(id, ast.walk(node)))
    for place, node in enumerate(ast.walk(tree)):
        if id(node) in bodies and id(node) not in skipped:
            yield place, node


def points(file: str, text: str) -> list[Point]:
    """Every possible defect of a file."""
    found = []
    for place, node in _inner(ast.parse(text)):
        if made := wrong(node):
            found.append(Point(file, node.lineno, made[0], made[1], place))
    return found


def mutated(text: str, chosen: dict[int, Point]) -> str:
    """The text with all of these mutants (number -> Point); comments are lost."""
    tree = ast.parse(text)
    numbers = {point.node: k for k, point in chosen.items()}
    by_node = {id(node): numbers[place] for place, node in enumerate(ast.walk(tree)) if place in numbers}

    class Switched(ast.NodeTransformer):
        def visit(self, node: ast.AST) -> ast.AST:
            node_id = id(node)
            made = wrong(node) if node_id in by_node else None
            right = self.generic_visit(node)
            if made is None:
                return right
            is_on = ast.Call(ast.Name("_mutant_is_on", ast.Load()), [ast.Constant(by_node[node_id])], [])
            if isinstance(node, ast.stmt):
                return ast.If(ast.UnaryOp(ast.Not(), is_on), [right], [])
            return ast.IfExp(is_on, made[2], right)

    tree = Switched().visit(tree)
    after = 0
    while after < len(tree.body) and (
            isinstance(tree.body[after], ast.ImportFrom) and tree.body[after].module == "__future__"
            or after == 0 and isinstance(tree.body[0], ast.Expr)):
        after += 1
    tree.body.insert(after, ast.parse("from shaken._mutant import is_on as _mutant_is_on").body[0])
    return ast.unparse(ast.fix_missing_locations(tree)) + "\n"


#: The switch, as shaken/_mutant.py: it reads what mutant.h reads.
SWITCH = '''
import os
ON = int(os.environ.get("SHAKEN_MUTANT", -1))
SEEN_FILE = os.environ.get("SHAKEN_MUTANTS_SEEN")
seen = set()


def is_on(k):
    if SEEN_FILE and k not in seen:
        seen.add(k)
        with open(SEEN_FILE, "a") as file:
            file.write(f"{k}\\n")
    return k == ON
'''

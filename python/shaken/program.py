"""What the programs of the package share: the words that they are given, how they end, and what they say then."""
import argparse
import importlib.util
import io
import os
import sys
from typing import Callable, NoReturn, TypeVar

from .errors import ShakenError
from .text import json_text, printable

OK, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130
_Words = TypeVar("_Words")


def not_installed(*modules: str) -> str:
    """In words which of these modules are not installed, and how they are; "" where all are."""
    missing = [name for name in modules if importlib.util.find_spec(name) is None]
    return (f"{' and '.join(missing)} of {sys.executable} {'are' if len(missing) > 1 else 'is'} not installed: "
            f"`apt install {' '.join(f'python3-{name}' for name in missing)}`") if missing else ""


class Options(argparse.ArgumentParser):
    """Options that are described where the client declares them: of a wrong one, one line without a usage."""

    def __init__(self) -> None:
        super().__init__(prog="shaken", add_help=False, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        sys.exit(failed(message.removeprefix("argument "), BAD_INPUT, "--json" in sys.argv))


def failed(message: str, code: int, as_json: bool) -> int:
    """The exit code of a program that ends for a reason, which it says; on stdout, too, where all is JSON."""
    if as_json:
        print(json_text({"error": message, "exit_code": code}))
    print(f"shaken: {printable(message, lines=True)}", file=sys.stderr)
    return code


def run(work: Callable[[_Words], int | None], given: _Words, as_json: bool = False, *, code: int | None = None,
        interrupted: str = "interrupted", say: Callable[[str, int, bool], int] = failed) -> int:
    """The exit code of a program that does `work` with what it was given, and says why where it cannot.

    code: where the work is refused, in place of that of the ShakenError
    say:  prints (reason, exit code, whether all is JSON) and returns the code
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="surrogateescape")  # names of files, whatever their bytes
    try:
        done = work(given) or OK
        sys.stdout.flush()
        return done
    except ShakenError as problem:
        return say(str(problem), problem.exit_code if code is None else code, as_json)
    except OSError as error:  # a full disk; or whoever read has gone, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED if isinstance(error, BrokenPipeError) else say(str(error), FAILED, as_json)
    except KeyboardInterrupt:
        print(interrupted, file=sys.stderr)
        return INTERRUPTED

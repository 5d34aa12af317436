# SPDX-License-Identifier: MIT
"""What the client hands on to be tabulated or drawn: python3 -m shaken.tables results|plot|fields|inset OPTION...

The options of users are described where the client declares them (client/verbs/results.cpp, plot.cpp). Names for the
shell and the inset of pictures have no help."""
from __future__ import annotations

import argparse
import io
import os
import sys
from typing import Sequence

from ..errors import ShakenError
from ..needed import not_installed
from ..options import Options, failed

OK, FAILED = 0, 1


def _options(words: Sequence[str]) -> argparse.Namespace:
    parser = Options()
    parser.add_argument("id", nargs="?", default="")
    parser.add_argument("--root")
    for name in ("where", "job"):
        parser.add_argument(f"--{name}", action="append", default=[])
    for flag in ("aggregate", "csv", "json", "map"):
        parser.add_argument(f"--{flag}", action="store_true")
    for name in ("columns", "x", "y", "out", "format", "width"):
        parser.add_argument(f"--{name}", default="")
    return parser.parse_args(words[1:])


def _run(verb: str, options: argparse.Namespace) -> None:
    if verb == "plot":
        missing = not_installed()
        if missing:
            raise ShakenError(missing)
        from .plot import plot
        plot(options)
        return
    from . import inset, results
    verbs = {"results": results.results, "fields": results.fields, "inset": inset.inset}
    verbs[verb](options)


def main(words: Sequence[str]) -> int:
    options, message, code = _options(words), "", OK
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="surrogateescape")  # names of files, whatever their bytes
    try:
        _run(words[0], options)
        sys.stdout.flush()
    except ShakenError as problem:
        message, code = str(problem), problem.exit_code
    except (AttributeError, KeyError, TypeError) as error:
        message, code = f"an answer of the daemon is not as expected ({error!r}): is it of another version?", FAILED
    except OSError as error:  # a full disk; or whoever read has gone, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        message, code = "" if isinstance(error, BrokenPipeError) else str(error), FAILED
    return failed(message, code, options.json) if message else code

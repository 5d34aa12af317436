# SPDX-License-Identifier: MIT
"""What `shaken-bench` calls to have its figures drawn: python3 -m shaken.plots."""
from __future__ import annotations

import argparse
import io
import os
import sys
from pathlib import Path
from typing import Sequence

from ..errors import ShakenError

NOTHING, BAD_INPUT = 1, 2


def main(arguments: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog="python3 -m shaken.plots", description="Draws figures by matplotlib.")
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("check", help="whether figures can be drawn here: says by what")
    bench = commands.add_parser("bench", help="what shaken-bench has measured")
    bench.add_argument("report", help="NAME.json, as it has written")
    bench.add_argument("-o", "--out", default=".", help="folder of the pictures")
    bench.add_argument("--width", default="", help="89mm, 120mm or 183mm")
    verdict = commands.add_parser("verdict", help="what the rows of `shaken-bench accuracy` come to, in words")
    verdict.add_argument("report", help="NAME.json, as it has written; - is stdin")
    options = parser.parse_args(arguments)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="surrogateescape")  # names of files, whatever their bytes
    try:
        if options.command == "check":
            import h5py  # noqa: F401, which must go with the same numpy
            import matplotlib
            print(f"matplotlib {matplotlib.__version__} of {sys.executable}")
        elif options.command == "verdict":
            from .bench import read_report
            from .accuracy import verdict_text
            print(verdict_text(read_report(Path(options.report))), end="", flush=True)
        else:
            from .bench import draw_report
            for path in draw_report(Path(options.report), Path(options.out), options.width or None):
                print(path, flush=True)
    except BrokenPipeError:  # whoever read has gone, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return NOTHING
    except ShakenError as problem:
        print(problem)
        return BAD_INPUT
    return 0

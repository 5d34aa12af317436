"""What `shaken-bench` calls to have its figures drawn: python3 -m shaken.plots."""
import argparse
import logging
import sys
from pathlib import Path
from typing import Sequence

from ..errors import ShakenError
from ..program import not_installed, run


def _work(options: argparse.Namespace) -> None:
    if missing := not_installed("matplotlib", "numpy", "h5py"):
        raise ShakenError(missing)
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # that it lists the fonts, the first time
    if options.command == "check":
        import matplotlib
        __import__("h5py")  # which must go with the same numpy
        print(f"matplotlib {matplotlib.__version__} of {sys.executable}")
    elif options.command == "verdict":
        from .accuracy import verdict_text
        from .bench import read_report
        print(verdict_text(read_report(Path(options.report))), end="", flush=True)
    else:
        from .bench import draw_report
        for path in draw_report(Path(options.report), Path(options.out), options.width or None):
            print(path, flush=True)


def _say(reason: str, code: int, _: bool) -> int:
    print(reason)
    return code


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
    return run(_work, parser.parse_args(arguments), say=_say)

# SPDX-License-Identifier: MIT
"""The words that the client hands on, and what it says where they cannot be followed."""
from __future__ import annotations

import argparse
import sys
from typing import NoReturn

from .tables.text import json_text, printable


class Options(argparse.ArgumentParser):
    """Options that are described where the client declares them: of a wrong one, one line without a usage."""

    def __init__(self) -> None:
        super().__init__(prog="shaken", add_help=False, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        sys.exit(failed(message.removeprefix("argument "), 2, "--json" in sys.argv))


def failed(message: str, code: int, as_json: bool) -> int:
    """The exit code of a program that ends for a reason, which it says; on stdout, too, where all is JSON."""
    if as_json:
        print(json_text({"error": message, "exit_code": code}))
    print(f"shaken: {printable(message, lines=True)}", file=sys.stderr)
    return code

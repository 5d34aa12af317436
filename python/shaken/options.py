# SPDX-License-Identifier: MIT
"""The words that the client hands on."""
from __future__ import annotations

import argparse
from typing import NoReturn


class Options(argparse.ArgumentParser):
    """Options that are described where the client declares them: of a wrong one, one line without a usage."""

    def __init__(self) -> None:
        super().__init__(prog="shaken", add_help=False, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"shaken: {message.removeprefix('argument ')}\n")

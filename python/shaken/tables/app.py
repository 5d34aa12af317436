"""What the client hands on to be tabulated, drawn, exported or packed:
python3 -m shaken.tables results|plot|export|pack|unpack|fields|inset OPTION...

The options of users are described where the client declares them (client/verbs/results.cpp and so on). Names for the
shell and the inset of pictures have no help."""
import argparse
import importlib
from typing import Sequence

from ..errors import DaemonFailed, Failed, ShakenError
from ..program import Options, not_installed, run


def _options(words: Sequence[str]) -> argparse.Namespace:
    parser = Options()
    parser.add_argument("ids", nargs="*")
    parser.add_argument("--root")
    for name in ("where", "job", "observable"):
        parser.add_argument(f"--{name}", action="append", default=[])
    for flag in ("aggregate", "csv", "frames", "json", "last", "list", "map"):
        parser.add_argument(f"--{flag}", action="store_true")
    for name in ("columns", "x", "y", "out", "format", "width", "run", "from", "to", "every"):
        parser.add_argument(f"--{name}", default="")
    options = parser.parse_args(words[1:])
    options.id = options.ids[0] if options.ids else ""
    return options


#: What works for each verb: the module, and what it needs that not everybody has.
_WORK = {"plot": ("plot", "matplotlib", "numpy", "h5py"), "export": ("export", "numpy", "h5py"),
         **dict.fromkeys(("pack", "unpack"), ("pack", "numpy", "h5py")),
         **dict.fromkeys(("results", "fields", "inset"), ("results",))}


def _run(verb: str, options: argparse.Namespace) -> None:
    module, *needed = _WORK[verb]
    if missing := not_installed(*needed):
        raise ShakenError(missing)
    getattr(importlib.import_module(f".{module}", __package__), verb)(options)


def main(words: Sequence[str]) -> int:
    def work(options: argparse.Namespace) -> None:
        try:
            _run(words[0], options)
        except (AttributeError, KeyError, TypeError) as error:
            if words[0] == "export":
                raise Failed(f"a file of the run is not as expected ({error!r})") from None
            raise DaemonFailed(f"an answer of the daemon is not as expected ({error!r}): is it of another version?"
                               ) from None

    options = _options(words)
    return run(work, options, options.json)

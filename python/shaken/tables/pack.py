"""`shaken pack` and `shaken unpack`."""
import argparse
import json
from pathlib import Path

from .. import packed
from ..daemon import Daemon
from ..errors import ShakenError
from ..rows import target_of
from ..text import json_text, printable


def _counted(n: int) -> str:
    return f"{n} run{'' if n == 1 else 's'}"


def pack(options: argparse.Namespace) -> None:
    if not options.ids:
        raise ShakenError("say what to pack: a sweep, a job, or a folder of runs")
    directories: list[str] = []
    waiting, name = 0, ""
    for word in options.ids:
        if (Path(word) / "summary.json").exists():
            directories.append(word)
            name = name or Path(word).resolve().name
            continue
        target = target_of(Daemon(options.root), word)
        jobs, name = target.jobs, name or (target.name if target.is_sweep else target.id[:8])
        done = [job["directory"] for job in jobs if job["state"] == "done"]
        waiting += len(jobs) - len(done)
        directories += done
    file = options.out or name + packed.SUFFIX
    ids = packed.pack(directories, file, options.frames)
    size = Path(file).stat().st_size
    if options.json:
        print(json_text({"file": file, "bytes": size, "runs": ids, "n_not_done": waiting}))
        return
    left_out = f"; {waiting} not done, and left out" if waiting else ""
    print(f"{_counted(len(ids))} in {printable(file)}, {size / 1000:.0f} kB{left_out}")


def unpack(options: argparse.Namespace) -> None:
    if len(options.ids) != 1:
        raise ShakenError("say which file to unpack, one at a time")
    file = options.ids[0]
    name = Path(file).name
    folder = options.out or name.removesuffix(packed.SUFFIX)
    if folder in ("", name):
        folder = name + ".runs"
    directories = packed.unpack(file, folder)
    if options.json:
        print(json_text({"folder": folder, "directories": list(map(str, directories))}))
        return
    shown = printable(folder.rstrip("/"))
    simulated = [each for each in directories if not json.loads((each / "summary.json").read_text()).get("frames")]
    again = (f"; once more, with the same bits, by `shaken run {printable(str(simulated[0]))}/scene.json`" if simulated
             else "; measured, not simulated: no run gives that again")
    print(f"{_counted(len(directories))} in {shown}/: `shaken results {shown}/`{again}")

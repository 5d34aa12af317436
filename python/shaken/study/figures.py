"""The figures: the paper's own by its numbers, and those beyond it by names."""
import difflib
from pathlib import Path
from typing import Iterable

from ..errors import ShakenError
from ..plots.save import origin_list
from . import figures_motion as motion, figures_order as order, figures_structure as structure
from .evidence import Evidence
from .material import Figure, Material

FIGURES: tuple[Figure, ...] = (
    order.start, order.order, order.order_statistics, structure.g2, structure.g2_map, structure.distances,
    structure.layers, motion.diffusion, motion.tilt, motion.paths, motion.memory, motion.rotation, motion.defects,
    structure.layer_trends, structure.larger_box, structure.ends, structure.gap, structure.taper, order.steady,
    order.shaking, order.scaling, structure.elasticity, motion.diffusion_more, motion.melting, structure.fluctuations,
    order.equilibrium, motion.model, order.movies, motion.accuracy)


def chosen(words: Iterable[str]) -> list[Figure]:
    """The figures of these numbers or names; all if there are none. Raises ShakenError with all that is unknown."""
    wanted = list(words)
    known = {word: figure for figure in FIGURES for word in (figure.name, figure.number) if word}
    unknown = [word for word in wanted if word not in known]
    if unknown:
        meant = [match for word in unknown for match in difflib.get_close_matches(word, known, 1)]
        way_out = f" (did you mean {', '.join(meant)}?)" if meant else f"; there are {' '.join(f.id for f in FIGURES)}"
        raise ShakenError(f"no such figure: {', '.join(unknown)}{way_out}")
    return [known[word] for word in dict.fromkeys(wanted)] if wanted else list(FIGURES)


def draw(figures: Iterable[Figure], evidence: Evidence, out: Path, *, width: float = 183.0, form: str = "png",
         origin: dict[str, str] | None = None) -> list[Path]:
    """Draws figures into a folder, each with its data as CSV; those whose runs are all missing are left out."""
    material = Material(evidence, width)
    return [figure.draw(material).save(out / f"{figure.file}.{form}", {**(origin or {}), "Figure": figure.title,
                                                                       **runs_of(evidence, figure)})
            for figure in figures if any(evidence[name] for name in figure.sets)]


def runs_of(evidence: Evidence, figure: Figure) -> dict[str, str]:
    """Which runs of which versions a figure is of."""
    runs = evidence.joined(*figure.sets)
    versions = sorted({"shaken {shaken}, physics {physics}".format(**run.summary["versions"]) for run in runs})
    return {"Computed by": origin_list(versions), "Runs": origin_list(sorted(run.id for run in runs))}

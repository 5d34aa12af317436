"""The figures: the paper's own by its numbers, and those beyond it by names."""
import difflib
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Iterable

from ..errors import ShakenError
from ..plots.save import origin_list
from ..plots.sheet import Sheet
from . import figures_motion, figures_order, figures_structure
from .evidence import Evidence
from .material import Material


@dataclass(frozen=True)
class Figure:
    """A figure of the paper, or one beyond it.

    number: in the paper, "14"; empty for all others
    name:   "defects"
    title:  what it shows
    sets:   what it is drawn from (sets.ORDER)
    """

    number: str
    name: str
    title: str
    sets: tuple[str, ...]
    draw: Callable[[Material], Sheet]

    @property
    def id(self) -> str:
        return self.number or self.name

    @property
    def file(self) -> str:
        """The name of its files without the suffix: "fig14-defects", or "gap"."""
        return f"fig{int(self.number):02d}-{self.name}" if self.number else self.name


FIGURES: tuple[Figure, ...] = (
    Figure("2", "start", "Rods as they lie, and S(t) from the aligned start", ("long-rods", "forgetting"),
           figures_order.start),
    Figure("3", "order", "Mean order against area fraction, and the phase diagram",
           ("long-rods", "short-rods", "crossings", "phases", "layers", "layer-trends"), figures_order.order),
    Figure("4", "order-statistics", "Fluctuations of the order: P[S], standard deviation, Binder cumulant",
           ("long-rods", "short-rods"), figures_order.order_statistics),
    Figure("5", "g2", "Orientational correlation G₂(r) on logarithmic axes", ("short-rods", "long-rods"),
           figures_structure.g2),
    Figure("6", "g2-map", "G₂ along and across the director: disorder, nematic, layers", ("dilute", "layers"),
           figures_structure.g2_map),
    Figure("7", "distances", "Pair correlation g: against distance, along and across the director",
           ("short-rods", "long-rods", "layers"), figures_structure.distances),
    Figure("8", "layers", "Layers turned by ±θ, their angle and their wavelength",
           ("layers", "layer-trends", "long-rods", "strip", "fluid-start"),
           figures_structure.layers),
    Figure("9", "diffusion", "Mean square displacement, D at short and at long times",
           ("diffusion", "short-rods", "diffusion-along", "long-rods"), figures_motion.diffusion),
    Figure("10", "tilt", "How a rod swims: velocity against tilt", ("mechanism",), figures_motion.tilt),
    Figure("11", "paths", "Paths of single rods, and how long they persist; 0.2 s, below 0.70, is half the window "
           "of 400 ms over which velocities are averaged", ("mechanism",), figures_motion.paths),
    Figure("12", "memory", "Correlations in time: orientation C₂, velocity C_v",
           ("short-rods", "long-rods", "diffusion-along"), figures_motion.memory),
    Figure("13", "rotation", "Mean square angular displacement and rotational diffusion", ("short-rods", "long-rods"),
           figures_motion.rotation),
    Figure("14", "defects", "Defects of rods that are ordered here and there", ("no-order",), figures_motion.defects),
    Figure("", "layer-trends", "Angle, wavelength and order of the layers against packing",
           ("layers", "layer-trends", "strip"), figures_structure.layer_trends),
    Figure("", "larger-box", "Layers in a larger box", ("layer-trends", "larger-box"),
           figures_structure.larger_box),
    Figure("", "ends", "Blunt rods, from rows and from a fluid", ("layer-trends", "fluid-start", "strip"),
           figures_structure.ends),
    Figure("", "gap", "The gap between the plates: crystal, layers, no layers", ("gaps", "layers"),
           figures_structure.gap),
    Figure("", "taper", "Tapered and untapered rods, from a fluid", ("strip", "layers", "taper"),
           figures_structure.taper),
    Figure("", "steady", "The axis along which rods of 3.5 mm order", ("layer-trends", "turned"), figures_order.steady),
    Figure("", "shaking", "Order and motion against the strength of shaking", ("shaking",), figures_order.shaking),
    Figure("", "scaling", "Order against the size of the box, and what the director's waves predict of it",
           ("long-rods", "size", "dilute", "elasticity", "long-range"), figures_order.scaling_with_size),
    Figure("", "elasticity", "Director fluctuations: bend against splay", ("elasticity", "size", "long-range"),
           figures_structure.elasticity),
    Figure("", "diffusion-more", "Whether MSD/t levels off, and exponents",
           ("diffusion", "short-rods", "diffusion-along", "long-rods"), figures_motion.diffusion_more),
    Figure("", "melting", "Defects against packing and order, and how +1/2 defects move",
           ("long-rods", "short-rods", "crossings", "phases"), figures_motion.melting),
    Figure("", "fluctuations", "Number fluctuations", ("short-rods", "long-rods"), figures_structure.fluctuations),
    Figure("", "equilibrium", "The equilibrium reference: e = 1, no friction",
           ("equilibrium", "short-rods", "long-rods", "crossings", "phases"), figures_order.equilibrium),
    Figure("", "model", "What the paper leaves open: frequency, number of rods, beads, moments of inertia",
           ("frequency", "density", "beads", "diffusion", "short-rods", "inertia"), figures_motion.model),
    Figure("", "movies", "Films S1 to S7, as they are made", ("movies",), figures_order.films),
    Figure("", "accuracy", "The same points at the paper's time step and at the desk's", ("long-rods",),
           figures_motion.accuracy),
)


def chosen(words: Iterable[str]) -> list[Figure]:
    """The figures of these numbers or names; all if there are none. Raises ShakenError with all that is unknown."""
    wanted = list(words)
    known = {word: figure for figure in FIGURES for word in (figure.name, figure.number) if word}
    unknown = [word for word in wanted if word not in known]
    if unknown:
        meant = [match for word in unknown for match in difflib.get_close_matches(word, known, 1)]
        raise ShakenError(f"no such figure: {', '.join(unknown)}" + (f" (did you mean {', '.join(meant)}?)" if meant
                                                                     else
                          f"; there are {' '.join(f.id for f in FIGURES)}"))
    return [known[word] for word in dict.fromkeys(wanted)] if wanted else list(FIGURES)


def draw(figures: Iterable[Figure], evidence: Evidence, out: Path, *, width: float = 183.0, form: str = "png",
         origin: dict[str, str] | None = None) -> list[Path]:
    """Draws figures into a folder, each with its data as CSV; those whose runs are all missing are left out."""
    material = Material(evidence, width)
    drawn = []
    for figure in figures:
        if not any(evidence[name] for name in figure.sets):
            continue
        sheet = figure.draw(material)
        drawn.append(sheet.save(out / f"{figure.file}.{form}",
                                {**(origin or {}), "Figure": figure.title, **runs_of(evidence, figure)}))
    return drawn


def runs_of(evidence: Evidence, figure: Figure) -> dict[str, str]:
    """Which runs of which versions a figure is of."""
    runs = evidence.joined(*figure.sets)
    versions = sorted({"shaken {shaken}, physics {physics}".format(**run.summary["versions"]) for run in runs})
    return {"Computed by": origin_list(versions), "Runs": origin_list(sorted(run.id for run in runs))}

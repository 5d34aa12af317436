"""What the paper states, and the runs' answer to each statement.

Each check takes the Evidence and returns a Finding; the checks are in `order_checks`, `structure_checks`,
`layer_checks` and `motion_checks`, by subject.
"""
import math
from dataclasses import dataclass
from typing import Any, Callable, Iterable

from . import layer_checks, motion_checks, order_checks, structure_checks
from .evidence import Evidence, Read, box_of, box_text, reads
from .rules import NO_DATA, Finding, NoRuns


@dataclass(frozen=True)
class Statement:
    """A sentence of the paper.

    id:     its name, "steady-state"
    figure: the paper's number, or the name of a figure beyond them
    says:   the sentence, in short
    ask:    what the runs say to it; it may raise NoRuns
    note:   how it is read, or why it can only be refuted
    role:   how far its verdict is evidence: CALIBRATES the model, and so stands outside of the tally, or HARDLY_FAILS;
            empty where it is evidence as all others are
    """

    id: str
    figure: str
    says: str
    ask: Callable[[Evidence], Finding]
    note: str = ""
    role: str = ""

    def check(self, evidence: Evidence) -> Finding:
        """What the runs say to it."""
        try:
            return self.ask(evidence)
        except NoRuns:
            return Finding()


#: The model was chosen so that it holds.
CALIBRATES = "used for calibration"
#: It holds by symmetry, by construction, or by a factor of hundreds.
HARDLY_FAILS = "could hardly fail"

STATEMENTS: tuple[Statement, ...] = (
    Statement("steady-state", "2", "Rods start aligned, S(0) = 1, and are steady after 400 to 600 s (ℓ = 4.5 mm)",
              order_checks.steady_after_the_start),
    Statement("ordered", "3", "Long rods (ℓ = 4.5 mm) at area fraction 0.75 are ordered, S about 0.9",
              order_checks.ordered_when_dense,
              "in a box narrower than the paper's, which orders more easily"),
    Statement("disordered", "3", "At 0.45 they are not: ⟨S⟩ < 0.5, and nothing of it far away or in larger boxes",
              order_checks.disordered_when_dilute),
    Statement("short", "3", "Rods shorter than 3.5 mm do not order at any packing",
              order_checks.short_rods_do_not_order,
              "a narrow box orders its rods: there only disorder counts"),
    Statement("transition", "3", "The area fraction at which order sets in falls with the length",
              order_checks.transition_falls_with_length),
    Statement("saturates", "3", "⟨S⟩ of rods longer than 3.5 mm rises with packing to about 1", order_checks.saturates,
              "whether it rises continuously takes runs from disorder too, which these are not; the box is narrower "
              "than the paper's"),
    Statement("longer-order", "3", "At the same area fraction rods order when they are made longer",
              order_checks.longer_rods_order, "S grows by a factor of ten; the box is narrower than the paper's",
              HARDLY_FAILS),
    Statement("transition-size", "scaling", "The area fraction at which order sets in rises with the box",
              order_checks.transition_rises_with_size, "S of a finite system always falls with the box", HARDLY_FAILS),
    Statement("long-range", "scaling", "The order is long-range", order_checks.long_range,
              "S(L) against what the waves of the director make of it without a free parameter. That S falls so in "
              "these boxes does not show that it never levels off in wider ones"),
    Statement("unimodal", "4", "P[S] has one peak at every packing (ℓ = 4.5 mm)", order_checks.one_peak,
              "independent samples of all replicas are added up; 50 are asked for"),
    Statement("broadest", "4", "S fluctuates most near the transition", order_checks.broadest_at_the_transition),
    Statement("oblique", "steady", "ℓ = 3.5 mm at 0.85 orders along an oblique axis", order_checks.oblique_axis,
              "asked of runs that start turned by 30 degrees: whether such an axis lasts. Those that start along a "
              "side stay along it, so that none is seen to come about"),
    Statement("activity", "shaking", "Γ is a measure of the activity, and at Γ = 0 there is none",
              order_checks.activity,
              "at Γ = 0: that the plates give no energy and what the rods had at the start falls; rolling rods go on",
              HARDLY_FAILS),
    Statement("forgetting", "2", "Velocities forget the start within about a period of the plates",
              motion_checks.forgets_the_start,
              "asked of the velocities in the plane, from one to three periods after the start"),
    Statement("g2", "5", "G₂(r) decays to 0 for ℓ = 2.5 mm at every packing, and levels off for ℓ = 4.5 mm when dense",
              structure_checks.g2_decays_or_levels),
    Statement("isotropic", "6", "G₂ is isotropic at 0.45 (ℓ = 4.5 mm)", structure_checks.g2_isotropic_when_dilute,
              "asked of its contour at 0.2, in the frame of the director of the same rods, which finds some order in "
              "any number of them: the ratio less 1 goes as S, and its value at S = 0 counts"),
    Statement("anisotropy", "6", "G₂ falls faster across the director than along it", structure_checks.g2_anisotropic),
    Statement("g-flattens", "7", "g(r) flattens sooner along the director than across it", structure_checks.g_flattens,
              "the sentence says the contrary in its second half"),
    Statement("splay-bend", "elasticity", "Splay costs more than bend, K₁ > K₃",
              structure_checks.splay_stiffer_than_bend,
              "the paper concludes it from G₂ falling faster across the director; in linear theory, "
              "⟨δθ²⟩ ~ 1/(K₁q_across² + K₃q_along²), that means the reverse. Asked of waves of the director along and "
              "across it, of the same length: if both are driven alike, what costs more fluctuates less"),
    Statement("layers", "8", "Layers at ±θ_m, about 10°, for ℓ = 4.5 mm from 0.80 on, and none at 0.75",
              layer_checks.layers_when_dense),
    Statement("g2-oscillates", "8", "Where there are layers, G₂ oscillates across the director",
              layer_checks.g2_oscillates),
    Statement("gap", "gap", "No layers at gaps of 1.4 and 1.6 mm", layer_checks.no_layers_at_wide_gaps,
              "asked of P(θ): whether it has one peak, and is less flat there than at 1.2 mm"),
    Statement("gap-order", "gap", "At a gap of 1.4 mm the system is ordered still", layer_checks.ordered_at_a_wider_gap,
              "in a box narrower than the paper's"),
    Statement("taper", "taper", "The layers are due to the tapered shape", layer_checks.taper_makes_layers,
              "asked of θ_m: whether it is the same part of the angle between two tapered flanks at every length"),
    Statement("crystal", "gap", "At a gap of 0.9 mm a crystal, without layers", layer_checks.crystal_at_a_narrow_gap,
              "all runs start as a crystal: one that melts would refute it"),
    Statement("angle-packing", "layer-trends", "θ_m grows with packing",
              layer_checks.angle_trend(layer_checks.by_packing, rising=True)),
    Statement("angle-length", "layer-trends", "θ_m falls with rod length",
              layer_checks.angle_trend(layer_checks.by_length, rising=False)),
    Statement("angle-end", "layer-trends", "θ_m falls with the end radius",
              layer_checks.angle_trend(layer_checks.by_end, rising=False)),
    Statement("peaks-end", "layer-trends", "P(θ) has two peaks at every end radius",
              layer_checks.two_peaks_at_every_end),
    Statement("wavelength-packing", "layer-trends", "The wavelength grows from 0.85 to 0.80",
              layer_checks.wavelength_trend(layer_checks.by_packing, rising=False)),
    Statement("wavelength-length", "layer-trends", "The wavelength grows with rod length",
              layer_checks.wavelength_trend(layer_checks.by_length, rising=True)),
    Statement("wavelength-end", "layer-trends", "The wavelength grows with the end radius",
              layer_checks.wavelength_trend(layer_checks.by_end, rising=True)),
    Statement("larger-box", "larger-box", "In a larger box the wavelength is larger and θ_m smaller",
              layer_checks.larger_box),
    Statement("tilt", "10", "Rods swim against their tilt, fastest near n_z = ±0.2", motion_checks.tilt_and_velocity),
    Statement("reversal", "10", "Beyond n_z = ±0.3 they swim the other way", motion_checks.velocity_reverses,
              "one of the two reasons for which 200 Hz is assumed", CALIBRATES),
    Statement("no-tilt", "10", "A rod without tilt does not swim", motion_checks.no_velocity_without_tilt,
              "by symmetry", HARDLY_FAILS),
    Statement("sideways", "10", "Across the rod ⟨v⟩ = 0 at every tilt", motion_checks.no_motion_sideways,
              "by symmetry", HARDLY_FAILS),
    Statement("switching", "10", "The tilt of a rod switches from one sign to the other", motion_checks.tilt_switches,
              "the paper follows rods for 30 s, hundreds of times as long", HARDLY_FAILS),
    Statement("persistence", "11", "Ways of single rods persist longer at 0.85 than at 0.65",
              motion_checks.persists_when_dense,
              "0.2 s below φ = 0.70 is half the window of 400 ms over which velocities are averaged: no memory is seen "
              "there"),
    Statement("persistence-noise", "11", "They persist because rotational noise is less",
              motion_checks.persists_for_want_of_noise,
              "rods of 4.5 mm, which turn still less, are asked too. That neighbours move together is another cause"),
    Statement("diffusion-both", "9", "Rods diffuse normally in both the disordered and the ordered phase (ℓ = 4.5 mm)",
              motion_checks.normal_in_both_phases,
              "that C_v stays above 0 for seconds, as the paper's figure 12 has it at 0.85, is an exponent above 1"),
    Statement("diffusion-rises", "9", "Short rods diffuse faster when denser", motion_checks.diffusion_rises,
              "the paper's own fit has its minimum at 0.64"),
    Statement("diffusion-level", "9", "At 0.65 D is what the paper's fit has there, 1.7 mm²/s (ℓ = 2.5 mm)",
              motion_checks.diffusion_level,
              "the other reason for which 200 Hz, and MSD = 4Dt, are assumed", CALIBRATES),
    Statement("diffusion-law", "9", "D = 1.7 + 480 (φ − 0.64)² mm²/s for ℓ = 2.5 mm", motion_checks.diffusion_law,
              "from 0.70 on. The paper prints MSD = 2Dt; the verdict is for 4Dt, which is D in the plane"),
    Statement("diffusion-normal", "9", "Short rods diffuse normally at short and at long times",
              motion_checks.diffusion_is_normal,
              "the paper contradicts itself: C_v above 0 beyond its averaging window is an exponent above 1"),
    Statement("diffusion-along", "9",
              "Along the director D rises up to 0.80, then falls; across it D falls, and is smaller (ℓ = 4.5 mm)",
              motion_checks.diffusion_along_the_director,
              "along it D is half the slope of the MSD, which is not linear: it depends on the lag, and so does "
              "whether it falls beyond 0.80"),
    Statement("diffusion-across", "9",
              "Across the director nothing is super-diffusive, and dense rods are sub-diffusive at short times",
              motion_checks.no_superdiffusion_across),
    Statement("memory", "12", "C₂ and C_v decay more slowly when denser (ℓ = 2.5 mm)",
              motion_checks.slower_when_denser,
              "C_v from 0.65 on: below, its decay is that of the averaging window"),
    Statement("c2-decay", "12", "C₂ of short rods decays to 0 (ℓ = 2.5 mm)", motion_checks.c2_forgets),
    Statement("c2-plateau", "12", "C₂ of long rods levels off, near 1 when dense", motion_checks.c2_levels_off,
              "whatever the dynamics C₂ is S² at late times: near 1 is from the square of 0.85 on, the least S that is "
              "about 1"),
    Statement("velocity-along", "12", "C_v along the director grows with packing up to 0.80 (ℓ = 4.5 mm)",
              motion_checks.velocity_along_grows,
              "of lags beyond the 400 ms over which velocities are averaged, from which the paper concludes D; C_v(0), "
              "the rattling in the cage, falls"),
    Statement("rotation", "13", "The rotational diffusion constant falls with packing (ℓ = 2.5 mm)",
              motion_checks.rotation_slows),
    Statement("rotation-short", "13", "At short times rotation is sub-diffusive, the more so the denser",
              motion_checks.rotation_subdiffusive),
    Statement("rotation-normal", "13", "At long times rotation is diffusive (ℓ = 2.5 mm)",
              motion_checks.turning_diffuses),
    Statement("rotation-saturates", "13",
              "The angle turned levels off in the nematic and grows linearly in disorder (ℓ = 4.5 mm)",
              motion_checks.turning_saturates),
    Statement("defects", "14",
              "Defects of a system that is ordered here and there move by themselves (ℓ = 3.0 mm at 0.85)",
              motion_checks.defects_move, "the paper's text has ℓ = 0.3 mm, its caption 3.0 mm"),
)


def of_figures(figures: Iterable[str] = ()) -> list[Statement]:
    """The statements of these figures; all if none is named."""
    wanted = set(figures)
    return [statement for statement in STATEMENTS if not wanted or statement.figure in wanted]


@dataclass(frozen=True)
class Basis:
    """What a verdict stands on; each is the smallest and the largest of its state points, or empty.

    samples: independent samples, of all seeds together
    seeds:   runs of a state point
    boxes:   in words, the smallest area and the largest
    seconds: simulated, of a run, its transient included
    """

    samples: tuple[float, ...] = ()
    seeds: tuple[int, ...] = ()
    boxes: tuple[str, ...] = ()
    seconds: tuple[float, ...] = ()

    @staticmethod
    def of(taken: Iterable[Read]) -> "Basis":
        taken = list(taken)
        runs = [run for read in taken for run in read.runs]
        boxes = sorted({box_of(run) for run in runs}, key=math.prod)
        named = {box_of(run): box_text(run) for run in runs}
        return Basis(_ends(read.number.n_eff for read in taken if math.isfinite(read.number.n_eff)),
                     _ends(len(read.runs) for read in taken), tuple(named[box] for box in _ends_of_list(boxes)),
                     _ends(run.summary["sim_seconds"] for run in runs))

    def cells(self) -> list[str]:
        """Independent samples, seeds, box and time of a table."""
        return [_range(f"{n:.0f}" for n in self.samples), _range(f"{n}" for n in self.seeds), _range(self.boxes, " mm"),
                _range((f"{t:.0f} s" for t in self.seconds), " s")]


def _ends(values: Iterable[Any]) -> tuple[Any, ...]:
    return _ends_of_list(sorted(set(values)))


def _ends_of_list(values: list[Any]) -> tuple[Any, ...]:
    return (values[0], values[-1]) if len(values) > 1 else tuple(values)


def _range(words: Iterable[str], unit: str = "") -> str:
    """One word, or the first and the last with the unit of both behind them: "33.5 to 67 mm"."""
    first, *other = dict.fromkeys(words) or ["–"]
    return f"{first.removesuffix(unit)} to {other[0]}" if other else first


@dataclass(frozen=True)
class Verdict:
    """A statement, what the runs say to it, and on what that stands."""

    statement: Statement
    finding: Finding
    basis: Basis

    @property
    def words(self) -> str:
        """The verdict and its reason, for a table of Markdown."""
        word = f"**{self.finding.verdict}**" if self.finding.verdict == "disagrees" else self.finding.verdict
        if self.statement.role:
            word += f" ({self.statement.role})"
        return f"{word}: {self.finding.why}" if self.finding.why else word


def judged(evidence: Evidence, statements: Iterable[Statement] = STATEMENTS) -> list[Verdict]:
    """Each statement with what the runs say to it."""
    found = []
    for statement in statements:
        with reads() as taken:
            finding = statement.check(evidence)
        found.append(Verdict(statement, finding, Basis() if finding.verdict == NO_DATA else Basis.of(taken)))
    return found


def as_json(found: Iterable[Verdict]) -> list[dict[str, Any]]:
    return [{"statement": v.statement.id, "figure": v.statement.figure, "says": v.statement.says,
             "verdict": v.finding.verdict, "found": v.finding.found, "why": v.finding.why, "note": v.statement.note,
             "role": v.statement.role,
             "independent_samples": v.basis.samples, "seeds": v.basis.seeds, "boxes": v.basis.boxes,
             "sim_seconds": v.basis.seconds} for v in found]


def as_table(found: Iterable[Verdict], figure: Callable[[Statement], str] | None = lambda s: s.figure) -> str:
    """A table of Markdown; `figure` is what its first column says, which is left out if that is None."""
    head = ["the paper says", "found here", "n_eff", "seeds", "box", "time", "verdict"]
    rows = []
    for verdict in found:
        statement = verdict.statement
        note = f". *Note:* {statement.note}" if statement.note else ""
        cells = [f"{statement.says}{note}", verdict.finding.found or "–", *verdict.basis.cells(), verdict.words]
        rows.append(([figure(statement)] if figure else []) + cells)
    head = (["figure"] if figure else []) + head
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, ["---"] * len(head), *rows]) + "\n"

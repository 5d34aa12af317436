"""A measured number with its standard error, and how such numbers are put together."""
import html
import math
from dataclasses import dataclass, replace
from typing import Any, Iterable, Sequence

from .catalogue import STEADINESS
from .errors import imported

NAN = float("nan")


@dataclass(frozen=True)
class Estimate:
    """A number and what is known of it. It is computed with as if it were independent of others, to first order in the
    errors; `<`, `float`, `round` and formats (f"{S:.3f}") are of its value.

    value:       NaN where it could not be measured
    error:       its standard error; NaN where it is not known
    steady:      whether it is the mean of a steady state; None where that cannot be told, or where it is no average
    n_eff:       the number of independent samples behind the error; NaN where it is not known
    drift:       its mean over the later half of the time less that over the earlier half, with `drift_error`
    unit:        "mm2 s-1"; "1" for a plain number; None where it is not known
    reason:      why there is no value, where there is none
    dof:         degrees of freedom of its error: one less than the replicas whose scatter it is; infinite of an error
                 that comes from many samples
    """

    value: float = NAN
    error: float = NAN
    steady: bool | None = None
    n_eff: float = NAN
    drift: float = NAN
    drift_error: float = NAN
    unit: str | None = "1"
    reason: str = ""
    dof: float = math.inf

    @property
    def is_known(self) -> bool:
        """Whether there is a value."""
        return math.isfinite(self.value)

    @property
    def bar(self) -> float:
        """Half the length of its error bar: the error, or 0 where that is not known (Debian's matplotlib fails where it
        gets no bar that is a number)."""
        return self.error if math.isfinite(self.error) else 0.0

    def with_further_error(self, error: float) -> "Estimate":
        """With an error in quadrature that all replicas have in common, such as a step on which values lie."""
        own = self.bar
        return replace(self, error=math.hypot(own, error), dof=joint_dof([(own, self.dof), (error, math.inf)]))

    def to_uncertainties(self) -> Any:
        """The `ufloat` of the package uncertainties (Debian: python3-uncertainties), of value and error."""
        return imported("uncertainties").ufloat(self.value, self.error)

    def _repr_html_(self) -> str:
        return html.escape(str(self))

    def __float__(self) -> float:
        return self.value

    def __round__(self, digits: int | None = None) -> float:
        return round(self.value, digits)

    def __format__(self, form: str) -> str:
        return format(self.value, form) if form else str(self)

    def __lt__(self, other: "Estimate | float") -> bool:
        return self.value < float(other)

    def __le__(self, other: "Estimate | float") -> bool:
        return self.value <= float(other)

    def __gt__(self, other: "Estimate | float") -> bool:
        return self.value > float(other)

    def __ge__(self, other: "Estimate | float") -> bool:
        return self.value >= float(other)

    def __neg__(self) -> "Estimate":
        return self * -1

    def __pos__(self) -> "Estimate":
        return self

    def __abs__(self) -> "Estimate":
        return -self if self.value < 0 else self

    def __add__(self, other: "Estimate | float") -> "Estimate":
        if not isinstance(other, Estimate):
            return replace(self, value=self.value + other)
        unit = self.unit if self.unit == other.unit else None
        return derived(self.value + other.value, [(1, self), (1, other)], unit)

    __radd__ = __add__

    def __sub__(self, other: "Estimate | float") -> "Estimate":
        return self + -other

    def __rsub__(self, other: float) -> "Estimate":
        return -self + other

    def __mul__(self, factor: "Estimate | float") -> "Estimate":
        if isinstance(factor, Estimate):
            unit = self.unit if factor.unit == "1" else factor.unit if self.unit == "1" else None
            return derived(self.value * factor.value, [(factor.value, self), (self.value, factor)], unit)
        return replace(self, value=self.value * factor, error=self.error * abs(factor), drift=self.drift * factor,
                       drift_error=self.drift_error * abs(factor))

    __rmul__ = __mul__

    def __truediv__(self, divisor: "Estimate | float") -> "Estimate":
        if not isinstance(divisor, Estimate):
            return self * (1 / divisor)
        ratio = self.value / divisor.value
        unit = self.unit if divisor.unit == "1" else "1" if self.unit == divisor.unit is not None else None
        return derived(ratio, [(1 / divisor.value, self), (-ratio / divisor.value, divisor)], unit)

    def __rtruediv__(self, dividend: float) -> "Estimate":
        return exactly(dividend) / self

    def __str__(self) -> str:
        if not self.is_known:
            return f"not known ({self.reason})" if self.reason else "not known"
        mark = STEADINESS[self.steady]["mark"]
        unit = "" if self.unit in ("1", None) else f" {self.unit}"
        if not math.isfinite(self.error):
            return f"{mark}{self.value:.4g} ± ?{unit}"
        digits = decimals(self.error)
        return f"{mark}{self.value:.{digits}f} ± {self.error:.{digits}f}{unit}"


def exactly(value: float) -> Estimate:
    """A number that was not measured but given: without an error, and the same for ever."""
    return Estimate(value=value, error=0.0, steady=True, drift=0.0, drift_error=0.0)


def decimals(error: float) -> int:
    """Decimals that show an error with two figures where it begins with a 1, else with one; at most 12, the noise of
    rounding."""
    if not math.isfinite(error) or error <= 0:
        return 3
    exponent = math.floor(math.log10(error))
    return min(12, max(0, -exponent + (1 if error / 10.0**exponent < 2 else 0)))


def student_factor(n: int) -> float:
    """The factor on the standard error of a mean of n >= 2 values by which +-1 of it holds 68.3 %, as for very many.

    It is the quantile of Student's t with n - 1 degrees of freedom by its series in 1 / (n - 1): Abramowitz & Stegun,
    *Handbook of Mathematical Functions* (1964), eq. 26.7.5, at z = 1 (1.3 % low for n = 2, else within 0.1 %).
    """
    x = 1 / (n - 1)
    return 1 + x * (0.5 + x * (0.25 + x * 0.0625))


def mean_of_samples(values: Sequence[float]) -> tuple[float, float]:
    """Mean of independent samples, and its standard error from their scatter (NaN for fewer than two)."""
    n = len(values)
    mean = math.fsum(values) / n
    if n < 2:
        return mean, NAN
    return mean, math.sqrt(math.fsum((value - mean) ** 2 for value in values) / (n - 1) / n)


def replica_mean(estimates: Iterable[Estimate]) -> Estimate:
    """Mean over the replicas of one state point; each run counts the same. Those without a value are left out.

    Its standard error is

    - where all own errors are known, the larger one of what they give, sqrt(sum error^2) / n, and of the scatter of
      the runs: two runs that happen to agree are no better than their own errors (the scale factor, never below 1, of
      the Particle Data Group, *Review of Particle Physics* (2022), section 5.2.2);
    - otherwise the scatter between the runs, widened by Student's t so that it covers 68 % for few runs too, but never
      less than the known errors give; two such errors cover less than 95 %, which `dof` is there for;
    - of a single run its own.

    The mean is steady if all are, and is known to relax if one of them does. Its drift is the mean of their drifts.
    """
    everything = list(estimates)
    known = [estimate for estimate in everything if estimate.is_known]
    if not known:
        return everything[0] if everything else Estimate()
    n = len(known)
    errors = [estimate.error for estimate in known if math.isfinite(estimate.error)]
    within = math.sqrt(math.fsum(error**2 for error in errors)) / n
    value, scatter = mean_of_samples([estimate.value for estimate in known])
    dof = math.inf
    if n == 1:
        error = within if errors else NAN
    elif len(errors) == n:
        error = max(within, scatter)
    else:
        error = max(within, student_factor(n) * scatter)
        dof = n - 1 if error > within else math.inf
    drifts = [e for e in known if math.isfinite(e.drift)]
    drift = math.fsum(e.drift for e in drifts) / n if len(drifts) == n else NAN
    drift_error = math.sqrt(math.fsum(e.drift_error**2 for e in drifts)) / n if len(drifts) == n else NAN
    n_eff = math.fsum(e.n_eff for e in known if math.isfinite(e.n_eff)) or NAN
    return Estimate(value, error, _steady(known), n_eff, drift, drift_error, known[0].unit, dof=dof)


def _steady(parts: Iterable[Estimate]) -> bool | None:
    """Of several together: False where one is not steady, else None where one cannot tell."""
    flags = {part.steady for part in parts}
    return False if False in flags else None if None in flags else True


def derived(value: float, terms: Iterable[tuple[float, Estimate]], unit: str | None = "1") -> Estimate:
    """A number made of independent others, to first order: `terms` are (its derivative by one of them, that one).

    It is as steady as all of them, with their errors and drifts.
    """
    parts = list(terms)
    error = math.sqrt(math.fsum((slope * e.error) ** 2 for slope, e in parts))
    dof = joint_dof((abs(slope) * e.error, e.dof) for slope, e in parts)
    drift = math.fsum(slope * e.drift for slope, e in parts)
    drift_error = math.sqrt(math.fsum((slope * e.drift_error) ** 2 for slope, e in parts))
    return Estimate(value, error, _steady(e for _, e in parts), NAN, drift, drift_error, unit, dof=dof)


def joint_dof(errors: Iterable[tuple[float, float]]) -> float:
    """Degrees of freedom of errors that are added in quadrature, from (error, its own ones): Welch, *Biometrika*
    **34**, 28 (1947)."""
    parts = list(errors)
    few = math.fsum(error**4 / dof for error, dof in parts)
    return math.fsum(error**2 for error, _ in parts) ** 2 / few if few > 0 else math.inf

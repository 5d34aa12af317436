"""How quantities are called in figures: names, symbols and units. Symbols are in matplotlib's mathtext."""
import math
import re
from typing import Any, Mapping, Sequence

from .. import catalogue
from ..units import split_species, split_unit, unit_of

#: What Python alone has a name for: (its name, its symbol, its unit in print).
_OWN = {
    "S": ("nematic order", r"$\langle S\rangle$", ""),
    "S_std": ("fluctuation of the nematic order", r"$σ_S$", ""),
    "/defects/n": ("number of ±1/2 defects", "", ""),
}
#: The same under the names that rows of results have.
_ALIASES = {"order.mean": "S", "order.std": "S_std", "order": "S"}
_POWERS = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def unit_text(unit: str) -> str:
    """A unit in print: "mm²/s" of "mm2 s-1", "1/mm" of "mm-1", nothing of "1"."""
    above, below = list[str](), list[str]()
    for word in unit.split():
        match = re.fullmatch(r"([^0-9^-]+)\^?(-?[0-9]+)?", word)
        if match is None:
            continue
        power = int(match[2] or 1)
        symbol = {"deg": "°"}.get(match[1], match[1])
        (above if power > 0 else below).append(symbol + (str(abs(power)).translate(_POWERS) if abs(power) > 1 else ""))
    if not below:
        return " ".join(above)
    bottom = " ".join(below)
    return (" ".join(above) or "1") + "/" + (f"({bottom})" if len(below) > 1 else bottom)


def _described(rows: Mapping[str, Mapping[str, Any]]) -> dict[str, tuple[str, str, str]]:
    return {path: (row["title"], f"${row['symbol']}$" if row["symbol"] else "", unit_text(row["unit"]))
            for path, row in rows.items() if row.get("title") and not split_species(path)[0]}


#: What scenes, rows of results and arrays call a quantity: (its name, its symbol, its unit in print).
TABLE = {**_described(catalogue.KEYS), **_described(catalogue.NUMBERS), **_described(catalogue.SUMMARY),
         **_described(catalogue.ARRAYS), **_OWN}


def _entry(path: str) -> tuple[str, str, str] | None:
    name = path.removeprefix("measured.").removesuffix(".value")
    name = _ALIASES.get(name, name)
    species, own = split_species(name)
    for known, of in ((name, ""), (own, species), (f"rods.{own}", species)):
        if (found := TABLE.get(known)) and (of or known == name):
            return (f"{found[0]} of {of}" if of else found[0]), *found[1:]
    return None


def with_unit(title: str, unit: str) -> str:
    """"time $t$ (s)"."""
    return f"{title} ({unit})" if unit else title


def axis_title(path: str, unit: str | None = None, over: Sequence[float] = ()) -> str:
    """Name, symbol and unit for an axis: of a key of the scene ("box.gap"), of a number of a run ("theta_m_deg",
    "measured.theta_m_deg.value", "order.mean") or of an array ("/g2/g2"). What the table does not have goes by its own
    name, with the unit that it ends in. `unit` replaces that of the table. `over`: the times over which the number
    is taken [s], "over_s" of summaries: "speed over 0.4 s (mm/s)"."""
    entry = _entry(path)
    times = f" over {' to '.join(number_text(time) for time in sorted({min(over), max(over)}))} s" if over else ""
    if entry is not None:
        name, symbol, own = entry
        return with_unit(f"{name} {symbol}".strip() + times, own if unit is None else unit)
    name = path.removeprefix("measured.").removesuffix(".value")
    stem, _ = split_unit(name.rpartition("/")[2])
    own = unit_text(unit_of(name))
    if not own and name in catalogue.KEYS:
        own = unit_text(catalogue.KEYS[name]["unit"])
    name = stem if "/" in name else split_unit(name)[0]
    return with_unit(name.replace("_", " ") + times, own if unit is None else unit)


def symbol(path: str) -> str:
    """The symbol of a quantity, or its name where it has none."""
    entry = _entry(path)
    return (entry[1] or entry[0]) if entry else path


def number_text(value: Any) -> str:
    """A number with as many digits as it has, up to six, and a real minus sign; anything else as it is."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        text = f"{value:.6g}"
        if "e" in text:
            mantissa, exponent = text.split("e")
            power = str(int(exponent)).translate(_POWERS)
            text = f"10{power}" if mantissa == "1" else f"{mantissa}·10{power}"
        return text.replace("-", "−")
    return str(value)


def short_number(value: float, n_digits: int = 3) -> str:
    """So many digits, without an exponent as far as that can be read: "0.0123", "1.66", "1660", "18,500"."""
    if not math.isfinite(value):
        return "–"
    if value == 0 or not 1e-4 <= abs(value) < 1e9:
        return number_text(float(f"{value:.{n_digits}g}"))
    digits = max(0, n_digits - 1 - math.floor(math.log10(abs(value))))
    rounded = float(f"{value:.{n_digits}g}")
    return (f"{rounded:,.0f}" if abs(rounded) >= 1e4 else f"{rounded:.{digits}f}").replace("-", "−")


def value_label(path: str, value: Any) -> str:
    """A value of a quantity: "$φ$ = 0.6", "$ℓ$ = 2.5 mm"."""
    entry = _entry(path)
    unit = entry[2] if entry and not isinstance(value, str) else ""
    return f"{symbol(path)} = {number_text(value)}" + (f" {unit}" if unit else "")


_WORDS = ((r"\langle ", "⟨"), (r"\langle", "⟨"), (r"\rangle", "⟩"),
          *((mark, "") for mark in (r"\mathrm", r"\hat", "$", "{", "}")))


def plain(text: str) -> str:
    """A title without mathtext's marks: "tilt of the layers θ_m (°)"."""
    for marked, meant in _WORDS:
        text = text.replace(marked, meant)
    return " ".join(text.split())

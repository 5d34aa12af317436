"""Pictures and the numbers in them, with what they are made from. Equal figures give equal bytes: no time of day."""
import csv
import io
import math
from pathlib import Path
from typing import Any, Iterable, Mapping, Sequence

import numpy as np

from ..errors import ShakenError
from ..system import write_whole
from . import names

#: Keyword -> a text of one line: {"Software": "shaken plot 0.1.0", "Runs": "1f0c59d16ab8b7d7"}. Keywords are those of
#: PNG: Latin letters and single spaces, at most 79.
Origin = Mapping[str, str]

SUFFIXES = (".png", ".pdf", ".svg")
_MANY_BYTES = 500_000  # of a PNG


class Drawn:
    """The numbers of a curve or a map, as they go into the CSV."""

    def __init__(self, panel: str, curve: str, x: Any, y: Any, error: Any = None,
                 steady: Sequence[bool | None] | None = None, z: Any = None) -> None:
        self.panel, self.curve, self.x, self.y, self.error, self.steady, self.z = panel, curve, x, y, error, steady, z


def origin_list(words: Sequence[str], most: int = 200) -> str:
    """"a, b, c"; of more than `most`, "a, b and 7 more"."""
    if len(words) <= most:
        return ", ".join(words)
    return f"{', '.join(words[:most])} and {len(words) - most} more"


def csv_text(origin: Origin, axes: Iterable[tuple[str, str, str]], data: Iterable[Drawn]) -> str:
    """Comments with the origin and with the titles of each panel's axes, then a row for each point that is drawn.

    axes: (panel, title of x, title of y)
    """
    out = io.StringIO()
    for keyword, text in origin.items():
        out.write(f"# {keyword}: {text}\n")
    for panel, x, y in axes:
        out.write(f"# {'panel ' + panel + ': ' if panel else ''}x is {names.plain(x) or 'x'}; y is "
                  f"{names.plain(y) or 'y'}; error is one standard error\n")
    rows = list(data)
    has_map = any(drawn.z is not None for drawn in rows)
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["panel", "curve", "x", "y", *(["z"] if has_map else []), "error", "steady"])
    for drawn in rows:
        for k in range(len(drawn.x)):
            shown = [drawn.x[k], drawn.y[k], *([drawn.z[k]] if drawn.z is not None else [])]
            if not all(math.isfinite(value) for value in shown):
                continue
            error = drawn.error[k] if drawn.error is not None else math.nan
            steady = drawn.steady[k] if drawn.steady is not None else None
            numbers = [_number(value) for value in shown] + ([""] if has_map and drawn.z is None else [])
            word = "" if drawn.steady is None else "yes" if steady is True else "no" if steady is False else "unknown"
            writer.writerow([drawn.panel, names.plain(drawn.curve), *numbers,
                             _number(error, 4) if math.isfinite(error) else "", word])
    return out.getvalue()


def _number(value: float, digits: int = 7) -> str:
    return f"{value:.{digits}g}"


def save(figure: Any, path: str | Path, origin: Origin | None = None, data: str | None = None) -> Path:
    """Writes the picture, PNG, PDF or SVG by its suffix, with its origin inside: text chunks of the PNG, the subject of
    the PDF, the metadata of the SVG. `data`, as of csv_text, goes beside it as NAME.csv. Makes the folder if need be.

    Raises ShakenError for another suffix, or where it cannot be written.
    """
    path = Path(path)
    if path.suffix not in SUFFIXES:
        raise ShakenError(f"{path}: a figure is a .png, .pdf or .svg")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, _picture(figure, path.suffix[1:], dict(origin or {})))
        if data is not None:
            write_whole(path.with_suffix(".csv"), data.encode())
    except OSError as error:
        raise ShakenError(f"{path} cannot be written: {error.strerror or error}") from None
    return path


def _picture(figure: Any, form: str, origin: dict[str, str]) -> bytes:
    out = io.BytesIO()
    software = origin.get("Software", "shaken")
    lines = "; ".join(f"{keyword}: {text}" for keyword, text in origin.items())
    # Not by Figure.savefig, which draws everything once more to arrange it.
    if form == "png":
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        return _png(figure, canvas.buffer_rgba(), {"Software": software, **origin})
    elif form == "pdf":
        from matplotlib.backends.backend_pdf import FigureCanvasPdf
        FigureCanvasPdf(figure).print_pdf(out, metadata={"Creator": software, "Producer": software, "Subject": lines,
                                                         "CreationDate": None})
    else:
        from matplotlib.backends.backend_svg import FigureCanvasSVG
        FigureCanvasSVG(figure).print_svg(out, metadata={"Creator": software, "Description": lines, "Date": None})
    return out.getvalue()


def _png(figure: Any, pixels: Any, texts: dict[str, str]) -> bytes:
    """A PNG of at most 256 colours, a third of the bytes, where no eye sees it. Where colours stand for numbers, or
    there is a picture, it has all, unless these are very many bytes; those of colour bars count most then."""
    from PIL import Image, PngImagePlugin
    shape = pixels.shape
    picture = Image.frombuffer("RGBA", (shape[1], shape[0]), pixels, "raw", "RGBA", 0, 1).convert("RGB")
    info = PngImagePlugin.PngInfo()
    for keyword, text in texts.items():
        info.add_text(keyword, text)

    def encoded(image: Any) -> bytes:
        out = io.BytesIO()
        image.save(out, "PNG", pnginfo=info, dpi=(figure.dpi, figure.dpi), optimize=True)
        return out.getvalue()

    few = {"method": Image.Quantize.MEDIANCUT, "dither": Image.Dither.NONE}
    bars = [axes.get_window_extent() for axes in figure.axes if hasattr(axes, "_colorbar")]
    if not bars and not any(axes.images for axes in figure.axes):
        return encoded(picture.quantize(256, **few))
    whole = encoded(picture)
    if len(whole) <= _MANY_BYTES or not bars:
        return whole
    sample = Image.new("RGB", (picture.width, 2 * picture.height))
    sample.paste(picture)
    height = picture.height // len(bars)
    for k, bar in enumerate(bars):
        shown = picture.crop((int(bar.x0), int(shape[0] - bar.y1), int(bar.x1) + 1, int(shape[0] - bar.y0) + 1))
        sample.paste(shown.resize((picture.width, height), Image.Resampling.NEAREST),
                     (0, picture.height + k * height))
    chosen = sample.quantize(256, kmeans=2, **few)
    colours = np.array(chosen.getpalette()).reshape(-1, 3)
    for exact in (0, 255):  # paper is white
        colours[np.argmin(np.abs(colours - exact).sum(axis=1))] = exact
    # by hand: Pillow's way to a given palette takes colours that are only nearly the nearest
    there, where = np.unique(np.asarray(picture) @ np.array([1 << 16, 1 << 8, 1]), return_inverse=True)
    apart = np.stack([there >> 16, there >> 8 & 255, there & 255], axis=1)[:, None] - colours
    indexed = Image.fromarray((apart**2).sum(axis=2).argmin(axis=1)[where].astype("u1").reshape(shape[:2]), "P")
    indexed.putpalette(colours.ravel().tolist())
    return encoded(indexed)

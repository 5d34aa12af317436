"""Prints the picture of docs/architecture.md: python3 docs/site/data_flow.py > docs/images/data-flow.svg"""
from xml.sax.saxutils import escape

WIDTH, HEIGHT = 860, 470
#: x, y, width; colour; what it is, its folder, and what happens there.
BOXES = [
    (20, 70, 180, "#dbe7f5", "scene", "scene/", ["keys, units, checks;", "the points of a sweep"]),
    (240, 70, 180, "#f6e3d0", "world", "sim/", ["rods, box, plates, walls;", "where they are at tick 0"]),
    (450, 70, 180, "#f6e3d0", "stepper", "sim/stepping/", ["flights and impulses,", "tick after tick"]),
    (660, 70, 180, "#f6e3d0", "observables", "analysis/", ["numbers and curves", "with their errors"]),
    (240, 225, 285, "#e8e8e8", "files of a run", "run/files/",
     ["scene, checkpoint, trajectory,", "observables, summary"]),
    (555, 225, 285, "#e8e8e8", "bus", "proto/", ["frames, observables and states", "as messages of LCM"]),
    (240, 360, 180, "#dcefdc", "tables and plots", "python/", ["results, figures,", "statements of the paper"]),
    (450, 360, 180, "#dcefdc", "pictures and films", "render/", ["ray-cast, of files", "or live"]),
    (660, 360, 180, "#dcefdc", "screens", "client/live/ web/", ["shaken watch, and", "the page in a browser"]),
    (20, 225, 180, "#dbe7f5", "daemon", "server/", ["shakend: the queue; a", "worker for each run"]),
    (20, 360, 180, "#dbe7f5", "command line", "client/", ["shaken: a verb for", "all that a user wants"]),
]
ARROWS = ["M200 112 H240", "M420 112 H450", "M630 112 H660", "M382 170 V225", "M697 170 V225", "M330 310 V360",
          "M490 310 V360", "M590 310 V360", "M750 310 V360", "M110 360 V310", "M200 267 H216 V150 H230"]
WORDS = [(240, 52, "one run, in a process of its own: shaken-worker (run/)"), (390, 202, "all of it, to keep"),
         (705, 202, "live: none waits"), (117, 340, "requests")]
MONO = "font-family='DejaVu Sans Mono, monospace' fill='#345'"
BY_LINE = [("font-weight='bold'", 22), (MONO, 41), ("", 60), ("", 76)]


def picture():
    yield (f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} {HEIGHT}' font-size='13' "
           "font-family='DejaVu Sans, sans-serif'>")
    yield ("<defs><marker id='tip' viewBox='0 0 8 8' refX='7' refY='4' markerWidth='7' markerHeight='7' orient='auto'>"
           "<path d='M0 0L8 4L0 8z' fill='#555'/></marker></defs>")
    yield f"<rect width='{WIDTH}' height='{HEIGHT}' fill='white'/>"
    yield "<rect x='230' y='30' width='620' height='140' rx='8' fill='none' stroke='#b87333' stroke-dasharray='5 4'/>"
    for x, y, width, colour, *lines, last in BOXES:
        yield f"<rect x='{x}' y='{y}' width='{width}' height='85' rx='5' fill='{colour}' stroke='#888'/>"
        for line, (style, down) in zip([*lines, *last], BY_LINE):
            yield f"<text x='{x + 10}' y='{y + down}' {style}>{escape(line)}</text>"
    for way in ARROWS:
        yield f"<path d='{way}' fill='none' stroke='#555' stroke-width='1.6' marker-end='url(#tip)'/>"
    for x, y, words in WORDS:
        yield f"<text x='{x}' y='{y}' fill='#444'>{words}</text>"
    yield "</svg>"


if __name__ == "__main__":
    print("\n".join(picture()))

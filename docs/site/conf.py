"""How Sphinx makes a site of the pages as they are, and of the docstrings of the Python package (`./dev docs`)."""
import json
import re
import sys
from pathlib import Path

from docutils import nodes

PYTHON = Path(__file__).resolve().parents[2] / "python"
sys.path.insert(0, str(PYTHON))

project = html_title = "Shaken"
extensions = ["myst_parser", "sphinx.ext.autodoc"]
include_patterns = ["*.md", "docs/**.md"]
exclude_patterns = ["build", ".*", "docs/figures"]  # the last has pages that `shaken figures` writes, for itself
root_doc = "docs/index"
templates_path = ["."]
html_theme = "furo"
html_static_path = html_css_files = ["wide.css"]
html_additional_pages = {"index": "front.html"}
html_copy_source = html_show_copyright = False
smartquotes = False  # a text in quotes is one that a user writes
myst_heading_anchors = 4
nitpicky = True
nitpick_ignore = [("myst", "docs/archive")]  # a folder
nitpick_ignore_regex = [("py:.*", r"(numpy|pathlib)\..*")]
default_role = "code"
autodoc_inherit_docstrings = False

#: The pages whose links are the contents of the site: which of them, by their targets without ".md".
CONTENTS = {"docs/index": r"(?!validation/)[\w./-]+", "docs/validation": r"validation/[\w-]+"}

#: Page -> sections of the catalogue whose names stand in its tables, and what the index calls such a name.
TABLES = {"docs/scene": {"keys": "key of a scene"}, "docs/effects": {"effects": "effect"},
          "docs/observables": {"observables": "observable", "numbers": "number", "arrays": "array"},
          "docs/pictures": {"style_keys": "key of a style"}}
CATALOGUE = json.loads((PYTHON / "shaken/catalogue.json").read_text())


def add_contents(app, docname, source):
    """Appends to a page of CONTENTS the pages that it links, in its groups, as what the site shows beside every page.
    """
    known = set()
    for group in source[0].split("\n## ")[1:] if docname in CONTENTS else ():
        linked = re.findall(rf"\]\(({CONTENTS[docname]})\.md", group)
        pages = [page for page in dict.fromkeys(linked) if page not in known]
        known.update(pages)
        if pages:
            caption = group.partition("\n")[0]
            source[0] += "\n".join(["\n\n```{toctree}", ":hidden:", f":caption: {caption}", "", *pages, "```\n"])
    if docname == root_doc:
        source[0] += "\n```{toctree}\n:hidden:\n:caption: All names\n\n/genindex\n```\n"


def index_rows(app, document):
    """Gives rows of TABLES an anchor, `key-of-a-scene-rods-length`, and an entry in the index."""
    kinds = {name: kind for section, kind in TABLES.get(app.env.docname, {}).items() for name in CATALOGUE[section]}
    entries = app.env.get_domain("index").entries[app.env.docname]
    for row in [row for body in document.findall(nodes.tbody) for row in body]:
        in_code = [cell.astext() for cell in row[:2] if any(cell.findall(nodes.literal))]
        for name in [name for name in in_code if name in kinds][-1:]:
            target = nodes.make_id(f"{kinds[name]} {name}")
            if target not in document.ids:
                row["ids"].append(target)
                document.ids[target] = row
                entries.append(("single", f"{name} ({kinds[name]})", target, "", None))


def mark_up(app, what, name, obj, options, lines):
    """Rewrites a docstring in the style of this project: "name:  meaning" is a definition, an indented block code, and a
    page a link."""
    text = re.sub(r"(?m)^((\w+(?:, \w+)*): +)(?=\S)", lambda found: f"`{found[2]}`\n{' ' * len(found[1])}",
                  "\n".join(lines))
    text = re.sub(r"\bdocs/(\w+)\.md", r":doc:`docs/\1.md </docs/\1>`", text)
    lines[:] = re.sub(r"\n\n(?=    )", "\n\n::\n\n", text).split("\n")


def setup(app):
    app.connect("source-read", add_contents)
    app.connect("doctree-read", index_rows)
    app.connect("autodoc-process-docstring", mark_up)

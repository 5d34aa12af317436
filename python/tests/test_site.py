"""The site that `./dev docs` makes of docs/ and of the docstrings."""
import inspect
import json
import re
import subprocess
from pathlib import Path

import pytest

import shaken

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    made = subprocess.run([ROOT / "dev", "docs", folder], capture_output=True, text=True)
    assert made.returncode == 0, made.stderr  # of a warning too
    return folder


def test_the_front_leads_to_the_questions(site):
    front = re.search('url=([^"]+)', (site / "index.html").read_text())[1]
    assert 'href="tour.html"' in (site / front).read_text()


def test_every_public_name_of_the_package_is_there_with_its_meaning(site):
    text = (site / "docs/site/api.html").read_text()
    for name in shaken.__all__:
        public = getattr(shaken, name)
        members = [f".{member}" for member, value in vars(public).items()
                   if not member.startswith("_") and (callable(value) or isinstance(value, property))
                   ] if inspect.isclass(public) else []
        for member in ["", *members]:
            assert f'id="shaken.{name}{member}"' in text, f"{name}{member} has no docstring"


def test_every_name_of_the_catalogue_is_in_the_index(site):
    index = (site / "genindex.html").read_text()
    catalogue = json.loads((ROOT / "python/shaken/catalogue.json").read_text())
    names = [name for section in ("keys", "style_keys", "observables", "numbers", "arrays", "effects")
             for name in catalogue[section]]
    assert set(names) <= set(re.findall(r">([^<>]+) \(", index))
    assert len(re.findall(r'href="docs/(?:scene|pictures|observables|effects)\.html#', index)) == len(names)


def test_the_picture_of_the_architecture_is_that_of_its_script_and_names_folders():
    script = ROOT / "docs/site/data_flow.py"
    picture = (ROOT / "docs/images/data-flow.svg").read_text()
    assert picture == subprocess.run(["/usr/bin/python3", "-B", script], capture_output=True, text=True).stdout
    folders = re.findall(r"(?<![\w/])([a-z/]+)/(?=[ <)])", picture)
    assert len(folders) >= 11 and all((ROOT / folder).is_dir() for folder in folders), folders

"""A plugin of pytest: of each test that passes, its seconds and the mutants to whose places it comes, as one line of
JSON in the file SHAKEN_MUTANTS_OF_TESTS."""
import json
import os
import time
from pathlib import Path

import pytest


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item):
    from shaken import _mutant
    out = Path(os.environ["SHAKEN_MUTANTS_OF_TESTS"])
    seen = out.with_suffix(".seen")  # of the programs that it starts, too
    seen.write_text("")
    _mutant.seen.clear()
    _mutant.SEEN_FILE = os.environ["SHAKEN_MUTANTS_SEEN"] = str(seen)
    begin = time.monotonic()
    item.shaken_passed = True
    yield
    if item.shaken_passed:
        with out.open("a") as file:
            file.write(json.dumps({"test": item.nodeid, "seconds": time.monotonic() - begin,
                                   "seen": sorted({int(line) for line in seen.read_text().split()})}) + "\n")


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    outcome = yield
    item.shaken_passed = getattr(item, "shaken_passed", True) and not outcome.get_result().failed

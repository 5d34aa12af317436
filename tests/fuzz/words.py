"""A dictionary for libFuzzer of the words of scenes, sweeps and settings, on stdout.

usage: shaken schema sweep | words.py
"""
import json
import sys

UNITS_AND_VALUES = ("mm", "us", "ms", "Hz", "kHz", "m/s^2", "1e-3", "true", "false", "null", "auto")


def words_of(schema: object) -> set[str]:
    """Keys as a file has them, the words that a key can be, and the paths of keys as settings begin."""
    found: set[str] = set()
    if isinstance(schema, dict):
        found |= {f'"{key}":' for key in schema.get("properties", {})}
        found |= {word for word in schema.get("enum", []) if isinstance(word, str)}
        paths = [path.split(".") for path in schema.get("$defs", {}) if " " not in path]
        found |= {".".join(path[:depth]) + "=" for path in paths for depth in range(1, len(path) + 1)}
    for inner in schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ():
        found |= words_of(inner)
    return found


for word in sorted(words_of(json.load(sys.stdin)).union(UNITS_AND_VALUES)):
    print(json.dumps(word))

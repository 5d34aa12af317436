#!/usr/bin/env python3
"""Holds documents to a JSON Schema, by Debian's python3-jsonschema.

    validate_by_schema.py SCHEMA DOCUMENTS

DOCUMENTS has one JSON document a line. Prints a line for each: "ok", or the first thing that is wrong with it.
"""
import json
import sys

import jsonschema


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        schema = json.load(file)
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    with open(sys.argv[2], encoding="utf-8") as file:
        for line in file:
            error = next(validator.iter_errors(json.loads(line)), None)
            print("ok" if error is None else ascii("/".join(map(str, error.absolute_path)) + ": " + error.message))


main()

"""Prints each place of a definition that breaks a JSON Schema.

    check_json_schema.py SCHEMA DEFINITION
"""

import json
import sys
import tomllib

import jsonschema

with open(sys.argv[1], encoding="utf-8") as file:
    schema = json.load(file)
with open(sys.argv[2], "rb") as file:
    definition = tomllib.load(file)
jsonschema.Draft7Validator.check_schema(schema)
for error in jsonschema.Draft7Validator(schema).iter_errors(definition):
    place = ".".join(str(part) for part in error.absolute_path)
    print(f"{place}: {error.message}"[:300])

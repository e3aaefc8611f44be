# SPDX-License-Identifier: Apache-2.0
"""Validates JSON files against a JSON Schema: validate_json.py SCHEMA FILE... Exits with 1 and says why when one fails."""

import json
import sys

import jsonschema

with open(sys.argv[1]) as file:
    schema = json.load(file)
jsonschema.Draft7Validator.check_schema(schema)
errors = 0
for name in sys.argv[2:]:
    with open(name) as file:
        for error in jsonschema.Draft7Validator(schema).iter_errors(json.load(file)):
            print(f"{name}: {list(error.absolute_path)}: {error.message[:200]}")
            errors += 1
sys.exit(1 if errors else 0)

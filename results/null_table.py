#!/usr/bin/env python3
"""The table of results/power_null: null_table.py SIMULATIONS OUT, with a folder of SIMULATIONS for
each definition. A row for each test of each report."""
import csv
import json
import pathlib
import sys

COLUMNS = ["definition", "participants", "test", "made", "rejected", "share", "band_low",
           "band_high", "keeps_level"]


def rows():
    for folder in sorted(pathlib.Path(sys.argv[1]).iterdir()):
        result = json.loads((folder / "power.json").read_text())
        for cell in result["without_an_effect"]:
            people = int(cell["levels"]["design.participants"])
            for name, test in cell["studies"]["tests"].items():
                low, high = test["null_band_99"]
                rejected = test["rejected"]
                yield [folder.name, people, name, test["made"], rejected,
                       f"{rejected / test['made']:.4f}", low, high,
                       "no" if rejected > high else "cautious" if rejected < low else "yes"]


with open(sys.argv[2], "w", newline="") as out:
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows(rows())

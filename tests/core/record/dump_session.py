"""Writes the number of rows of each table of a session file, and its first rows, without our code.

usage: dump_session.py FILE > FILE.txt
"""
import sys

import h5py

ROWS = 8
TABLES = ("samples", "frames", "trials", "events", "stimuli", "timing", "runs", "begun", "responses", "tool",
          "removals", "camera", "splits", "bones", "structures", "bone_runs", "bone_densities", "procedures")


def text(value):
    if isinstance(value, bytes):
        return value.decode("utf-8")
    return value.hex() if isinstance(value, float) else str(value)


with h5py.File(sys.argv[1], "r") as file:
    print("schema_version", file.attrs["schema_version"], sep="|")
    for name in TABLES:
        if name not in file:
            continue
        print(name, len(file[name]), sep="|")
        for row in file[name][:ROWS]:
            print(name, *(f"{column}={text(row[column].item())}" for column in row.dtype.names), sep="|")

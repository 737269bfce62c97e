"""Reads a session file the way its users do: h5py and pandas, without our code.

usage: read_session.py FOLDER DOC
FOLDER holds session.h5, samples.csv (as given to the writer) and expected.json.
Exits with a message at the first difference.
"""
import json
import os
import re
import sys

import h5py
import numpy
import pandas

TYPES = {"u8": "u1", "i32": "i4", "i64": "i8", "u64": "u8", "f32": "f4", "f64": "f8"}


def check(condition, message):
    if not condition:
        sys.exit("read_session.py: " + message)


def documented_columns(page):
    """(dataset, column) -> (type, unit) from a table of the page."""
    columns, dataset = {}, None
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) != 5 or not cells[1].startswith("`"):
            continue
        dataset = cells[0].strip("`/") or dataset
        for name in re.findall(r"`(\w+)`", cells[1]):
            columns[dataset, name] = (cells[2], cells[3])
    return columns


def check_layout(file, page):
    expected = documented_columns(page.split("## Root attributes")[0])
    if "tool" in file:
        drillings = page.split("## Drillings")[1]
        expected.update(documented_columns(drillings))
        names = {"numpy": numpy}
        exec(re.search(r"```python\n(.*?)```", drillings, re.S).group(1), names)
        volume = names["labels"](file)
        check([list(map(int, cell)) for cell in numpy.argwhere(volume > 0)] == [[1, 0, 0], [2, 0, 0], [2, 3, 1]] and
              volume[2, 3, 1] == 7 and volume[1, 0, 0] == 1, "the labels of the bone")
    found = {}
    for name, dataset in file.items():
        check(dataset.chunks and dataset.maxshape == (None,), f"/{name} is not extendible")
        check(dataset.shuffle and dataset.compression == "gzip", f"/{name} has other filters")
        check(list(dataset.attrs["columns"]) == list(dataset.dtype.names), f"/{name}: columns")
        for column, unit in zip(dataset.dtype.names, dataset.attrs["units"]):
            kind = dataset.dtype[column]
            text = f"text {kind.itemsize}" if kind.kind == "S" else kind.str[1:]
            found[name, column] = (text, unit)
    documented = {key: (TYPES.get(kind, kind), unit) for key, (kind, unit) in expected.items()}
    check(found == documented, f"the page and the file differ: {set(found.items()) ^ set(documented.items())}")
    attributes = page.split("## Root attributes")[1].split("##")[0]
    names = {n for line in attributes.splitlines() if line.startswith("| `")
             for n in re.findall(r"`(\w+)`", line.split("|")[1])}
    check(names == set(file.attrs), f"root attributes: {names ^ set(file.attrs)}")


def check_samples(samples, resolution, folder):
    given = pandas.read_csv(os.path.join(folder, "samples.csv"))
    check(list(given.columns) == list(samples.columns), "columns of samples.csv")
    check(len(given) == len(samples) > 0, "number of samples")
    for column in given.columns:
        error = numpy.abs(given[column].to_numpy() - samples[column].to_numpy()).max()
        # Half a step of the grid, which is exact in 32 bits for values of this size.
        check(error <= 0.5 * resolution[column], f"{column} is off by {error}")


def check_expected(file, trials, expected):
    for name, value in expected["attributes"].items():
        check(file.attrs[name] == value, f"attribute {name}: {file.attrs[name]!r}")
    for name, value in expected["counts"].items():
        check(file["timing"].attrs[name] == value, f"attribute {name} of /timing")
    for table in ("trials", "events", "stimuli", "timing", "frames", "begun", "runs"):
        rows = [[v.decode("utf-8") if isinstance(v, bytes) else v for v in row.tolist()]
                for row in file[table][:]]
        check(rows == expected[table], f"/{table}: {rows}")
    copy = {}
    for name, value, _ in file["attributes"][:].tolist():
        copy[name.decode()] = copy.get(name.decode(), "") + value.decode()
    for name, value in {**expected["attributes"], **expected["counts"]}.items():
        if name != "schema_version":
            same = float(copy[name]) == value if isinstance(value, float) else copy[name] == str(value)
            check(same, f"/attributes: {name} is {copy[name]!r}")
    check(list(trials["condition"]) == [row[1] for row in expected["trials"]], "conditions")


def main():
    folder, doc = sys.argv[1:]
    with open(doc, encoding="utf-8") as text:
        page = text.read()
    with open(os.path.join(folder, "expected.json"), encoding="utf-8") as text:
        expected = json.load(text)
    example = re.search(r"```python\n(.*?)```", page, re.S).group(1)
    check(len(example.strip().splitlines()) == 3, "the example is not three lines")
    os.chdir(folder)
    names = {}
    exec(example, names)  # the page's own lines
    with h5py.File("session.h5", "r") as file:
        check_layout(file, page)
        resolution = dict(zip(file["samples"].attrs["columns"], file["samples"].attrs["resolution"]))
        check_samples(names["samples"], resolution, folder)
        check_expected(file, names["trials"], expected)


main()

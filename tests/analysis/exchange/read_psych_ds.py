"""Reads a data set of Psych-DS with pandas, holds it against the specification's rules, stated here
anew, and against the session files, read with h5py.

    read_psych_ds.py DATA_SET SESSION.h5 [SESSION.h5 ...]
"""
import json
import pathlib
import re
import sys

import h5py
import pandas as pd

root = pathlib.Path(sys.argv[1])
KEYWORDS = {"study", "site", "subject", "session", "task", "condition", "trial", "stimulus",
            "description", "questionnaire"}  # the last is our own, which the rules allow


def read_csv(file):
    return pd.read_csv(file, dtype=str, keep_default_na=False)


def check_metadata(file):
    metadata = json.loads(file.read_text(encoding="utf-8"))
    assert metadata["@context"] in ("https://schema.org", "https://schema.org/"), file
    assert metadata["@type"] == "Dataset" and metadata["name"] and metadata["description"], file
    for variable in metadata["variableMeasured"]:
        assert variable["@type"] == "PropertyValue" and variable["description"], variable
    return [variable["name"] for variable in metadata["variableMeasured"]]


def check_rules():
    """The rules of rules.files and rules.compiled_metadata of the Psych-DS schema."""
    whole = check_metadata(root / "dataset_description.json")
    assert (root / "README.md").stat().st_size > 0
    files = sorted((root / "data").rglob("*.csv"))
    assert files
    for file in files:
        name = re.fullmatch(r"(?:[a-z]+-[a-zA-Z0-9]+)(?:_[a-z]+-[a-zA-Z0-9]+)*_data\.csv", file.name)
        assert name, file
        assert {part.split("-")[0] for part in file.stem.split("_")[:-1]} <= KEYWORDS, file
        beside = file.with_suffix(".json")
        columns = check_metadata(beside) if beside.exists() else whole
        table = read_csv(file)
        assert list(table.columns) == columns, file
        assert len(set(columns)) == len(columns)
    return files


def check_session(session):
    subject = session.attrs["subject"]
    number = int(session.attrs.get("session", 1))
    label = re.sub("[^a-zA-Z0-9]", "", subject)
    table = read_csv(root / "data" / f"subject-{label}_session-{number}_data.csv")
    trials = session["trials"][:]
    assert len(table) == len(trials)
    imported = any(event["kind"] == b"imported" for event in session["events"][:])
    for i, trial in enumerate(trials):
        row = table.iloc[i]
        assert (row.subject, row.session, row["pass"]) == (subject, str(number), str(i))
        assert row.simulated == ("true" if session.attrs["simulated"] else "false")
        assert row.trial_type == trial["condition"].decode()
        for name in ("trial", "block", "repetition", "attempt", "practice"):
            assert row[name] == str(trial[name]), name
        assert row.status == trial["status"].decode()
        if imported:
            assert row.onset == row.duration == ""
        else:
            assert round(float(row.onset) * session.attrs["rate"]) == trial["first_sample"]
    check_answers(session, table)


def check_answers(session, table):
    if "responses" not in session:
        return
    for answer in session["responses"][:]:
        row = table.iloc[answer["pass"]]
        name = answer["question"].decode()
        assert row[name] == (answer["text"].decode() or f"{answer['value']:g}"), name
        if answer["correct"] >= 0:
            assert row[name + "_correct"] == str(answer["correct"])
    for level in session["levels"][:]:
        row = table.iloc[level["pass"]]
        assert row.track == level["track"].decode()
        assert float(row[level["variable"].decode()]) == level["applied"]


csv_files = check_rules()
sessions = 0
for session_file in sys.argv[2:]:
    with h5py.File(session_file, "r") as opened:
        check_session(opened)
        sessions += 1
assert sessions == len([file for file in csv_files if file.name.startswith("subject-")])
print("equal")

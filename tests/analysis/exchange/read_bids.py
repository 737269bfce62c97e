"""Reads a BIDS data set with pandas and holds it against the session files, read with h5py.

    read_bids.py DATA_SET SESSION.h5 [SESSION.h5 ...]     one session of each subject

A data set with motion/ is held against the ticks that are nearest to the times of its rate.
"""
import json
import pathlib
import sys

import h5py
import numpy as np
import pandas as pd

root = pathlib.Path(sys.argv[1])
participants = pd.read_csv(root / "participants.tsv", sep="\t", dtype=str, keep_default_na=False)
events_sidecar = json.loads(next(root.glob("task-*_events.json")).read_text())
description = json.loads((root / "dataset_description.json").read_text())
assert len(participants) == len(sys.argv) - 2


def check(file):
    subject = file.attrs["subject"]
    person = participants[participants.subject == subject].iloc[0]
    assert person.simulated == ("true" if file.attrs["simulated"] else "false")
    assert description["Name"].startswith("SIMULATED") == bool(file.attrs["simulated"])
    folder = root / person.participant_id / "beh"
    sidecar = json.loads(next(folder.glob("*_physio.json")).read_text())
    assert sidecar["SamplingFrequency"] == file.attrs["rate"]
    assert sidecar["Simulated"] == bool(file.attrs["simulated"])
    table = pd.read_csv(next(folder.glob("*_physio.tsv.gz")), sep="\t", header=None,
                        names=sidecar["Columns"], na_values="n/a", float_precision="round_trip")
    samples = file["samples"][:]
    first = int(samples["sequence"][0])
    # Row k is tick first + k: units, rate and every value as in the session file.
    assert len(table) == int(samples["sequence"][-1]) - first + 1
    assert sidecar["StartTime"] == first / file.attrs["rate"]
    rows = (samples["sequence"] - first).astype(int)
    missing = np.setdiff1d(np.arange(len(table)), rows)
    assert sidecar["MissingTicks"] == len(missing)
    assert table.iloc[missing].isna().all(axis=None)
    units = dict(zip(file["samples"].attrs["columns"], file["samples"].attrs["units"]))
    kept = table.iloc[rows]
    assert (np.round(kept.time * 1e9) == samples["time_ns"]).all()
    own = [name for name in sidecar["Columns"][1:] if not name.startswith("device_")]
    for name in own:
        assert np.array_equal(kept[name].to_numpy().astype(samples[name].dtype), samples[name],
                              equal_nan=samples[name].dtype.kind == "f"), name
        assert sidecar[name].get("Units", "1") == units[name], name
        assert sidecar[name]["Description"], name
    assert sidecar["time"]["Units"] == "s"
    check_recorded_devices(file, kept, samples["sequence"], sidecar)
    check_events(file, folder, samples)
    check_stimuli(file, folder)
    if (folder.parent / "motion").exists():
        check_motion(file, folder.parent / "motion", samples)
        ours = next((folder.parent / "motion").glob("*_events.tsv")).read_text()
        assert ours == next(folder.glob("*_events.tsv")).read_text()


def check_recorded_devices(file, table, sequences, sidecar):
    """Every column of every further device; n/a in ticks in which it has no row."""
    rows = file["devices"][:] if "devices" in file else np.empty(0, dtype=[("device", "i4")])
    names = [name for name in rows.dtype.names if name not in ("sequence", "device")]
    devices = np.unique(rows["device"])
    further = [name for name in sidecar["Columns"] if name.startswith("device_")]
    assert further == [f"device_{d}_{name}" for d in devices for name in names]
    for device in devices:
        own = rows[rows["device"] == device]
        there = np.isin(sequences, own["sequence"])
        assert there.sum() == len(own)
        for name in names:
            theirs = table[f"device_{device}_{name}"].to_numpy()
            assert np.array_equal(theirs[there].astype(own[name].dtype), own[name]), name
            assert np.isnan(theirs[~there]).all(), name
            assert "counted from 0" in sidecar[f"device_{device}_{name}"]["Description"]


def check_motion(file, folder, samples):
    sidecar = json.loads(next(folder.glob("*_motion.json")).read_text())
    channels = pd.read_csv(next(folder.glob("*_channels.tsv")), sep="\t", keep_default_na=False)
    frames = json.loads(next(folder.glob("*_channels.json")).read_text())["reference_frame"]["Levels"]
    # The specification's rules: the columns in their order, one name for each, known types.
    assert list(channels.columns[:5]) == ["name", "component", "type", "tracked_point", "units"]
    assert channels.name.is_unique
    assert set(channels.type) <= {"ACCEL", "ANGACCEL", "GYRO", "JNTANG", "LATENCY", "MAGN", "MISC",
                                  "ORNT", "POS", "VEL"}
    assert set(channels.reference_frame) - {"n/a"} == set(frames)
    assert frames["world"]["SpatialAxes"] == "RUB"
    for kind, count in channels.type.value_counts().items():
        assert sidecar[kind + "ChannelCount"] == count
    assert sidecar["MotionChannelCount"] == len(channels) and sidecar["TaskName"]
    table = pd.read_csv(next(folder.glob("*_motion.tsv")), sep="\t", header=None,
                        names=list(channels.name), na_values="n/a", float_precision="round_trip")
    rate, loop = sidecar["SamplingFrequency"], file.attrs["rate"]
    ticks = np.floor(np.arange(len(table)) * loop / rate + 0.5).astype(int)
    assert int(samples["sequence"][-1]) - loop / rate <= ticks[-1] <= int(samples["sequence"][-1])
    there = np.isin(ticks, samples["sequence"])
    assert table[~there].isna().all(axis=None)
    rows = np.searchsorted(samples["sequence"], ticks[there])
    for axis in "xyz":
        for column, ours in (("pos", "position"), ("vel", "velocity")):
            theirs = table[there][f"tip_{column}_{axis}"].to_numpy().astype("f4")
            assert np.array_equal(theirs, samples[f"{ours}_{axis}"][rows]), (column, axis)
    check_devices(file, table[there], samples["sequence"][rows], channels)
    late = table[there].latency.to_numpy() * 1e9
    assert (np.round(late) == samples["time_ns"][rows] - samples["time_ns"][0]).all()


def check_devices(file, table, sequences, channels):
    """Further devices stand beside the first; n/a in ticks in which a device has no row."""
    rows = file["devices"][:] if "devices" in file else np.empty(0, dtype=[("device", "i4")])
    devices = np.unique(rows["device"])
    assert channels.tracked_point[channels.type == "POS"].nunique() == 1 + len(devices)
    for device in devices:
        own = rows[rows["device"] == device]
        there = np.isin(sequences, own["sequence"])
        picked = own[np.searchsorted(own["sequence"], sequences[there])]
        for axis in "xyz":
            for column, ours in (("pos", "position"), ("vel", "velocity")):
                theirs = table[f"device_{device}_{column}_{axis}"].to_numpy().astype("f4")
                assert np.array_equal(theirs[there], picked[f"{ours}_{axis}"]), (device, column, axis)
                assert np.isnan(theirs[~there]).all()


def read_events(folder):
    return pd.read_csv(next(folder.glob("*_events.tsv")), sep="\t", na_values="n/a",
                       keep_default_na=False, dtype={"stimulus_seed": str})


def check_events(file, folder, samples):
    events = read_events(folder)
    assert set(events.columns) - {"onset", "duration"} <= set(events_sidecar)
    assert events.onset.is_monotonic_increasing
    passes = events[events["pass"].notna()].set_index("pass").sort_index()
    trials = file["trials"][:]
    assert len(passes) == len(trials)
    rate = file.attrs["rate"]
    for i, trial in enumerate(trials):
        row = passes.loc[i]
        assert round(row.onset * rate) == trial["first_sample"]
        assert round(row.duration * rate) == trial["last_sample"] - trial["first_sample"] + 1
        assert row.stimulus_seed == str(trial["stimulus_seed"])
        assert row.trial_type == trial["condition"].decode()
        for name in ("phase", "status"):
            assert row[name] == trial[name].decode()
        for name in ("trial", "block", "repetition", "attempt", "practice"):
            assert row[name] == trial[name]
        run = samples[(samples["pass"] == i) & (samples["stage"] == 3)]["sequence"]
        assert round(row.run_onset * rate) == run[0]
        assert round(row.run_duration * rate) == run[-1] - run[0] + 1
    others = events[events["pass"].isna()]
    assert len(others) == len(file["events"])
    for row, event in zip(others.itertuples(), np.sort(file["events"][:], order="time_ns")):
        assert round(row.onset * 1e9) == event["time_ns"]
        assert row.event == event["kind"].decode()


def check_stimuli(file, folder):
    stimuli = pd.DataFrame(file["stimuli"][:])
    for row in read_events(folder).dropna(subset="pass").itertuples():
        theirs = pd.read_csv(root / "stimuli" / row.stim_file, sep="\t")
        ours = stimuli[stimuli.block == row.block]
        assert len(theirs) == len(ours) > 0
        for name in ours.columns:
            assert (theirs[name].to_numpy() == ours[name].to_numpy()).all(), name


for name in sys.argv[2:]:
    with h5py.File(name, "r") as session:
        check(session)
print("equal")

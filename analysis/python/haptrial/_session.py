"""Session files as frames."""
from __future__ import annotations

import contextlib
import dataclasses
import os
import pathlib
import sys
from functools import cached_property
from typing import Iterable, Sequence, Union

import numpy as np
import pandas as pd

from . import _haptrial

Path = Union[str, "os.PathLike[str]"]


@dataclasses.dataclass(frozen=True)
class Info:
    """What a session file says of its session."""
    path: str
    subject: str                    #: identifier of the participant
    session: int                    #: number of the participant's session, from 1
    simulated: bool                 #: the participant is a virtual subject
    pilot: bool                     #: tried before the study, no part of it
    rate: float                     #: of the servo loop [Hz]
    clock: str                      #: "real" or "simulated"
    start_utc: str                  #: ISO 8601
    seed: int                       #: of the study, from which every random number follows
    device: str
    device_max_force: float         #: [N]
    device_workspace_radius: float  #: [m]
    definition: str                 #: the experiment's definition, whole
    definition_name: str            #: the file that it came from
    handedness: str
    age_band: str
    sex: str
    notes: str
    program_version: str            #: of the program that wrote the file
    program_commit: str
    schema_version: int             #: of the file
    rows: int                       #: of /samples


class Session:
    """A session file. It is opened for each reading and closed after it; a table that was read as
    an attribute stays in memory until `del session.samples`."""

    def __init__(self, path: Path):
        self._path = os.fspath(path)
        self.info = Info(**_info(self._path))

    def __repr__(self) -> str:
        return f"<haptrial.Session {self._path}: {self.info.subject}, {self.info.rows} samples>"

    @property
    def tables(self) -> list[str]:
        """Names of the tables of the file (docs/session-file.md)."""
        with _hdf5():
            return _haptrial.tables(self._path)

    def table(self, name: str, columns: Sequence[str] | None = None, first: int = 0,
              count: int | None = None) -> pd.DataFrame:
        """A table as a frame.

        name     of the table, "markers" or "/markers"
        columns  those to read, all without; fewer take less memory and time
        first, count   rows [first, first + count), as far as there are any

        frame.attrs["units"] has the unit of each column ("1": a pure number, "": a text),
        frame.attrs["descriptions"] what it means. Numbers have the file's own types; codes such as
        `stage` are categories of their words."""
        parts = _read([self._path], name, columns, first, count)
        return _frame(parts)

    @cached_property
    def samples(self) -> pd.DataFrame:
        """Every tick: time_ns [ns], pass (row of trials; -1 between passes), stage, position_x,
        position_y, position_z [m], velocity_x … [m/s], force_x … [N] (the device's), applied_force
        and target_force [N], saturated. 70 bytes a row; table("samples", columns=[...]) reads
        some."""
        return self.table("samples")

    @cached_property
    def trials(self) -> pd.DataFrame:
        """One row a pass: trial, condition, phase, block, repetition, first_sample, last_sample,
        status, practice, attempt. A pass whose answer was taken back is an aborted one."""
        return self.table("trials")

    @cached_property
    def responses(self) -> pd.DataFrame:
        """One row an answer to a trial's question; empty if nothing was asked."""
        return self.table("responses")

    @cached_property
    def events(self) -> pd.DataFrame:
        """What happened when: time_ns [ns] on the clock of samples, kind, text."""
        return _joined(self.table("events"))

    @cached_property
    def stimuli(self) -> pd.DataFrame:
        """The ideal movement and force of each block: block, time [s], position_x … [m],
        force [N]."""
        return self.table("stimuli")

    def samples_of(self, row: int, columns: Sequence[str] | None = None) -> pd.DataFrame:
        """The samples of the pass in `row` of trials, read alone."""
        trial = self.trials.iloc[row]
        wanted = None if columns is None else list(dict.fromkeys(["sequence", *columns]))
        first, last = int(trial["first_sample"]), int(trial["last_sample"])
        # A row's number is its sequence number less the ticks that were lost before it.
        frame = self.table("samples", wanted, first, last + 1 - first)
        if len(frame) != last + 1 - first or (frame["sequence"].iloc[[0, -1]] != [first, last]).any():
            frame = self.table("samples", wanted)
        frame = frame[frame["sequence"].between(first, last)].reset_index(drop=True)
        return frame if columns is None else frame[list(columns)]


def open(path: Path) -> Session:  # noqa: A001, as in h5py and gzip
    """Opens a session file (.h5), or the .partial of one that still runs or was killed.

    Raises ValueError, with the sentence of `haptrial info`, for a file that is absent, damaged or
    no session file."""
    return Session(path)


def study(where: Path | Session | Iterable[Path | Session], table: str = "trials",
          columns: Sequence[str] | None = None, threads: int = 0) -> pd.DataFrame:
    """One table of all sessions of a study as one frame.

    where    session files (or Sessions), a folder of them (*.h5), or a list of both; of a folder
             with other sessions pilots are left out, as `haptrial analyze` does
    table    its name, "trials" or "samples" for example
    columns  those to read, all without
    threads  0: as many as there are processors

    In front of the table's columns are `participant` (a category) and `session` (from 1). Files
    are read side by side, straight into the frame's columns. attrs as those of Session.table()."""
    paths = _files(where)
    parts = _read(paths, table, columns, 0, None, threads)
    infos = [_info(path) for path in paths]
    counts = parts["counts"]
    names = list(dict.fromkeys(info["subject"] for info in infos))
    codes = np.repeat(np.array([names.index(info["subject"]) for info in infos],
                               np.min_scalar_type(-len(names))), counts)
    front = {
        "participant": pd.Categorical.from_codes(codes, names),
        "session": np.repeat(np.array([info["session"] for info in infos], np.int16), counts),
    }
    frame = _frame(parts, front)
    frame.attrs["units"] = {"participant": "", "session": "1", **frame.attrs["units"]}
    return _joined(frame) if table.strip("/") == "events" else frame


def _info(path: str) -> dict:
    with _hdf5():
        return _haptrial.info(path)


def _read(paths: list[str], table: str, columns: Sequence[str] | None, first: int,
          count: int | None, threads: int = 0) -> dict:
    wanted = None if columns is None else list(columns)
    with _hdf5():
        return _haptrial.read(paths, table.strip("/"), wanted, first, count, threads)


def _hdf5() -> contextlib.AbstractContextManager:
    """HDF5 is not safe among threads; h5py, if it is there, uses the same library under a lock of
    its own."""
    objects = sys.modules.get("h5py._objects")
    return objects.phil if objects is not None else contextlib.nullcontext()


def _files(where: Path | Session | Iterable[Path | Session]) -> list[str]:
    if isinstance(where, (str, os.PathLike, Session)):
        where = [where]
    files: list[str] = []
    for each in where:
        path = pathlib.Path(each.info.path if isinstance(each, Session) else each)
        if path.is_dir():
            inside = sorted(str(file) for file in path.glob("*.h5"))
            if not inside:
                raise ValueError(f"{path}: has no session file (.h5)")
            files += [file for file in inside if not _info(file)["pilot"]] or inside
        else:
            files.append(str(path))
    if not files:
        raise ValueError("there is no session file; name some, or a folder of them")
    return files


def _frame(parts: dict, front: dict | None = None) -> pd.DataFrame:
    """A frame whose columns are the arrays that were read."""
    columns = dict(front or {})
    for part in parts["columns"]:
        columns[part["name"]] = _values(part)
    frame = pd.DataFrame(columns, copy=False)
    frame.attrs["description"] = parts["description"]
    frame.attrs["units"] = {part["name"]: part["unit"] for part in parts["columns"]}
    frame.attrs["descriptions"] = {part["name"]: part["description"] for part in parts["columns"]}
    return frame


def _values(part: dict):
    values = part["values"]
    if values.dtype.kind == "S":
        return np.array([text.decode() for text in values.tolist()], dtype=object)
    if not part["words"]:
        return values
    names = [part["words"].get(code, f"unused {code}") for code in range(max(part["words"]) + 1)]
    if len(values) and values.max() >= len(names):
        raise ValueError(f"{part['name']} has the code {values.max()}; "
                         f"allowed: {', '.join(part['words'].values())}")
    return pd.Categorical.from_codes(values.view(np.int8), names)


def _joined(events: pd.DataFrame) -> pd.DataFrame:
    """Texts that are longer than their column go on in the rows that follow."""
    whole = (events["part"] == 0).cumsum()
    frame = events[events["part"] == 0].drop(columns="part").reset_index(drop=True)
    frame["text"] = events.groupby(whole.to_numpy())["text"].agg("".join).to_numpy(dtype=object)
    frame.attrs = {key: ({name: value for name, value in each.items() if name != "part"}
                         if isinstance(each, dict) else each)
                   for key, each in events.attrs.items()}
    return frame

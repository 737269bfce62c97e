"""Dry runs of a definition from Python."""
from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
import tempfile

from ._session import Path, Session, _files


def dry_run(definition: Path, *, out: Path | None = None, subjects: int | None = None,
            trials: int | None = None, seed: int = 1, jobs: int | None = None) -> list[Session]:
    """Runs a whole study with virtual subjects by the command `haptrial dry-run`, and opens its
    sessions.

    definition  a file (.toml), or a definition as text
    out         new folder for the session files; without it a temporary one, which stays
    subjects    number of virtual subjects, those of the definition without
    trials      of each session, from the first; all without
    seed        of every random number
    jobs        threads; one for each processor without

    The command is taken from the path, or from the variable HAPTRIAL_COMMAND. Raises ValueError
    with its sentences for a definition that is refused."""
    command = os.environ.get("HAPTRIAL_COMMAND") or shutil.which("haptrial")
    if command is None:
        raise FileNotFoundError("the command haptrial is not in the path; install it, or set "
                                "HAPTRIAL_COMMAND to its file")
    folder = pathlib.Path(tempfile.mkdtemp(prefix="haptrial-"))
    file = pathlib.Path(definition) if "\n" not in str(definition) else folder / "definition.toml"
    if "\n" in str(definition):
        file.write_text(str(definition))
    target = pathlib.Path(out) if out is not None else folder / "study"
    arguments = [command, "dry-run", str(file), "--out", str(target), "--seed", str(seed)]
    for name, number in (("--subjects", subjects), ("--trials", trials), ("--jobs", jobs)):
        arguments += [name, str(number)] if number is not None else []
    done = subprocess.run(arguments, capture_output=True, text=True)
    if done.returncode != 0:
        kind = ValueError if done.returncode == 2 else RuntimeError
        raise kind(done.stderr.strip() or f"haptrial dry-run ended with {done.returncode}")
    return [Session(path) for path in _files(target)]

"""Dry runs of a definition from Python."""
from __future__ import annotations

import inspect
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import textwrap
from typing import Any, Callable

from ._session import Path, Session, _files

Asked = Callable[[dict], Any]  # of a question

_ASKED = """

import json as _json, sys as _sys
for _line in _sys.stdin:
    _said = {name}(_json.loads(_line))
    print(_json.dumps(_said if isinstance(_said, dict) else {{"{key}": _said}}))
"""


def _script(asked: Asked | Path, key: str, file: pathlib.Path) -> pathlib.Path:
    """The file of a script; a function's text becomes one."""
    if not callable(asked):
        return pathlib.Path(asked).absolute()
    name = getattr(asked, "__name__", "")
    if not inspect.isfunction(asked) or not name.isidentifier() or asked.__closure__:
        raise ValueError(f"{name or asked!r} is no function that stands alone; give one that def "
                         "names and that takes nothing from a function around it, or a script's "
                         "file")
    try:
        text = textwrap.dedent(inspect.getsource(asked))
    except OSError as error:
        raise ValueError(f"the text of {name} is not known; define it in a file or a notebook, or "
                         "give a script's file") from error
    text = "from __future__ import annotations\n\n" + text
    file.write_text(text + _ASKED.format(name=name, key=key))
    return file


def dry_run(definition: Path, *, out: Path | None = None, subjects: int | None = None,
            trials: int | None = None, seed: int = 1, jobs: int | None = None,
            decision: Asked | Path | None = None,
            levels: Asked | Path | None = None) -> list[Session]:
    """Runs a whole study with virtual subjects by the command `haptrial dry-run`, and opens its
    sessions.

    definition  a file (.toml), or a definition as text
    out         new folder for the session files; without it a temporary one, which stays
    subjects    number of virtual subjects, those of the definition without
    trials      of each session, from the first; all without
    seed        of every random number
    jobs        threads; one for each processor without
    decision    a function that answers in place of the virtual participants, or a script's file.
                It is given a dict: percepts and stimulus of each interval, choices (or low and
                high), proposed, seed and more (docs/guide-own-experiment.md); it returns one of the
                choices, a number where one is typed, or None for the participant's own answer, and
                in {"answer": ..., "reaction_time": ...} the time, too [s]
    levels      likewise a function that returns the next level of a procedure, or None

    A function's text becomes a script, which runs in a process of its own for each session and
    which the session files keep. So it imports in its body what it uses, and what it remembers
    stays within its session.

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
    for asked, key, table in ((decision, "answer", "observer.script"),
                              (levels, "level", "level_script")):
        if asked is not None:
            file_of_script = _script(asked, key, folder / f"{key}.py")
            arguments += ["--set", f"{table}.file={json.dumps(str(file_of_script), ensure_ascii=False)}"]
    done = subprocess.run(arguments, capture_output=True, text=True)
    if done.returncode != 0:
        kind = ValueError if done.returncode == 2 else RuntimeError
        raise kind(done.stderr.strip() or f"haptrial dry-run ended with {done.returncode}")
    return [Session(path) for path in _files(target)]

"""Procedures that choose the next level, for anybody's experiment."""
from __future__ import annotations

from . import _haptrial, _toml

Procedure = _haptrial.Procedure


def procedure(keys: dict, seed: int = 1) -> Procedure:
    """A procedure from the keys of a definition's [procedure] (docs/keys.md).

        staircase = haptrial.procedure({
            "kind": "staircase", "range": [0.0, 10.0], "start": 8.0, "steps": [2.0, 1.0, 0.5],
            "down": 2, "up": 1, "stop": {"reversals": 8, "trials": 60}})
        while not staircase.finished:
            staircase.answer(asks_a_person(staircase.next()))
        staircase.estimates

    kind is any kind that [procedure] of a definition takes, such as staircase, psi or surface.
    `variable` may be left out. seed: of the order of listed levels. Raises ValueError with a
    sentence for every key that is wrong, missing or unknown."""
    found = _haptrial.procedures(_text(keys), "procedure", False, seed)
    if len(found) != 1:
        raise ValueError(f"procedure: has {len(found)} tracks; allowed: one, or call procedures()")
    return found[0]


def procedures(keys: dict | str, seed: int = 1) -> dict[str, Procedure]:
    """Every track by its name: of keys that have `tracks`, or of a definition as text, such as
    session.info.definition. A session gives each track a seed of its own, which matters for listed
    levels alone."""
    whole = isinstance(keys, str)
    found = _haptrial.procedures(keys if whole else _text(keys), "procedure", whole, seed)
    return {each.name: each for each in found}


def _text(keys: dict) -> str:
    own = {"variable": "level"} if _haptrial.sets_one_variable(str(keys.get("kind"))) else {}
    return _toml.table("procedure", {**own, **keys})

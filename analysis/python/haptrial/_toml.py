"""Tables of a definition from dictionaries."""
from __future__ import annotations

import json

import numpy as np


def table(name: str, keys: dict) -> str:
    """[name] with a line for each key, so that sentences about mistakes name a line."""
    return f"[{name}]\n" + "".join(f"{_key(key)} = {value(each)}\n" for key, each in keys.items())


def value(each) -> str:
    """A value as TOML has it; dictionaries become inline tables."""
    if isinstance(each, np.ndarray):
        each = each.tolist()
    if isinstance(each, (bool, np.bool_)):
        return "true" if each else "false"
    if isinstance(each, str):
        return json.dumps(each)
    if isinstance(each, dict):
        return "{ " + ", ".join(f"{_key(key)} = {value(one)}" for key, one in each.items()) + " }"
    if isinstance(each, (list, tuple, range)):
        return "[" + ", ".join(value(one) for one in each) + "]"
    if isinstance(each, (int, np.integer)):
        return repr(int(each))
    return repr(float(each))


def _key(name: str) -> str:
    bare = name.replace("_", "").replace("-", "").isalnum() and name.isascii()
    return name if bare else json.dumps(name)

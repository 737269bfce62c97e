"""What the handle does in every definition with every hand: trains of turns, steps, work and faults.

Every shipped definition and those of careless.toml are checked by `haptrial validate` and presented by
`haptrial dry-run` at several rates, delays of the force and hands. The table has a row for each
definition and loop and a column for each hand; a cell says

    seconds in trains (the longest train) / largest step of the force [N] / passes aborted of passes

session_swings.py says what a train is. A step is the change of the force from one tick to the next;
the tick in which a fault cuts the force to zero does not count. `w` after a cell means that validate
warned, `refused` that it refused. The force of a row with kinds of fields in brackets may swing, since
those fields move by themselves.
"""
import argparse
import collections
import csv
import json
import math
import multiprocessing
import os
import random
import re
import subprocess
import sys
import tempfile
import tomllib

from session_swings import LONGEST, Gains, measure

HERE = os.path.dirname(os.path.abspath(__file__))
SHIPPED = os.path.join(HERE, "..", "..", "experiments")

FREE_STEP = 500.0  # of the force, that is accepted beside what contact explains [N/s]
PUSHING = {"vibration", "tap", "pulse", "grating", "texture"}  # whose force may swing and step
STEERING = {"matrix_viscous", "minimum_jerk", "path"}  # whose force may swing
RIPPLED = {"detent"}                                   # whose force swings as a hand moves over it

LOOPS = [(500, 1), (500, 3), (1000, 1), (1000, 2), (1000, 3), (2000, 1), (2000, 3), (4000, 1),
         (4000, 3)]  # [Hz], ticks from a command to its force
PROPORTIONAL = [0.001, 0.02, 0.05, 0.15, 0.3, 0.5, 0.8, 2.0]  # hands [kg]; the first is the bare handle


def hand(mass, damping=None, stiffness=None):
    """Keys of [hand]: those of the shipped hand of 0.8 kg, in proportion to the mass."""
    return {"hand_mass": mass,
            "damping": 15.0 * mass / 0.8 if damping is None else damping,
            "stiffness": 250.0 * mass / 0.8 if stiffness is None else stiffness}


HANDS = {f"{mass:g} kg": hand(mass) for mass in PROPORTIONAL}
HANDS["firm"] = hand(2.0, stiffness=3000.0)
HANDS["released"] = hand(0.001, damping=0.0, stiffness=0.0)

Cell = collections.namedtuple("Cell", "name definition rate delay hand")
QUICK_LOOPS = [(500, 3), (1000, 1)]
QUICK_HANDS = ["0.001 kg", "0.05 kg", "0.3 kg", "0.8 kg"]
DRILLING_LOOPS = [(1000, 1), (1000, 3)]
DRILLING_HANDS = ["0.001 kg", "0.15 kg", "0.3 kg", "0.8 kg", "2 kg"]


# --- definitions ---
def merge(base, other):
    """Keys of `other` in place of those of `base`, table by table; an action is replaced whole."""
    merged = dict(base)
    for key, value in other.items():
        both = isinstance(value, dict) and isinstance(merged.get(key), dict) and "do" not in value
        merged[key] = merge(merged[key], value) if both else value
    return merged


def toml(value):
    """A value of TOML on one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(k)} = {toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(toml(v) for v in value) + "]"
    if isinstance(value, (str, bool)):
        return json.dumps(value, ensure_ascii=False)
    return repr(value)


def write_definition(definition, file):
    with open(file, "w", encoding="utf-8") as out:
        out.writelines(f"{key} = {toml(value)}\n" for key, value in definition.items())


def read_toml(file):
    with open(file, "rb") as source:
        return tomllib.load(source)


def careless_definitions():
    tables = read_toml(os.path.join(HERE, "careless.toml"))
    base = tables.pop("base")
    return {name: merge(base, merge(table, {"experiment": {"name": name}}))
            for name, table in tables.items()}


def shipped_definitions():
    names = sorted(f[:-5] for f in os.listdir(SHIPPED) if f.endswith(".toml") and ".texts." not in f)
    return {name: read_toml(os.path.join(SHIPPED, name + ".toml")) for name in names}


def is_drilling(definition):
    return "drilling" in definition


def at_loop(definition, rate, delay, keys):
    """The definition at a rate and a delay of the force, for a hand with these keys."""
    changed = {"experiment": {"rate": float(rate)}, "device": {"force_delay": delay}, "hand": keys}
    if is_drilling(definition):
        changed["drilling"] = {"time_limit": 15.0}
    return merge(definition, changed)


def active_fields(definition):
    """Kinds of fields that move by themselves; a burr vibrates."""
    kinds = {field.get("type") for field in definition.get("fields", {}).values()}
    return ["burr"] if is_drilling(definition) else sorted(kinds & (PUSHING | STEERING | RIPPLED))


def numbers(value):
    """Every number in a value, however deep."""
    if isinstance(value, dict):
        return [n for each in value.values() for n in numbers(each)]
    if isinstance(value, list):
        return [n for each in value for n in numbers(each)]
    return [value] if isinstance(value, (int, float)) and not isinstance(value, bool) else []


def greatest_of_formula(formula, levels):
    """A formula's value with the greatest level of each of its names, which all of them grow with."""
    names = set(re.findall(r"\$(\w+)", formula))
    most = max(levels.values(), default=0.0)
    text = re.sub(r"\$(\w+)", lambda found: str(levels.get(found[1], most)), formula)
    if names and re.fullmatch(r"[-\d.e+*/() ]+", text):
        return float(eval(text, {"__builtins__": {}}))
    return most


def levels_of(definition):
    """The greatest number by each name that trials vary."""
    procedure = definition.get("procedure", {})
    varied = {**definition.get("factors", {}), **definition.get("variables", {})}
    if "variable" in procedure:
        varied[procedure["variable"]] = procedure
    varied[""] = [definition.get("procedure", {}), definition.get("intervals", {})]
    return {name: max(numbers(value)) for name, value in varied.items() if numbers(value)}


def greatest(definition, *names):
    """The greatest number that stands under a key of these names."""
    levels = levels_of(definition)
    found = [0.0]

    def look(table):
        for key, value in table.items():
            if isinstance(value, dict):
                look(value)
            elif key in names:
                formula = isinstance(value, str)
                found += [greatest_of_formula(value, levels)] if formula else numbers(value)
    for section in ("fields", "objects", "guidance", "tutoring"):
        look(definition.get(section, {}))
    return max(found)


def key_stiffness(field):
    """The steepest slope of the force of a detent or a click [N/m]."""
    if field.get("type") == "detent":
        return 2.0 * math.pi * field["peak"] / field["spacing"]
    if field.get("type") == "click":
        return max(field["peak"] / field["travel"],
                   0.5 * math.pi * field["drop"] / field["drop_travel"])
    return 0.0


def gains_of(definition):
    """The greatest gains that a definition states."""
    fields = definition.get("fields", {}).values()
    keys = [key_stiffness(field) for field in fields]
    slips = [field["static"] - field["dynamic"] for field in fields if field.get("type") == "friction"]
    return Gains(max([greatest(definition, "stiffness", "spring"), *keys]),
                 greatest(definition, "damping", "matrix"), greatest(definition, "mass"), max([0.0, *slips]))


# --- one cell of the table ---
def run(command, folder):
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder, check=False)
    return done.returncode, done.stdout + done.stderr


def present(cell, haptrial, folder):
    """What validate says of a cell, and what a dry run of it does."""
    definition = at_loop(cell.definition, cell.rate, cell.delay, HANDS[cell.hand])
    file = os.path.join(folder, cell.name + ".toml")
    write_definition(definition, file)
    status, said = run([haptrial, "validate", file], folder)
    warnings = re.findall(r"(?m)^warning: (.*)", said)
    result = {"name": cell.name, "rate": cell.rate, "delay": cell.delay, "hand": cell.hand,
              "active": " ".join(active_fields(definition)), "validate": status,
              "warnings": " | ".join(warnings) if status == 0 else said.strip()}
    if status != 0:
        return result
    trials = "1" if is_drilling(definition) else "4"
    sessions = os.path.join(folder, "sessions")
    _, said = run([haptrial, "dry-run", file, "--subjects", "1", "--trials", trials, "--jobs", "1",
                   "--out", sessions], folder)
    files = [f for f in os.listdir(sessions) if f.endswith(".h5")] if os.path.isdir(sessions) else []
    if not files:
        return {**result, "failed": said.strip()}
    file = os.path.join(sessions, files[0])
    return {**result, **measure(file, cell.delay, gains_of(definition))}


def present_cell(task):
    cell, haptrial, keep = task
    if keep:
        folder = os.path.join(os.path.abspath(keep),
                              f"{cell.name}-{cell.rate}-{cell.delay}-{cell.hand.replace(' ', '-')}")
        os.makedirs(folder)
        return present(cell, haptrial, folder)
    with tempfile.TemporaryDirectory() as folder:
        return present(cell, haptrial, folder)


def loops_and_hands(definition, quick):
    if is_drilling(definition):
        return ([], []) if quick else (DRILLING_LOOPS, DRILLING_HANDS)
    return (QUICK_LOOPS, QUICK_HANDS) if quick else (LOOPS, HANDS)


def cells_of(options):
    """The cells of the table, row by row; drillings, which take longest, come last."""
    definitions = {**shipped_definitions(), **careless_definitions()}
    cells = []
    for name, definition in sorted(definitions.items(), key=lambda item: is_drilling(item[1])):
        loops, hands = loops_and_hands(definition, options.quick)
        cells += [Cell(name, definition, *loop, each) for loop in loops for each in hands]
    cells = [c for c in cells if re.search(options.only, f"{c.name} {c.rate} {c.delay} {c.hand}")]
    return random.Random(1).sample(cells, min(options.sample, len(cells))) if options.sample else cells


# --- the table ---
COLUMNS = ("name rate delay hand active validate warnings failed trains longest long_trains step "
           "any_step unexplained work passes completed aborted faults seconds sentences").split()


def as_text(result):
    if result is None:
        return "-"
    if int(result["validate"]) != 0:
        return "refused"
    if result.get("failed"):
        return "failed"
    trains, longest, step = (float(result[key]) for key in ("trains", "longest", "step"))
    return (f"{trains:.2f} ({longest:.2f}) / {step:.2f} / {result['aborted']} of {result['passes']}"
            + (" w" if result["warnings"] else ""))


def breaks_rule(result):
    """A train or a step that validate should not have let pass."""
    if int(result["validate"]) != 0 or result.get("failed"):
        return False
    active = set(result["active"].split())
    swings = int(result["long_trains"]) > 0 and not active
    steps = float(result["unexplained"]) > FREE_STEP / float(result["rate"])
    return swings or steps and active <= STEERING | RIPPLED


def key_of(result):
    return result["name"], int(result["rate"]), int(result["delay"]), result["hand"]


def print_row(row, hands, results, before):
    name, rate, delay = row
    first = next(r for r in results.values() if r["name"] == name)
    cells = []
    for each in hands:
        key = (*row, each)
        if key not in results:
            cells.append("")
            continue
        cells.append((as_text(before.get(key)) + " → " if before else "") + as_text(results[key]))
    mark = f" ({first['active']})" if first["active"] else ""
    print(f"| {name}{mark} | {rate} | {delay} | " + " | ".join(cells) + " |", flush=True)


def read_results(file):
    with open(file, newline="", encoding="utf-8") as source:
        return {key_of(row): row for row in csv.DictReader(source)}


def measured(cells, haptrial, jobs, csv_file=os.devnull, keep=None, in_order=True):
    """Results of the cells; each is written to the CSV file as soon as it is there."""
    tasks = [(cell, os.path.abspath(haptrial), keep) for cell in cells]
    with (open(csv_file or os.devnull, "w", newline="", encoding="utf-8") as file,
          multiprocessing.Pool(jobs) as pool):
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for result in (pool.imap if in_order else pool.imap_unordered)(present_cell, tasks):
            writer.writerow({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in result.items()})
            file.flush()
            yield result


def summary(results):
    passed = [r for r in results if int(r["validate"]) == 0]
    broken = [r for r in passed if breaks_rule(r)]
    silent = sum(not r["warnings"] for r in broken)
    return (f"{len(results)} cells, {len(results) - len(passed)} refused; {len(broken)} break the rule: no "
            f"train above {LONGEST} s, no step of {FREE_STEP / 1000:g} N in a millisecond more than contact explains; "
            f"{silent} of them without a warning")


def read_options():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("haptrial")
    parser.add_argument("before", nargs="?", help="an older haptrial, or the CSV file of its run")
    parser.add_argument("--quick", action="store_true",
                        help="two loops and four hands, no drillings: three minutes on two cores")
    parser.add_argument("--sample", type=int, help="so many cells by chance; only the last line says something then")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", default="", help="regular expression of 'NAME RATE DELAY HAND'")
    parser.add_argument("--csv", help="new file with every figure")
    parser.add_argument("--keep", help="new folder for the definitions and session files")
    return parser.parse_args()


def main():
    options = read_options()
    cells = cells_of(options)
    if not cells:
        sys.exit(f"no cell is called {options.only}")
    hands = [h for h in HANDS if any(c.hand == h for c in cells)]
    before = {}
    if options.before and options.before.endswith(".csv"):
        before = read_results(options.before)
    elif options.before:
        before = {key_of(r): r for r in measured(cells, options.before, options.jobs)}
    print("| definition | Hz | ticks late | " + " | ".join(hands) + " |")
    print("| --- | --- | --- | " + " | ".join("---" for _ in hands) + " |")
    last = {(c.name, c.rate, c.delay): c.hand for c in cells}
    results = {}
    for result in measured(cells, options.haptrial, options.jobs, options.csv, options.keep,
                           not options.sample):
        results[key_of(result)] = result
        if not options.sample and last[key_of(result)[:3]] == result["hand"]:
            print_row(key_of(result)[:3], hands, results, before)
    print(f"\n{summary(list(results.values()))}")


if __name__ == "__main__":
    main()

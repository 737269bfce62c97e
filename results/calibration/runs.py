#!/usr/bin/env python3
"""The runs of results/calibration: `list` prints them for regenerate.sh, `tables VERSION` writes
summary.csv, error-by-evaluation.svg and manifest.json from what they gave."""
import csv
import hashlib
import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).parent
RUNS = {
    "gear-equal": "gear.toml --share equal --evaluations 100",
    "gear": "gear.toml --evaluations 100",
    "gear-made": "gear.toml --made 4 --evaluations 60",
    "gear-grid-made": "gear.toml --made 4 --constants grid --evaluations 100",
    "pad-equal": "../../experiments/deformable/pad.toml --share equal --evaluations 100",
    "pad": "../../experiments/deformable/pad.toml --evaluations 100",
    "pad-made": "../../experiments/deformable/pad.toml --made 6 --evaluations 100",
    "cube-equal": "cube.toml --share equal --evaluations 100",
    "cube": "cube.toml --evaluations 100",
    "cube-made": "cube.toml --made 4 --evaluations 40",
    "cube-volume-grid": "cube.toml --share volume --constants grid --grid 5 5 5 --evaluations 100",
    "gear-annealing": "gear.toml --share equal --method annealing --evaluations 300",
}


def millimetres(metres):
    return "unstable" if metres is None else f"{1e3 * metres:.3f}"


def percent(share):
    return "" if share is None else f"{100 * share:.1f}"


def summary():
    rows = []
    for name in RUNS:
        run = json.loads((HERE / f"{name}.json").read_text())
        unseen = [load for load in run["loads"] if load["unseen"]]
        rows.append({
            "run": name, "share": run["share"], "parameters": run["parameters"],
            "loads_seen": sum(not load["unseen"] and not load["held_out"] for load in run["loads"]),
            "loads_held_out": sum(load["held_out"] for load in run["loads"]),
            "evaluations": run["evaluations"],
            "within_5_percent": run["evaluations_to_5_percent"], "unstable": run["unstable"],
            "seconds": f"{run['seconds']:.0f}",
            "by_hand_mm": millimetres(run["hand_error_m"]),
            "calibrated_mm": millimetres(run["error_m"]),
            "seen_left_percent": percent(run["seen_share_left"]),
            "unseen_moved_mm": millimetres(unseen[0]["moved_m"]),
            "unseen_by_hand_mm": millimetres(unseen[0]["hand_error_m"]),
            "unseen_calibrated_mm": millimetres(unseen[0]["error_m"]),
            "unseen_left_percent": percent(run["unseen_share_left"]),
            "unseen_force_at_tool_percent": percent(unseen[0]["tool_force_error"]),
        })
    with open(HERE / "summary.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def figure():
    """Least error so far over evaluations (the source's Figure 36)."""
    lines, data = [], []
    for number, (name, label) in enumerate({
            "gear-annealing": "equal shares, annealing", "gear-equal": "equal shares, descent",
            "gear": "by material, descent"}.items()):
        with open(HERE / f"{name}.csv") as file:
            points = [(row["evaluation"], row["best_mm"]) for row in csv.DictReader(file)
                      if row["best_mm"]]
        data.append("\n".join(f"{x} {y}" for x, y in points) + "\ne\n")
        colour = ["#e69f00", "#d55e00", "#0072b2"][number]
        lines.append(f"'-' with steps lw 2 lc rgb '{colour}' title '{label}'")
    script = f"""set terminal svg size 760,420 font 'DejaVu Sans,12' background rgb 'white'
set output '{HERE / "error-by-evaluation.svg"}'
set grid lc rgb '#dddddd'
set xlabel 'evaluations'
set ylabel 'least error so far (mm)'
set logscale x
set yrange [0:4]
plot {", ".join(lines)}
{"".join(data)}"""
    subprocess.run(["gnuplot"], input=script, text=True, check=True)


def manifest(version):
    files = sorted(p for p in HERE.iterdir() if p.suffix in (".csv", ".toml", ".ply"))
    (HERE / "manifest.json").write_text(json.dumps({
        "study": "calibration",
        "simulated": False,
        "computed": "springs are calibrated to elements; truth_cube.csv also to a real cube",
        "commands": [f"haptrial deform calibrate results/calibration/{run} --out OUT/{name}"
                     for name, run in RUNS.items()],
        "program": version,
        "sha256": {p.name: hashlib.sha256(p.read_bytes()).hexdigest() for p in files},
    }, indent=2) + "\n")


if sys.argv[1] == "list":
    for name, run in RUNS.items():
        print(name, run)
else:
    summary()
    figure()
    manifest(sys.argv[2])

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
    "gear-descent": "gear.toml --evaluations 100",
    "gear-annealing-1": "gear.toml --method annealing --seed 1 --evaluations 300",
    "gear-annealing-2": "gear.toml --method annealing --seed 2 --evaluations 300",
    "gear-annealing-3": "gear.toml --method annealing --seed 3 --evaluations 300",
    "gear-grid-descent": "gear.toml --constants grid --evaluations 150",
    "gear-grid-annealing": "gear.toml --constants grid --method annealing --evaluations 400",
    "gear-elements-descent": "gear.toml --constants elements --evaluations 100",
    "gear-both-descent": "gear-both.toml --evaluations 100",
    "gear-both-grid-descent": "gear-both.toml --constants grid --evaluations 150",
    "cube-descent": "cube.toml --evaluations 100",
    "cube-grid-descent": "cube.toml --constants grid --grid 5 5 5 --evaluations 150",
}


def millimetres(metres):
    return "unstable" if metres is None else f"{1e3 * metres:.3f}"


def summary():
    rows = []
    for name in RUNS:
        run = json.loads((HERE / f"{name}.json").read_text())
        seen = [load for load in run["loads"] if not load["unseen"]]
        unseen = [load for load in run["loads"] if load["unseen"]]
        rows.append({
            "run": name, "parameters": run["parameters"], "evaluations": run["evaluations"],
            "within_5_percent": run["evaluations_to_5_percent"], "unstable": run["unstable"],
            "seconds": f"{run['seconds']:.0f}",
            "moved_mm": millimetres(sum(load["moved_m"] for load in seen) / len(seen)),
            "by_hand_mm": millimetres(run["hand_error_m"]),
            "calibrated_mm": millimetres(run["error_m"]),
            "unseen_moved_mm": millimetres(unseen[0]["moved_m"]),
            "unseen_by_hand_mm": millimetres(unseen[0]["hand_error_m"]),
            "unseen_calibrated_mm": millimetres(unseen[0]["error_m"]),
        })
    with open(HERE / "summary.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def figure():
    """Least error so far over evaluations (the source's Figure 36)."""
    lines, data = [], []
    for number, (name, label) in enumerate({
            "gear-descent": "three constants, descent",
            "gear-annealing-1": "three constants, annealing, seed 1",
            "gear-annealing-2": "seed 2", "gear-annealing-3": "seed 3",
            "gear-grid-descent": "grid, descent", "gear-grid-annealing": "grid, annealing"}.items()):
        with open(HERE / f"{name}.csv") as file:
            points = [(row["evaluation"], row["best_mm"]) for row in csv.DictReader(file)
                      if row["best_mm"]]
        data.append("\n".join(f"{x} {y}" for x, y in points) + "\ne\n")
        colour = ["#0072b2", "#d55e00", "#e69f00", "#cc79a7", "#009e73", "#7d4fa0"][number]
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

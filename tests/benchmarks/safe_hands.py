"""Every shipped definition with every hand: how long the force is at its limit, and what ends it.

usage: safe_hands.py HAPTRIAL [HAPTRIAL_BEFORE]
Dry runs with the hand's mass from nearly nothing to 2 kg (damping and stiffness in proportion), at
1 to 4 kHz and with forces that come one to three ticks late. Prints a Markdown table: seconds with
the force at its limit, of the seconds with a force, the passes that were aborted, and the tracking
error; with a second command, which may be older and know no force_delay, also those of that one.
"""
import os
import re
import subprocess
import sys
import tempfile

import h5py
import numpy

EXPERIMENTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "experiments")
MASSES = [0.001, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0]  # [kg]
LOOPS = [(1000, 1), (1000, 2), (1000, 3), (2000, 1), (2000, 3), (4000, 1), (4000, 3)]
FORCE_STUDIES = ["force_training", "force_training_curve"]
DRILLINGS = ["bone_drilling", "construct_validity"]


def with_key(text, key, value):
    changed, count = re.subn(rf"(?m)^{key} *=[^\n#]*", f"{key} = {value} ", text, count=1)
    if count == 0:
        raise SystemExit(f"no key {key}")
    return changed


def definition(name, mass, rate, delay):
    with open(os.path.join(EXPERIMENTS, name + ".toml"), encoding="utf-8") as file:
        text = file.read()
    share = mass / 0.8
    text = with_key(text, "rate", float(rate))
    head, hand = text.split("\n[hand]", 1)
    for key, value in (("hand_mass", mass), ("damping", 15.0 * share), ("stiffness", 250.0 * share)):
        hand = with_key(hand, key, value)
    text = head + "\n[hand]" + hand
    if delay > 1:
        text = text.replace("\n[device]", f"\n[device]\nforce_delay = {delay}", 1)
        text = re.sub(r"\n\[device\]([^\n]*)\nforce_delay", r"\n[device]\nforce_delay", text)
    if name in DRILLINGS:
        text = with_key(text, "time_limit", 15.0)
    return text


def measure(haptrial, name, mass, rate, delay):
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, name + ".toml")
        with open(file, "w", encoding="utf-8") as out:
            out.write(definition(name, mass, rate, delay))
        command = [haptrial, "dry-run", file, "--subjects", "1", "--out", os.path.join(folder, "s")]
        command += ["--trials", "1" if name in DRILLINGS else "4"]
        done = subprocess.run(command, capture_output=True, text=True, cwd=folder, check=False)
        if done.returncode != 0:
            return {"why": done.stderr.strip().splitlines()[-1] if done.stderr.strip() else "failed"}
        sessions = [f for f in os.listdir(os.path.join(folder, "s")) if f.endswith(".h5")]
        with h5py.File(os.path.join(folder, "s", sessions[0]), "r") as session:
            samples = session["samples"][:]
            trials = session["trials"][:]
    force = numpy.sqrt(sum(samples[f"force_{a}"].astype(float) ** 2 for a in "xyz"))
    run = samples["stage"] == 3
    return {"limit": (force >= 0.98 * 12.0).sum() / rate,
            "driven": (force > 0).sum() / rate,
            "aborted": int((trials["status"] == b"aborted").sum()), "passes": len(trials),
            "y": 1e3 * float(numpy.sqrt(numpy.mean(samples["position_y"][run].astype(float) ** 2)))
                 if run.any() else float("nan")}


def cell(result):
    if "why" in result:
        return result["why"][:60]
    return (f"{result['limit']:.2f} of {result['driven']:.0f} s, "
            f"{result['aborted']} of {result['passes']}, {result['y']:.2f}")


def main():
    commands = [os.path.abspath(path) for path in sys.argv[1:3]]
    names = ["after", "before"][:len(commands)][::-1]
    print("| definition | Hz | ticks late | hand [kg] | " + " | ".join(names) + " |")
    print("| --- | --- | --- | --- | " + " | ".join("---" for _ in names) + " |")
    for name in FORCE_STUDIES + DRILLINGS:
        for rate, delay in LOOPS if name not in DRILLINGS else LOOPS[:1] + LOOPS[2:3]:
            for mass in MASSES if name not in DRILLINGS else MASSES[:1] + MASSES[2:4] + MASSES[5:6]:
                results = []
                for command in commands:
                    old = command != commands[0]
                    results.append({"why": "-"} if old and delay > 1
                                   else measure(command, name, mass, rate, delay))
                print(f"| {name} | {rate} | {delay} | {mass} | "
                      + " | ".join(cell(r) for r in results[::-1]) + " |", flush=True)


if __name__ == "__main__":
    main()

"""A long simulated drilling: memory bounded, volume conserved, and the same bone again.

usage: bone_soak.py HAPTRIAL FOLDER [SECONDS] [DEFINITION]
Runs `haptrial dry-run` for SECONDS (3600) of simulated drilling of the shipped definition, or of
DEFINITION, into the new FOLDER, watches its memory, and replays the session. Prints what it
measured; exits with a message where something is wrong.
"""
import os
import re
import subprocess
import sys
import time

import h5py

REGION = {"width": 0.030, "height": 0.024, "depth": 0.018}  # more than an hour's work


def memory_mb(pid):
    with open(f"/proc/{pid}/status", encoding="ascii") as status:
        for line in status:
            if line.startswith("VmRSS"):
                return int(line.split()[1]) / 1024
    return 0.0


def definition(source, seconds):
    with open(source, encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r"\ntime_limit =.*", f"\ntime_limit = {seconds}", text)
    head, hand = text.split("[drilling_hand]")
    for key, value in REGION.items():
        hand = re.sub(rf"\n{key} =.*", f"\n{key} = {value}", hand, count=1)
    return head + "[drilling_hand]" + hand


def main():
    haptrial, folder = sys.argv[1:3]
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 3600.0
    here = os.path.dirname(os.path.abspath(__file__))
    source = sys.argv[4] if len(sys.argv) > 4 else os.path.join(here, "../../experiments/bone_drilling.toml")
    os.makedirs(folder)
    study = os.path.join(folder, "soak.toml")
    with open(study, "w", encoding="utf-8") as file:
        file.write(definition(source, seconds))
    out = os.path.join(folder, "out")
    begin = time.time()
    run = subprocess.Popen([haptrial, "dry-run", study, "--out", out], stdout=subprocess.DEVNULL)
    memory = []
    while run.poll() is None:
        memory.append((time.time() - begin, memory_mb(run.pid)))
        time.sleep(0.5)
    took = time.time() - begin
    if run.returncode != 0:
        sys.exit("bone_soak.py: the dry run failed")
    memory = [mb for _, mb in memory if mb > 0]
    third = len(memory) // 3
    early, late = max(memory[third:2 * third]), max(memory[2 * third:])
    session = os.path.join(out, "S01.h5")
    with h5py.File(session, "r") as file:
        p = file["procedures"][-1]
        ticks, removals = len(file["tool"]), len(file["removals"])
        error = p["left"] + p["cut"] + p["dust"] + p["suctioned"] + p["fallen"] - p["before"]
        drilled = p["before"] - p["left"]
    size = os.path.getsize(session) / 1e6
    print(f"{ticks} ticks in {took:.0f} s, {ticks / took / 1000:.1f} times real time")
    print(f"{removals} voxels emptied, {drilled:.1f} voxels of density drilled in {p['pieces']} pieces")
    print(f"dust lying {p['dust']:.1f}, suctioned {p['suctioned']:.1f}, fallen {p['fallen']:.1f} voxels")
    print(f"volume is conserved to {abs(error):.3g} voxels")
    print(f"memory at most {early:.0f} MB in the second third, {late:.0f} MB in the last")
    print(f"file {size:.1f} MB, {size / ticks * 3.6e6:.1f} MB an hour")
    if abs(error) > ticks * 2.0**-20:
        sys.exit("bone_soak.py: volume is not conserved")
    if late > 1.1 * early + 16:
        sys.exit("bone_soak.py: memory grows")
    begin = time.time()
    subprocess.run([haptrial, "replay", session], check=True)
    print(f"replayed in {time.time() - begin:.0f} s")


main()

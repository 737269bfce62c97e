#!/usr/bin/env python3
"""How long a preview takes after a change, as the studio makes it.

changed_pages.py HAPTRIAL [DEFINITION...]: in each definition, one decimal number after the other
is made 2 % larger, 50 times, and `haptrial show - --pages` makes the page of each text. Prints the
seconds by the clock of the first page, then the median and the largest of the 50, and the median
of the processor's seconds (with gnuplot's).
"""

import json
import os
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile
import time

CHANGES = 50
TICK = os.sysconf("SC_CLK_TCK")
NUMBER = re.compile(r"(?<![\w.$])\d+\.\d+(?![\w.])")


def processor_seconds(process):
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return sum(int(fields[i]) for i in range(11, 15)) / TICK  # own and waited-for children


def changed(text, chance):
    lines = text.split("\n")
    places = [(i, m) for i, line in enumerate(lines) if not line.lstrip().startswith("#")
              for m in NUMBER.finditer(line.split("#")[0]) if float(m.group()) > 0]
    i, match = chance.choice(places)
    value = f"{float(match.group()) * 1.02:.6g}"
    value += "" if "." in value else ".0"
    lines[i] = lines[i][:match.start()] + value + lines[i][match.end():]
    return "\n".join(lines)


def main():
    haptrial, *files = sys.argv[1:]
    root = pathlib.Path(__file__).resolve().parents[2]
    files = [pathlib.Path(f) for f in files] or sorted(
        f for f in (root / "experiments").glob("*.toml") if ".texts." not in f.name)
    for file in files:
        chance = random.Random(1)
        process = subprocess.Popen([haptrial, "show", "-", "--pages"], stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, text=True)
        process.stdout.readline()
        study = file.with_name(f".{file.stem}-changed.toml")
        with tempfile.TemporaryDirectory() as folder:
            def page(text):
                study.write_text(text)
                before, start = processor_seconds(process), time.monotonic()
                request = {"file": str(study), "trial": 1, "virtual": True,
                           "out": str(pathlib.Path(folder) / "page.html")}
                process.stdin.write(json.dumps(request) + "\n")
                process.stdin.flush()
                answer = json.loads(process.stdout.readline())
                waited = time.monotonic() - start
                return answer, waited, processor_seconds(process) - before

            try:
                text = file.read_text()
                answer, first, _ = page(text)
                times, worked, tries = [], [], 0
                while "page" in answer and len(times) < CHANGES and tries < 4 * CHANGES:
                    tries += 1
                    done, seconds, processor = page(changed(text, chance))
                    if "page" in done:  # else a mistake, which makes no page
                        times.append(seconds)
                        worked.append(processor)
            finally:
                study.unlink()
                process.stdin.close()
                process.wait()
        if not times:
            print(f"{file.stem}: {answer.get('failure', 'no change makes a page').splitlines()[0]}")
            continue
        print(f"{file.stem}: first {first:.2f} s, then {statistics.median(times):.2f} s, "
              f"at most {max(times):.2f} s; processor {statistics.median(worked):.2f} s", flush=True)


main()

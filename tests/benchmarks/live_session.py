"""A long live session with everything on, beside a servo loop that does nothing.

    live_session.py BUILD [SECONDS [RATE [PICTURE.svg]]]

The shipped study on the real clock with the virtual device, the participant's window (under Xvfb),
the console with a page that follows it, and the recorder; then what `haptrial info` says of its
file, and what the idle loop, and cyclictest where it is installed (Debian's rt-tests), saw in the
same minutes. 600 s at 1000 Hz by default.
"""

import csv
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse
import urllib.request

import h5py

ROOT = pathlib.Path(__file__).resolve().parents[2]


def definition(folder, rate):
    text = (ROOT / "experiments/force_training.toml").read_text()
    file = folder / "long.toml"
    file.write_text(re.sub(r"(?m)^rate = \S+", f"rate = {rate:.1f}", text))
    return file


class Page:
    """What a browser does: follows the events, asks for things."""

    def __init__(self, url):
        parts = urllib.parse.urlsplit(url)
        self.base = f"http://{parts.netloc}"
        self.token = urllib.parse.parse_qs(parts.query)["token"][0]
        self.status = {}
        threading.Thread(target=self.follow, args=(url,), daemon=True).start()

    def follow(self, url):
        with urllib.request.urlopen(url.replace("/?", "/events?")) as events:
            for line in events:
                if line.startswith(b"data:"):
                    self.status = json.loads(line[5:])

    def ask(self, what):
        urllib.request.urlopen(urllib.request.Request(
            self.base + "/ask", json.dumps({"request": what}).encode(),
            {"Content-Type": "application/json", "X-Haptrial-Token": self.token}))


def display():
    server = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", "1280x720x24"],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return server, ":" + server.stdout.readline().strip()


def cyclictest(seconds, rate):
    if not shutil.which("cyclictest"):
        return None
    return subprocess.Popen(
        ["cyclictest", "--quiet", "--threads=1", "--priority=80", "--mlockall",
         f"--interval={round(1e6 / rate)}", f"--loops={round(rate * seconds)}",
         "--histogram=100000"], stdout=subprocess.PIPE, text=True)


def percentiles(histogram):
    """Of (value, count) in ascending order."""
    total = sum(count for _, count in histogram)
    found = []
    for share in (0.5, 0.99, 0.999, 1.0):
        seen = 0
        for value, count in histogram:
            seen += count
            if seen >= share * total:
                found.append(value)
                break
    return "median {:.2f}, 99 % {:.2f}, 99.9 % {:.2f}, worst {:.2f} us".format(*found)


def report_cyclictest(text):
    rows = [line.split() for line in text.splitlines() if line[:1].isdigit()]
    print("cyclictest ", percentiles([(int(us), int(n)) for us, n in rows if int(n)]))


def draw(picture, session, idle):
    """The share of ticks that were later than so much."""
    def curve(rows, key):
        rows = [(int(row["bin_high_ns"]), int(row[key])) for row in rows]
        total = left = sum(count for _, count in rows)
        points = []
        for high, count in rows:
            left -= count
            if left:
                points.append(f"{max(high, 10) * 1e-3} {100.0 * left / total}")
        return "\n".join(points) + "\ne\n"

    with h5py.File(session) as file:
        recorded = curve(file["timing"][:], "lateness_count")
    with open(idle) as file:
        alone = curve(csv.DictReader(file), "lateness_count")
    subprocess.run(["gnuplot"], text=True, check=True, input=f"""
        set terminal svg size 640,360 font "DejaVu Sans,12" background "white"
        set output "{picture}"
        set logscale xy
        set xlabel "later than [µs]"
        set ylabel "ticks [%]"
        set grid
        plot "-" with steps lw 2 lc rgb "#0072b2" title "session", \\
             "-" with steps lw 2 dt 2 lc rgb "#d55e00" title "idle loop beside it"
        """ + recorded + alone)


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 600.0
    rate = float(sys.argv[3]) if len(sys.argv) > 3 else 1000.0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        server, screen = display()
        session = subprocess.Popen(
            [build / "haptrial", "run", definition(folder, rate), "--subject", "S01", "--out",
             folder, "--window", "--console"],
            stdout=subprocess.PIPE, text=True, env={"DISPLAY": screen, "HOME": name})
        page = Page(re.search(r"http://\S+", session.stdout.readline()).group())
        while not page.status:
            time.sleep(0.05)
        idle = subprocess.Popen(
            [build / "bench_idle_loop", str(rate), str(seconds), folder / "idle.csv"],
            stdout=subprocess.PIPE, text=True)
        cyclic = cyclictest(seconds, rate)
        page.ask("start")
        while page.status["ticks"] < rate * seconds:
            time.sleep(0.5)
        page.ask("end")
        print(session.communicate()[0])
        server.terminate()
        print(subprocess.run([build / "haptrial", "info", folder / "S01.h5"],
                             stdout=subprocess.PIPE, text=True).stdout)
        print("idle loop  ", idle.communicate()[0].removeprefix("lateness").strip())
        if cyclic:
            report_cyclictest(cyclic.communicate()[0])
        if len(sys.argv) > 4:
            draw(sys.argv[4], folder / "S01.h5", folder / "idle.csv")


main()

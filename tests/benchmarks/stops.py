#!/usr/bin/env python3
"""What becomes of the force when a session is stopped, ended or killed: docs/stopping.md.

stops.py BUILD OUT.svg [--repeats 10]   BUILD holds haptrial and libstand_in_dhd.so

Runs `haptrial run` on the stand-in of an omega.3, whose record holds every force that the program
commanded with its time (tests/support/stand_in_record.h). A real device holds its last force until
the next one or until its watchdog switches the motors off; so does the curve. Prints the table of
docs/stopping.md; needs gnuplot and a Linux with pseudo-terminals.
"""
import argparse
import json
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import tempfile
import time
import urllib.request

SOURCE = os.path.realpath(os.path.join(os.path.dirname(__file__), "../.."))
FAILURE = {name: number for number, name in enumerate(
    re.findall(r"^  k(\w+)", open(os.path.join(SOURCE, "tests/support/stand_in.h")).read(), re.M))}
PULLS = 4.0  # [N]
ROW = 32  # [bytes]


def study(speed):
    text = open(os.path.join(SOURCE, "experiments/force_training.toml")).read()
    values = {"length_x": "0.06", "range_z": "0.03", "speed": speed, "approach_speed": "0.3",
              "wait": "0.2", "recovery": "0.3", "ramp": "0.3", "bump_width_min": "0.3",
              "bump_width_max": "0.5", "settle_distance": "0.02", "repetitions": "1",
              "break_after": "0", "conditions": '["haptic"]',
              "trajectory": "{ stiffness = 900.0, damping = 20.0 }",
              "plane": "{ stiffness = 900.0, damping = 20.0 }"}
    text = re.sub(r"(?m)^(planned|reference) *=[^\n]*\n", "", text)  # nothing is analysed
    for key, value in values.items():
        text, count = re.subn(rf"(?m)^{key} *=[^\n]*", f"{key} = {value}", text, count=1)
        assert count == 1, key
    return text


class Session:
    """`haptrial run` on a terminal of its own, and the forces that its device was given."""

    def __init__(self, build, folder, options="", failure=None, speed="0.01"):
        self.record = os.path.join(folder, "forces")
        with open(os.path.join(folder, "study.toml"), "w") as file:
            file.write(study(speed))
        environment = dict(os.environ, STAND_IN_FORCES=self.record)
        if failure:
            environment.update(STAND_IN_FAILURE=str(FAILURE[failure]),
                               STAND_IN_FAILURE_FORCE=str(PULLS))
        words = [os.path.join(build, "haptrial"), "run", os.path.join(folder, "study.toml"),
                 "--subject", "S01", "--out", os.path.join(folder, "out"), "--device",
                 "force-dimension", "--library", os.path.join(build, "libstand_in_dhd.so"),
                 *options.split()]
        self.process, self.terminal = pty.fork()
        if self.process == 0:
            os.execvpe(words[0], words, environment)
        self.shown = b""
        if "--console" in options:
            self.url = self.line(rb"console: (http://\S+)").decode()
            self.token = self.url.split("token=")[1]
            self.port = int(re.search(r":(\d+)/", self.url)[1])
            self.ask("start")

    def line(self, pattern):
        end = time.monotonic() + 20
        while time.monotonic() < end:
            self.read()
            found = re.search(pattern + rb"\s", self.shown)
            if found:
                return found[1]
        raise RuntimeError(f"no {pattern} in {self.shown}")

    def read(self, seconds=0.02):
        if select.select([self.terminal], [], [], seconds)[0]:
            try:
                self.shown += os.read(self.terminal, 4096)
            except OSError:  # nobody is at the other end any more
                time.sleep(seconds)

    def ask(self, request):
        body = json.dumps({"request": request}).encode()
        urllib.request.urlopen(urllib.request.Request(
            f"http://127.0.0.1:{self.port}/ask", body,
            {"Content-Type": "application/json", "X-Haptrial-Token": self.token}), timeout=5).read()

    def forces(self):
        """[(time [s], force [N])], and the device's watchdog [s]."""
        with open(self.record, "rb") as file:
            count, watchdog = struct.unpack("qd", file.read(16))
            data = file.read(count * ROW)
        rows = [(ns * 1e-9, (x * x + y * y + z * z) ** 0.5)
                for ns, x, y, z in struct.iter_unpack("qddd", data)]
        return rows, watchdog

    def last_force(self):
        try:
            with open(self.record, "rb") as file:
                count, _ = struct.unpack("qd", file.read(16))
                file.seek(16 + (count - 1) * ROW)
                _, x, y, z = struct.unpack("qddd", file.read(ROW))
                return (x * x + y * y + z * z) ** 0.5
        except (OSError, struct.error, ValueError):
            return 0.0

    def wait_for_pull(self):
        end = time.monotonic() + 30
        while self.last_force() < PULLS:
            self.read(0.005)
            if time.monotonic() > end:
                raise RuntimeError(f"no force; {self.shown.decode(errors='replace')}")
        time.sleep(0.05)

    def wait_for_end(self, seconds=20):
        """The exit status; None when it had to be killed."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.read(0.01)
            done, status = os.waitpid(self.process, os.WNOHANG)
            if done:
                self.process = 0
                return status
        return None

    def close(self):
        if self.process:
            os.kill(self.process, signal.SIGKILL)
            os.waitpid(self.process, 0)
        os.close(self.terminal)


FLOOD = """
import socket, sys
says = b"POST /ask HTTP/1.1\\r\\nHost: "
kept = []
while True:
    try:
        one = socket.create_connection(("127.0.0.1", int(sys.argv[1])))
        one.send(says)
        kept = kept[-40:] + [one]
    except OSError:
        pass
"""


def flood(session):
    floods = [subprocess.Popen([sys.executable, "-c", FLOOD, str(session.port)]) for _ in range(3)]
    time.sleep(0.5)
    try:
        start = time.monotonic()
        session.ask("emergency_stop")
    finally:
        for each in floods:
            each.kill()
            each.wait()
    return start


def acted(action):
    def act(session):
        start = time.monotonic()
        action(session)
        return start
    return act


def sends(*numbers):
    def act(session):
        for number in numbers:
            os.kill(session.process, number)
    return acted(act)


def presses(keys):
    return acted(lambda session: os.write(session.terminal, keys))


def hangs_up(session):
    start = time.monotonic()
    os.kill(session.process, signal.SIGHUP)
    return start


ATTENDED = "--console --keyboard"
# name, options, failure of the device, what a person does (None: nothing)
SCENES = [
    ("EMERGENCY STOP on the page", ATTENDED, None, acted(lambda s: s.ask("emergency_stop"))),
    ("the same, flood of connections", ATTENDED, None, flood),
    ("Escape in the terminal", ATTENDED, None, presses(b"\x1b")),
    ("stop button of the handle", ATTENDED, "Button", None),
    ("stop button, no experimenter", "", "Button", None),
    ("Ctrl-C", "", None, presses(b"\x03")),
    ("SIGTERM", "", None, sends(signal.SIGTERM)),
    ("SIGTERM twice at once", "", None, sends(signal.SIGTERM, signal.SIGTERM)),
    ("SIGHUP (terminal closed)", "", None, hangs_up),
    ("SIGQUIT", "", None, sends(signal.SIGQUIT)),
    ("SIGABRT", "", None, sends(signal.SIGABRT)),
    ("SIGSEGV", "", None, sends(signal.SIGSEGV)),
    ("SIGBUS", "", None, sends(signal.SIGBUS)),
    ("SIGFPE", "", None, sends(signal.SIGFPE)),
    ("SIGILL", "", None, sends(signal.SIGILL)),
    ("crash in the servo thread", "", "Crash", None),
    ("Ctrl-Z (suspended)", "", None, presses(b"\x1a")),
    ("SIGKILL: the watchdog", "", None, sends(signal.SIGKILL)),
    ("library hangs: the watchdog", "", "Hang", None),
    ("fault: jump, with experimenter", ATTENDED, "Jump", None),
    ("fault: jump, no experimenter", "", "Jump", None),
    ("fault: motors off", ATTENDED, "ForcesOffByVelocity", None),
    ("Abort on the page", ATTENDED, None, acted(lambda s: s.ask("abort"))),
    ("end of the last trial", "--trials 1", None, "finish"),
]
FADES = ("Abort on the page", "end of the last trial")


def as_felt(rows, watchdog, until):
    """What the motors give: the last command, until the watchdog ends it."""
    felt = []
    for (at, force), following in zip(rows, [row[0] for row in rows[1:]] + [until]):
        felt.append((at, force))
        if force > 0 and following - at > watchdog:
            felt += [(at + watchdog, force), (at + watchdog, 0.0)]
    return felt


def run_scene(build, scene):
    """Forces about the cause, whose time is 0 [ms, N], and the time to zero [ms]."""
    name, options, failure, person = scene
    with tempfile.TemporaryDirectory() as folder:
        session = Session(build, folder, options, failure, "0.06" if person == "finish" else "0.01")
        try:
            if callable(person):
                session.wait_for_pull()
                cause = person(session)
            status = session.wait_for_end(0.5 if options == ATTENDED and name != "Abort on the page" else 60)
            rows, watchdog = session.forces()
        finally:
            session.close()
    assert status is not None or options == ATTENDED or "Ctrl-Z" in name, (name, status)
    felt = as_felt(rows, watchdog, rows[-1][0] + 1.0)
    last = max(i for i, row in enumerate(felt) if row[1] > 0)
    zero = felt[last + 1][0]
    if person == "finish":
        start = last
        while felt[start - 1][1] > felt[start][1]:
            start -= 1
        cause = felt[start][0]
    elif person is None:  # 50 ticks after the force was there (stand_in_record.h)
        cause = rows[50 + next(i for i, row in enumerate(rows) if row[1] >= PULLS)][0]
    before = felt[last][1] if name not in FADES else None
    curve = [(1e3 * (at - cause), force) for at, force in felt if -0.5 < at - cause < 1.0]
    return curve, 1e3 * (zero - cause), before


def draw(curves, out):
    panels = []
    with tempfile.TemporaryDirectory() as folder:
        for number, (name, curve) in enumerate(curves):
            file = os.path.join(folder, f"{number}.dat")
            with open(file, "w") as data:
                for at, force in curve:
                    data.write(f"{at:.3f} {force:.3f}\n")
            reach = "[-50:300]" if name in FADES else "[-10:30]"
            panels.append(f'set title "{name}"\nset xrange {reach}\n'
                          f'plot "{file}" with steps lw 1.5 lc rgb "#1f5fa8" notitle')
        columns = 4
        rows = -(-len(panels) // columns)
        script = f"""set terminal svg size 1120,{rows * 150} font "DejaVu Sans,10" background "white"
set output "{out}"
set multiplot layout {rows},{columns} margins 0.05,0.99,0.035,0.97 spacing 0.045,0.055
set yrange [0:10]
set ytics 0,5
set xtics font ",9"
set title offset 0,-0.8
set grid ytics lc rgb "#dddddd"
set arrow from 0, graph 0 to 0, graph 1 nohead dt 2 lc rgb "#b3140f"
set label "N" at graph 0.02, graph 0.9 tc rgb "#5c6268"
set label "ms" at graph 0.92, graph 0.08 tc rgb "#5c6268"
""" + "\n".join(panels) + "\nunset multiplot\n"
        subprocess.run(["gnuplot"], input=script.encode(), check=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("out")
    parser.add_argument("--repeats", type=int, default=10)
    parser.add_argument("--only", default="", help="scenes whose name holds this")
    options = parser.parse_args()
    curves = []
    print("| what happens | force before [N] | zero after, median [ms] | worst [ms] |\n"
          "| --- | --- | --- | --- |")
    for scene in SCENES:
        if options.only not in scene[0]:
            continue
        runs = sorted((run_scene(options.build, scene) for _ in range(options.repeats)),
                      key=lambda run: run[1])
        curve, middle, before = runs[len(runs) // 2]
        curves.append((scene[0], curve))
        shown = "fades" if before is None else f"{before:.1f}"
        print(f"| {scene[0]} | {shown} | {middle:.1f} | {runs[-1][1]:.1f} |", flush=True)
    draw(curves, os.path.realpath(options.out))


if __name__ == "__main__":
    main()

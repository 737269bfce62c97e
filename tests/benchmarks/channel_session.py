"""Channels of a live session under planted clocks: are the times right, is nothing lost, are ticks later?

A virtual participant's session on the real clock has a force sensor at 7 kHz (RDT over UDP) and a
board at 100 Hz that prints lines with its own clock (a pseudo-terminal). Both clocks drift by 100
millionths, the sensor loses records and sends some in bursts, the board's clock steps. Each sample
carries the time at which it was measured, so that the session file says how far its time is wrong.
Each session is killed after a random time.

    /usr/bin/python3 tests/benchmarks/channel_session.py build/haptrial [--kills 40]
"""
import argparse
import os
import pty
import random
import re
import signal
import socket
import statistics
import struct
import subprocess
import tempfile
import threading
import time
import tty

import h5py
import numpy

DRIFT = 100e-6
STUDY = """[experiment]
protocol = "trials"
name = "pull"
[design]
participants = 2
[fields.pull]
type = "constant"
force = [0.0, -0.5, 0.0]
[[stages]]
name = "feel"
fields = ["pull"]
until = { time = 1.0 }
[response]
question = "Did it pull?"
choices = [{ value = "yes", keys = ["Y"] }, { value = "no", keys = ["N"] }]
[[blocks]]
name = "one"
trials = TRIALS
[observer]
decides = "yes"
actions.feel = { do = "hold" }
"""
CHANNELS = """[channels.force]
kind = "rdt"
host = "127.0.0.1"
port = %d
rate = 7000.0
counts_per_force = 1.0
counts_per_torque = 1.0
[channels.grip]
kind = "line"
path = "%s"
quantities = { seconds = "s", microseconds = "us" }
columns = ["t", "seconds", "microseconds"]
clock = { column = "t", unit = "us" }
rate = 100.0
"""


def truth(now):
    """The time as two numbers that a record of 32 bits holds: seconds and microseconds."""
    return int(now), int(1e6 * (now - int(now)))


class ForceSensor(threading.Thread):
    """Answers a request of RDT with records, each measured at its own time by its own clock."""

    def __init__(self):
        super().__init__(daemon=True)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        self.over = False
        self.random = random.Random(1)

    def run(self):
        client, measured, number, hold = None, 0.0, 0, 0.0
        period = (1.0 + DRIFT) / 7000.0
        while not self.over:
            self.socket.settimeout(0.001)
            try:
                request, address = self.socket.recvfrom(64)
                command = struct.unpack(">HHI", request[:8])[1]
                client = address if command in (2, 3) else client
                if command in (2, 3):
                    measured, number = time.monotonic(), 0
                client = None if command == 0 else client
            except (TimeoutError, socket.timeout):
                pass
            now = time.monotonic()
            if client is None or now < hold:
                continue
            while measured < now:
                number += 1
                if self.random.random() > 1e-3:  # else it is lost
                    seconds, micros = truth(measured)
                    record = struct.pack(">IIIiiiiii", number, number, 0, seconds, micros, 0, 0, 0, 0)
                    self.socket.sendto(record, client)
                measured += period
            if self.random.random() < 2e-3:  # what comes now comes together
                hold = now + 0.05


class Board(threading.Thread):
    """Prints a line 100 times a second with its own clock, which steps now and then."""

    def __init__(self):
        super().__init__(daemon=True)
        self.master, slave = pty.openpty()
        tty.setraw(slave)
        self.path = os.ttyname(slave)
        self.over = False
        self.random = random.Random(2)
        os.set_blocking(self.master, False)

    def run(self):
        begin, step = time.monotonic(), 0.0
        while not self.over:
            time.sleep(0.01)
            now = time.monotonic()
            if self.random.random() < 5e-4:
                step += 0.3
            clock = int(1e6 * ((now - begin) / (1.0 + DRIFT) + step)) % 2**32
            time.sleep(min(0.004, self.random.expovariate(1000.0)))
            try:
                os.write(self.master, b"%d,%d,%d\n" % (clock, *truth(now)))
            except BlockingIOError:
                pass


def rows_of(file, channel, seconds, micros):
    """Times [s]: as recorded, planted, received, and the stated uncertainty."""
    table = file["channel_" + channel]
    planted = table[seconds].astype(float) + 1e-6 * table[micros].astype(float)
    return 1e-9 * table["time_ns"], planted, 1e-9 * table["received_ns"], table["uncertainty"][:]


def share_within(recorded, planted, received, uncertainty):
    """Share of samples whose planted time is within the uncertainty. The session's clock begins at
    an unknown time: the smallest delay, less than 0.2 ms here, says when."""
    begin = numpy.min(received - planted)
    error = numpy.abs(recorded - (planted + begin))
    return float(numpy.mean(error <= uncertainty)), float(numpy.max(error))


def start(haptrial, definition, out):
    return subprocess.Popen([haptrial, "run", definition, "--subject", "S01", "--device", "virtual", "--out", out],
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def lateness_of(haptrial, file):
    said = subprocess.run([haptrial, "info", file], capture_output=True, text=True, check=False).stdout
    return re.search(r"lateness +(.*)", said).group(1)


def killed_sessions(options, folder, definition):
    shares, worst, lost, number = [], [], [], random.Random(3)
    for kill in range(options.kills):
        out = os.path.join(folder, f"killed-{kill}")
        process = start(options.haptrial, definition, out)
        time.sleep(number.uniform(2.5, 6.0))
        process.send_signal(signal.SIGKILL)
        killed = time.monotonic()
        process.wait()
        with h5py.File(os.path.join(out, "S01.h5.partial"), "r", swmr=True) as file:
            for channel, seconds, micros in (("force", "fx", "fy"), ("grip", "seconds", "microseconds")):
                rows = rows_of(file, channel, seconds, micros)
                if len(rows[0]) == 0:
                    lost.append((channel, float("nan")))
                    continue
                share, largest = share_within(*rows)
                shares.append((channel, share))
                worst.append((channel, largest))
                lost.append((channel, killed - float(rows[1][-1])))
    for channel in ("force", "grip"):
        mine = [s for c, s in shares if c == channel]
        gone = [s for c, s in lost if c == channel]
        print(f"{channel}: {len(mine)} killed sessions; planted times within the stated uncertainty: "
              f"median {100 * statistics.median(mine):.1f} %, least {100 * min(mine):.1f} %; largest "
              f"error {1e3 * max(w for c, w in worst if c == channel):.2f} ms; last sample before the "
              f"kill by {statistics.median(gone):.2f} s in the median, {max(gone):.2f} s at most")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("haptrial")
    parser.add_argument("--kills", type=int, default=40)
    options = parser.parse_args()
    options.haptrial = os.path.abspath(options.haptrial)
    sensor, board = ForceSensor(), Board()
    sensor.start()
    board.start()
    with tempfile.TemporaryDirectory() as folder:
        channels = CHANNELS % (sensor.port, board.path)
        for name, trials, more in (("with", 200, channels), ("short", 8, channels), ("without", 8, "")):
            with open(os.path.join(folder, name + ".toml"), "w", encoding="utf-8") as file:
                file.write(STUDY.replace("TRIALS", str(trials)) + more)
        killed_sessions(options, folder, os.path.join(folder, "with.toml"))
        for turn, name in enumerate(("without", "short", "without", "short")):
            out = os.path.join(folder, f"lateness-{turn}")
            start(options.haptrial, os.path.join(folder, name + ".toml"), out).wait()
            print(f"ticks {'with' if name == 'short' else 'without'} channels: "
                  f"{lateness_of(options.haptrial, os.path.join(out, 'S01.h5'))}")
    sensor.over = board.over = True


if __name__ == "__main__":
    main()

"""Channels and sounds of a live session that is killed: are times right, is nothing lost, are ticks later?

A virtual participant's session on the real clock has a force sensor at 7 kHz (RDT over UDP), a board
at 100 Hz that prints lines with its own clock (a pseudo-terminal), a stream of the Lab Streaming
Layer at 250 Hz (a stand-in for its library, in the session's process) and a sound with each trial
(ALSA's card `null`). The three clocks drift by 100 millionths, the sensor loses records, all three
send some samples together, the board's clock steps. Each sample carries the time at which it was
measured, so that the session file says how far its time is wrong. Each session is killed after a
random time, resumed, and killed again. Then whole sessions with all of it and without any of it
alternate.

    /usr/bin/python3 tests/benchmarks/channel_session.py build/haptrial [--kills 40] [--pairs 5]
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
SOUND
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
[channels.stream]
kind = "lsl"
name = "stand-in"
library = "%s"
quantities = { measured = "s" }
rate = 250.0
[sounds]
device = "null"
[sounds.go]
type = "tone"
frequency = 1000.0
duration = 0.2
level = -25.0
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


class Rows:
    """Samples of a channel: their times [s], as recorded, planted and received."""

    def __init__(self, file, channel):
        table = file["channel_" + channel]
        seconds, micros = PLANTED[channel]
        self.number = table["sample"][:]
        self.planted = table[seconds].astype(float)
        if micros is not None:
            self.planted = self.planted + 1e-6 * table[micros].astype(float)
        self.recorded = 1e-9 * table["time_ns"]
        self.received = 1e-9 * table["received_ns"]
        self.uncertainty = table["uncertainty"][:]

    def after(self, time):
        """The rows of the process that was started after this time: a resume may have found more of the
        one before than could be read just after its kill."""
        some = Rows.__new__(Rows)
        for name, value in vars(self).items():
            setattr(some, name, value[self.planted > time])
        return some

    def within(self):
        """Which planted times are within the uncertainty, and how far the worst is off. The session's
        clock begins at an unknown time: the smallest delay, less than 0.2 ms here, says when."""
        begin = numpy.min(self.received - self.planted)
        error = numpy.abs(self.recorded - (self.planted + begin))
        return int(numpy.sum(error <= self.uncertainty)), float(numpy.max(error))


PLANTED = {"force": ("fx", "fy"), "grip": ("seconds", "microseconds"), "stream": ("measured", None)}


class Kept:
    """What a session's file holds after a kill."""

    def __init__(self, path):
        with h5py.File(path, "r", swmr=True) as file:
            self.channels = {channel: Rows(file, channel) for channel in PLANTED}
            self.trials = file["trials"][:]
            self.ticks = 1e-9 * file["samples"]["time_ns"]
            markers = file["markers"][:]
        heard = markers[markers["way"] == b"sound"]
        self.heard = set(heard["trial"][numpy.isfinite(heard["written"])].tolist())


def start(haptrial, definition, out, *more):
    return subprocess.Popen([haptrial, "run", definition, "--subject", "S01", "--device", "virtual", "--out", out,
                             *more], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def kill_after(process, seconds):
    """Kills a session. @returns when"""
    time.sleep(seconds)
    process.send_signal(signal.SIGKILL)
    killed = time.monotonic()
    process.wait()
    return killed


class Tally:
    """Figures of all killed sessions."""

    def __init__(self):
        self.samples = dict.fromkeys(PLANTED, 0)
        self.within = dict.fromkeys(PLANTED, 0)
        self.worst = dict.fromkeys(PLANTED, 0.0)
        self.least = dict.fromkeys(PLANTED, 1.0)
        self.lost = {name: [] for name in (*PLANTED, "ticks")}
        self.trials = self.sounds = 0
        self.wrong = []

    def count_run(self, kept, began, killed):
        """Counts what a process recorded that was started and killed at these times."""
        begins = []
        for channel, rows in kept.channels.items():
            rows = rows.after(began)
            if len(rows.number) == 0:
                self.wrong.append(f"{channel} has no sample")
                continue
            within, worst = rows.within()
            self.samples[channel] += len(rows.number)
            self.within[channel] += within
            self.worst[channel] = max(self.worst[channel], worst)
            self.least[channel] = min(self.least[channel], within / len(rows.number))
            self.lost[channel].append(killed - float(rows.planted[-1]))
            begins.append(float(numpy.min(rows.received - rows.planted)))
        self.lost["ticks"].append(killed + begins[0] - float(kept.ticks[-1]))

    def count_whole(self, kept):
        """Counts trials and their sounds."""
        completed = kept.trials[kept.trials["status"] == b"completed"]
        self.trials += len(completed)
        self.sounds += sum(int(trial) in kept.heard for trial in completed["trial"])

    def compare(self, before, after):
        """What was there before a resume must be there after it, and be gone on with."""
        for channel, rows in before.channels.items():
            count = len(rows.number)
            then = after.channels[channel]
            if not (numpy.array_equal(then.number[:count], rows.number)
                    and numpy.array_equal(then.planted[:count], rows.planted)):
                self.wrong.append(f"{channel}: rows changed in the resume")
            if not numpy.all(numpy.diff(then.number.astype(numpy.int64)) > 0):
                self.wrong.append(f"{channel}: numbers do not grow")
            if len(numpy.unique(then.planted)) != len(then.planted):
                self.wrong.append(f"{channel}: a sample came twice")
        count = len(before.trials)
        for name in ("trial", "status", "first_sample", "last_sample"):
            if not numpy.array_equal(after.trials[name][:count], before.trials[name]):
                self.wrong.append(f"trials: {name} changed in the resume")

    def show(self):
        for channel in PLANTED:
            share = self.within[channel] / max(1, self.samples[channel])
            print(f"{channel}: {self.samples[channel]} samples, planted times within the stated uncertainty: "
                  f"{100 * share:.2f} %, in the worst run {100 * self.least[channel]:.1f} %; largest error "
                  f"{1e3 * self.worst[channel]:.2f} ms")
        for name, lost in self.lost.items():
            print(f"{name}: the last before a kill by {statistics.median(lost):.2f} s in the median, "
                  f"{max(lost):.2f} s at most ({len(lost)} kills)")
        print(f"{self.trials} completed trials, {self.sounds} with the time of their sound")
        print(f"what is wrong: {'; '.join(self.wrong) if self.wrong else 'nothing'}")


def killed_sessions(options, folder, definition):
    tally, number = Tally(), random.Random(3)
    for kill in range(options.kills):
        out = os.path.join(folder, f"killed-{kill}")
        partial = os.path.join(out, "S01.h5.partial")
        killed = kill_after(start(options.haptrial, definition, out), number.uniform(2.5, 6.0))
        before = Kept(partial)
        tally.count_run(before, 0.0, killed)
        began = killed
        killed = kill_after(start(options.haptrial, definition, out, "--resume"), number.uniform(2.5, 6.0))
        after = Kept(partial)
        tally.count_run(after, began, killed)
        tally.compare(before, after)
        tally.count_whole(after)
    tally.show()


def lateness_of(haptrial, file):
    said = subprocess.run([haptrial, "info", file], capture_output=True, text=True, check=False).stdout
    return re.search(r"lateness +(.*)", said).group(1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("haptrial")
    parser.add_argument("--kills", type=int, default=40)
    parser.add_argument("--pairs", type=int, default=5)
    options = parser.parse_args()
    options.haptrial = os.path.abspath(options.haptrial)
    os.environ["STAND_IN_LSL_STREAM"] = "stand-in"
    sensor, board = ForceSensor(), Board()
    sensor.start()
    board.start()
    with tempfile.TemporaryDirectory() as folder:
        layer = os.path.join(os.path.dirname(options.haptrial), "libstand_in_lsl.so")
        channels = CHANNELS % (sensor.port, board.path, layer)
        sound = 'sound = "go"'
        for name, trials, stage, more in (("with", 200, sound, channels), ("short", 8, sound, channels),
                                          ("without", 8, "", "")):
            with open(os.path.join(folder, name + ".toml"), "w", encoding="utf-8") as file:
                file.write(STUDY.replace("TRIALS", str(trials)).replace("SOUND", stage) + more)
        if options.kills > 0:
            killed_sessions(options, folder, os.path.join(folder, "with.toml"))
        for turn in range(2 * options.pairs):
            name = "short" if turn % 2 else "without"
            out = os.path.join(folder, f"lateness-{turn}")
            start(options.haptrial, os.path.join(folder, name + ".toml"), out).wait()
            print(f"ticks {'with all' if name == 'short' else 'without'}: "
                  f"{lateness_of(options.haptrial, os.path.join(out, 'S01.h5'))}")
    sensor.over = board.over = True


if __name__ == "__main__":
    main()

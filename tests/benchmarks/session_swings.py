"""What the force of a session did: trains of turns, steps, work on the hand, faults.

usage: session_swings.py SESSION...
Prints, of each session file, seconds in trains, the longest train, the largest step of the force and
the aborted passes. safe_hands.py measures definitions with it.

A train is six or more turns of a force component by 2 N or more, at most 60 ms apart, within a pass.
"""
import collections
import re
import sys

import h5py
import numpy

SWING = 2.0    # of a turn that counts [N]
GAP = 0.06     # longest time between two turns of a train [s]
TURNS = 6      # fewest turns of a train
TOUCH = 0.05   # of the force, below which nothing is touched [N]
LONGEST = 0.2  # of a train that is accepted [s]
ENTRY = 1e-3   # over which the damper of a surface begins and ends (core/contact/normal_spring.h) [m]
FAULT = re.compile(r"(device \d+: )?(the (position|force|tool|device|protocol)|another device|emergency)")

# The greatest of a definition: [N/m], [N·s/m], virtual [kg], and from static to dynamic friction [N].
Gains = collections.namedtuple("Gains", "stiffness damping mass slip", defaults=(0.0,) * 4)


def vectors(rows, what):
    return numpy.stack([rows[f"{what}_{axis}"].astype(float) for axis in "xyz"], axis=1)


def turning_points(force):
    """Ticks at which one component of the force turns round after a swing."""
    slope = numpy.sign(numpy.diff(force))
    corners = numpy.flatnonzero(numpy.diff(slope, prepend=0.0, append=0.0))
    turns, rising = [], None
    low = high = at_low = at_high = None
    for i in [0, *corners.tolist()]:
        x = force[i]
        if high is None or x > high:
            high, at_high = x, i
        if low is None or x < low:
            low, at_low = x, i
        if rising is not False and high - x >= SWING:
            turns.append(at_high)
            rising, low, at_low, high, at_high = False, x, i, x, i
        elif rising is not True and x - low >= SWING:
            turns.append(at_low)
            rising, low, at_low, high, at_high = True, x, i, x, i
    return turns


def train_lengths(turns, rate):
    """Seconds of each run of turns without a longer gap."""
    turns = numpy.asarray(turns, dtype=float) / rate
    if len(turns) < TURNS:
        return []
    runs = numpy.split(turns, numpy.flatnonzero(numpy.diff(turns) > GAP) + 1)
    return [run[-1] - run[0] for run in runs if len(run) >= TURNS]


def devices_of(session):
    """Pass, position, velocity and force on every tick, of each device."""
    samples = session["samples"][:]
    found = [(samples["pass"], samples)]
    if "devices" in session:
        rows = session["devices"][:]
        for device in numpy.unique(rows["device"]):
            own = rows[rows["device"] == device]
            at = numpy.searchsorted(samples["sequence"], own["sequence"])
            found.append((samples["pass"][at], own))
    return [(of_pass, vectors(rows, "position"), vectors(rows, "velocity"), vectors(rows, "force"))
            for of_pass, rows in found]


def aborted_passes(session):
    """The sentence of each aborted pass, by its row of /trials."""
    rows = numpy.flatnonzero(session["trials"]["status"][:] == b"aborted")
    events = session["events"][:]
    aborted = events[(events["kind"] == b"aborted") & (events["part"] == 0)]
    texts = [re.sub(r"^trial \d+: ", "", text.decode()) for text in aborted["text"]]
    return dict(zip(rows.tolist(), texts))


def near_contact(force, way):
    """Ticks within ENTRY of the way that the handle has gone from or to a tick without force."""
    changes = numpy.flatnonzero(numpy.diff((force < TOUCH).astype(int)))
    if len(changes) == 0:
        return numpy.zeros(len(way), dtype=bool)
    at = numpy.clip(numpy.searchsorted(changes, numpy.arange(len(way))), 1, max(len(changes) - 1, 1))
    nearest = numpy.minimum(abs(way - way[changes[at - 1]]),
                            abs(way - way[changes[numpy.minimum(at, len(changes) - 1)]]))
    return nearest < ENTRY


def explained_steps(position, velocity, size, rate, gains):
    """Steps of the force that the stated stiffness, damping, mass and friction make [N]."""
    moved = numpy.linalg.norm(numpy.diff(position, axis=0), axis=1)
    faster = numpy.diff(velocity, axis=0, prepend=velocity[:1])
    surged = numpy.linalg.norm(numpy.diff(faster, axis=0), axis=1) * rate
    way = numpy.concatenate([[0.0], numpy.cumsum(moved)])
    begins = numpy.minimum(moved / ENTRY, 1.0) * near_contact(size, way)[1:]
    touches = (size[:-1] < TOUCH) != (size[1:] < TOUCH)
    begins = numpy.maximum(begins, touches)
    return (gains.stiffness * moved + gains.damping * numpy.linalg.norm(faster[1:], axis=1)
            + gains.damping * numpy.linalg.norm(velocity[1:], axis=1) * begins
            + gains.mass * surged + gains.slip)


def measure_device(device, faults, rate, delay, gains):
    """Trains, steps and work of one device. A force acts from `delay` ticks after its command on."""
    of_pass, position, velocity, force = device
    bounds = numpy.flatnonzero(numpy.diff(of_pass)) + 1
    parts = [part for part in numpy.split(numpy.arange(len(of_pass)), bounds) if of_pass[part[0]] >= 0]
    trains = [[length for part in parts
               for length in train_lengths(turning_points(force[part, axis]), rate)]
              for axis in range(3)]
    moved = numpy.diff(position, axis=0)
    steps = numpy.linalg.norm(numpy.diff(force, axis=0), axis=1)
    size = numpy.linalg.norm(force, axis=1)
    explained = explained_steps(position, velocity, size, rate, gains)
    meant = numpy.ones(len(steps), dtype=bool)
    meant[[part[-1] - 1 for part in parts if of_pass[part[0]] in faults]] = False  # cut to zero
    work = numpy.zeros(len(force))
    work[delay + 1:] = (force[:-1 - delay] * moved[delay:]).sum(axis=1)
    return {"trains": max(map(sum, trains)), "longest": max(map(max, ([0.0, *t] for t in trains))),
            "long_trains": sum(length > LONGEST for t in trains for length in t),
            "step": steps[meant].max(initial=0.0), "any_step": steps.max(initial=0.0),
            "unexplained": (steps - explained)[meant].max(initial=0.0),
            "work": max((numpy.cumsum(work[part]).max() for part in parts), default=0.0)}


def measure(file, delay=1, gains=Gains()):
    """What the force of one session did, of several devices the worst.

    delay is in ticks; gains are the greatest that the definition states, which explain steps.
    """
    with h5py.File(file, "r") as session:
        rate = float(session.attrs["rate"])
        sentences = aborted_passes(session)
        faults = {row: text for row, text in sentences.items() if FAULT.match(text)}
        each = [measure_device(d, faults, rate, delay, gains) for d in devices_of(session)]
        result = {key: max(one[key] for one in each) for key in each[0]}
        status = session["trials"]["status"][:]
        time = len(session["samples"]) / rate
    counts = collections.Counter(sentences.values())
    return {**result, "seconds": time, "passes": len(status), "faults": len(faults),
            "completed": int((status == b"completed").sum()), "aborted": len(sentences),
            "sentences": "; ".join(f"{n} x {text}" for text, n in counts.most_common())}


def main():
    for file in sys.argv[1:]:
        found = measure(file)
        print(f"{file}: {found['trains']:.2f} s in trains, {found['longest']:.2f} s the longest, "
              f"steps of {found['step']:.2f} N, {found['aborted']} of {found['passes']} passes aborted")


if __name__ == "__main__":
    main()

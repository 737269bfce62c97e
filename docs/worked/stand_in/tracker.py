#!/usr/bin/env python3
"""A tracker that is none: a VRPN server whose sensor 0 goes round a circle of 0.1 m.

    python3 docs/worked/stand_in/tracker.py --port 3883 --tracker Arm --rate 240

A definition with [channels.hand], kind "vrpn", host "127.0.0.1" and this tracker then has a
tracker: to rehearse a session before the cameras come. With --mistakes 50 each fiftieth pose is in
turn lost, doubled, too late and malformed; with --die 1000 the server ends after so many poses and
begins anew.
"""

import argparse
import math
import select
import socket
import struct
import time

COOKIE = b"vrpn: ver. 07.38  0".ljust(24, b"\0")
TRACKER, POSES = 0, 0  # numbers of the sender and the type


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--port", type=int, default=3883)
    parser.add_argument("--tracker", default="Arm")
    parser.add_argument("--rate", type=float, default=240.0, help="poses a second [Hz]")
    parser.add_argument("--frequency", type=float, default=0.5, help="turns a second [Hz]")
    parser.add_argument("--mistakes", type=int, default=0, help="every how manieth is a mistake")
    parser.add_argument("--die", type=int, default=0, help="poses until the server ends")
    return parser.parse_args()


def message(when, sender, kind, body):
    micros = round(1e6 * when)
    seconds, rest = divmod(micros, 1000000)
    head = struct.pack(">IIIiiI", 24 + len(body), seconds, rest, sender, kind, 0)
    return head + body + bytes(-len(body) % 8)


def description(kind, number, name):
    text = name.encode() + b"\0"
    return message(time.time(), number, kind, struct.pack(">I", len(text)) + text)


def pose(when, options):
    turn = 2.0 * math.pi * options.frequency * when
    place = (0.1 * math.cos(turn), 0.1 * math.sin(turn), 0.0)
    orientation = (0.0, 0.0, math.sin(turn / 2.0), math.cos(turn / 2.0))
    return struct.pack(">ii7d", 0, 0, *place, *orientation)


def messages(number, when, options):
    """What is sent in place of one pose."""
    good = message(when, TRACKER, POSES, pose(when, options))
    if options.mistakes == 0 or number % options.mistakes != 0:
        return good
    before = when - 1.5 / options.rate
    late = message(before, TRACKER, POSES, pose(before, options))
    malformed = message(when, TRACKER, POSES, pose(when, options)[:40])
    return (b"", good + good, good + late, malformed)[number // options.mistakes % 4]


def serve(client, options):
    """@returns when the client has gone or the server dies."""
    client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    client.sendall(COOKIE + description(-1, TRACKER, options.tracker))
    client.sendall(description(-2, POSES, "vrpn_Tracker Pos_Quat"))
    begun, number = time.monotonic(), 0
    while options.die == 0 or number < options.die:
        wait = max(0.0, begun + number / options.rate - time.monotonic())
        if select.select([client], [], [], wait)[0]:
            if not client.recv(4096):
                return
            continue
        number += 1
        client.sendall(messages(number, time.time(), options))


def main():
    options = arguments()
    with socket.create_server(("127.0.0.1", options.port)) as line:
        print(f"listens on port {options.port}", flush=True)
        while True:
            client = line.accept()[0]
            try:
                serve(client, options)
            except ConnectionError:
                pass
            client.close()


if __name__ == "__main__":
    main()

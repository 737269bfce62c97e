#!/usr/bin/env python3
"""A force sensor that is none: speaks RDT over UDP as an ATI Net F/T does, with a sine on fx.

    python3 docs/worked/stand_in/force_sensor.py --port 49152 --amplitude 3 --frequency 0.5

A definition with [channels.force], kind "rdt", host "127.0.0.1" and this port then has a sensor:
to rehearse a session before the instrument comes, or to write a driver against.
"""

import argparse
import math
import select
import socket
import struct
import time

COUNTS = 1e6  # for 1 N and 1 N·m


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--port", type=int, default=49152)
    parser.add_argument("--rate", type=float, default=1000.0, help="records a second [Hz]")
    parser.add_argument("--amplitude", type=float, default=3.0, help="of fx [N]")
    parser.add_argument("--frequency", type=float, default=0.5, help="of fx [Hz]")
    parser.add_argument("--lose", type=int, default=0, help="every how manieth record is lost")
    return parser.parse_args()


def record(sequence, force):
    counts = [round(COUNTS * value) for value in (force, 0.0, 0.0, 0.0, 0.0, 0.0)]
    return struct.pack(">IIIiiiiii", sequence, 7 * sequence, 0, *counts)


def main():
    options = arguments()
    line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    line.bind(("127.0.0.1", options.port))
    print(f"listens on port {options.port}", flush=True)
    client, sequence, begun = None, 0, time.monotonic()
    while True:
        due = begun + sequence / options.rate if client else None
        wait = None if due is None else max(0.0, due - time.monotonic())
        if select.select([line], [], [], wait)[0]:
            request, sender = line.recvfrom(64)
            header, command, _ = struct.unpack(">HHI", request[:8])
            if header == 0x1234 and command in (2, 3):  # begin
                client, sequence, begun = sender, 0, time.monotonic()
            elif header == 0x1234 and command == 0:  # end
                client = None
            continue
        sequence += 1
        if options.lose == 0 or sequence % options.lose != 0:
            phase = 2.0 * math.pi * options.frequency * sequence / options.rate
            line.sendto(record(sequence, options.amplitude * math.sin(phase)), client)


if __name__ == "__main__":
    main()

"""Reads the console's list of channels in headless Chromium.

    channels_browser.py URL FOLDER

The session has four channels: six forces and torques, 64 voltages, a stream of texts, and one that
is lost. Leaves pictures in FOLDER. Exit status 0: all was as it should be.
"""

import pathlib
import sys

from browser import look_at, wait


def rows(page):
    return page.run(
        "return [...document.getElementById('channels_rows').rows].map((row) => [row.cells[0].textContent,"
        " row.cells[1].className, [...row.cells[1].firstChild.children].map((q) =>"
        " [...q.children].map((part) => part.textContent).filter((part) => part).join(' '))])")


def look(page, folder):
    wait("four channels", lambda: len(rows(page)) == 4)
    force, eeg, texts, grip = rows(page)
    assert force[:2] == ["force", ""], force
    assert force[2] == ["fx \u22121.23 N", "fy \u2013 N", "fz 1.20e\u22125 N", "tx \u22121.23 N·m",
                        "ty 1.20e\u22125 N·m", "tz 1.20e\u22125 N·m"], force
    assert eeg[2][:2] == ["e0 0.00 µV", "e1 12.0 µV"] and eeg[2][11] == "e11 132 µV", eeg
    assert eeg[2][12:] == ["and 52 more"], eeg
    assert texts == ["stimuli", "", ["connected"]], texts
    assert grip == ["grip", "bad", ["\u26a0\ufe0e lost"]], grip
    page.picture(folder / "channels.png", height=1000)
    page.picture(folder / "channels-narrow.png", 620, 1400)


url, to = sys.argv[1], pathlib.Path(sys.argv[2])
look_at(url, to, lambda page: look(page, to))

"""An experimenter's session at the console of a running `haptrial run`, in headless Chromium.

    live_console.py URL FOLDER

Leaves pictures in FOLDER. HAPTRIAL_PLOT_SECONDS is how long a pass has run before its picture is
taken (0): the plot of a picture for the docs is to be full. Exit status 0: all was as it should be.
"""

import os
import pathlib
import sys
import time

from browser import Driver, ask, state, wait

PLOT_SECONDS = float(os.environ.get("HAPTRIAL_PLOT_SECONDS", "0"))
NO_FORCE = "0.00 N"


def running(page, what):
    """Waits for the run of a pass: there the target moves, and the participant along."""
    state(page, "Running")
    wait(what, lambda: page.text("what") == what)


def moves(page, *names):
    seen = {name: set() for name in names}

    def several():
        for name in names:
            seen[name].add(page.text(name))
        return all(len(values) > 3 for values in seen.values())

    wait("movement of " + ", ".join(names), several)


def picture(page, file):
    """With nothing but the pass going on in the plot's last seconds."""
    time.sleep(PLOT_SECONDS)
    page.picture(file, height=980)


def condition(page):
    return page.text("what").split(" \u00b7 ")[0]


def instructions(page, url):
    page.call("POST", "/url", {"url": url})
    state(page, "Instructions")
    page.run("document.getElementById('loop').open = true")  # its figures are read below
    assert page.text("subject") == "S01", page.text("subject")
    assert page.text("simulated") == "SIMULATED"
    assert page.text("screen").startswith("Learning a pattern of forces"), page.text("screen")
    assert page.text("link") == "connected"
    assert page.text("applied") == NO_FORCE, page.text("applied")
    wait("the servo loop's ticks", lambda: page.text("lateness_worst") != "0.0 \u00b5s")


def pause_and_go_on(page):
    """A pause lets the present pass come to its end, and no other begins."""
    ask(page, "start")
    wait("a pass", lambda: page.text("what").endswith("training \u00b7 trial runs"))
    assert page.text("state") == "Running"
    assert page.hidden("screen"), "the instructions are gone: " + page.text("screen")
    moves(page, "target", "position")
    ask(page, "pause")
    assert page.text("state") == "Running", "not in the middle of a pass"
    state(page, "Paused")
    assert page.text("what").endswith("training"), page.text("what")
    time.sleep(0.7)
    assert page.text("state") == "Paused"
    assert page.text("applied") == NO_FORCE, page.text("applied")
    assert page.text("trial") == "1 of 72", page.text("trial")
    ask(page, "start")
    running(page, condition(page) + " \u00b7 test \u00b7 trial runs")
    moves(page, "target", "applied", "position")


def note_repeat_skip(page, folder):
    page.type("note", "hand rested, \u00e9 <b>&amp;")
    page.click("keep")
    wait("the note's receipt", lambda: "note: hand rested" in page.text("said"))
    picture(page, folder / "console-running.png")
    assert page.text("aborted") == "0"
    ask(page, "repeat")
    wait("an aborted pass", lambda: page.text("aborted") == "1")
    running(page, condition(page) + " \u00b7 training \u00b7 trial runs")
    assert page.text("trial") == "1 of 72", page.text("trial")
    ask(page, "skip")
    wait("the next trial", lambda: page.text("trial") == "2 of 72")
    running(page, condition(page) + " \u00b7 training \u00b7 trial runs")


def stop_and_clear(page, folder):
    moves(page, "position")
    time.sleep(PLOT_SECONDS)
    ask(page, "emergency_stop")
    state(page, "STOPPED")
    assert "The force is zero" in page.text("fault"), page.text("fault")
    wait("no force", lambda: page.text("applied") == NO_FORCE)
    for name in ("start", "pause", "repeat", "skip"):
        assert page.run(f"return document.getElementById('{name}').disabled"), name
    page.key(" ")  # nor does a key start anything
    time.sleep(0.5)
    assert page.text("state") == "STOPPED"
    assert page.text("applied") == NO_FORCE
    page.picture(folder / "console-stopped.png", height=980)
    ask(page, "clear")
    state(page, "Paused")
    assert page.hidden("fault"), page.text("fault")
    ask(page, "start")
    running(page, condition(page) + " \u00b7 training \u00b7 trial runs")
    assert page.text("trial") == "2 of 72", page.text("trial")


def end(page):
    page.click("abort")
    wait("the question", lambda: not page.hidden("confirm"))
    page.click("go_on")
    wait("no question", lambda: page.hidden("confirm"))
    assert page.text("state") == "Running", page.text("state")
    ask(page, "abort", "for_good")
    state(page, "Ended")
    wait("the end of the link", lambda: page.text("link") == "closed")
    assert page.hidden("lost"), page.text("lost")


def main():
    url, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    page = Driver(folder)
    try:
        instructions(page, url)
        pause_and_go_on(page)
        note_repeat_skip(page, folder)
        stop_and_clear(page, folder)
        bad = page.complaints()
        assert not bad, bad
        end(page)
    finally:
        page.close()


main()

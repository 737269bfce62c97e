"""Clicks through the page of the nerve monitor's technician in headless Chromium.

    nerve_browser.py URL FOLDER

The session drills beside nerves. Leaves pictures in FOLDER. Exit status 0: all was as it should be.
"""

import pathlib
import sys

from browser import Driver, wait

CONTROL, ENTER = "\ue009", "\ue007"


def log(page):
    return page.run(
        "return [...document.getElementById('log').rows]"
        ".map((row) => [...row.cells].map((cell) => cell.textContent))"
    )


def shown_threshold(page, channel):
    return float(page.run(f"return document.getElementById('threshold_{channel}').value"))


def look(page, url, folder):
    page.call("POST", "/url", {"url": url})
    wait("connected", lambda: page.text("link") == "connected")
    wait("the channels", lambda: page.run("return document.querySelectorAll('.channel').length") == 3)
    assert page.run("return document.querySelector('.mark').textContent") == "SIMULATED"
    assert page.text("heard") == "heard by the participant"
    names = page.run("return [...document.querySelectorAll('.name')].map((e) => e.textContent)")
    assert names == ["oculi", "oris", "drawn <b>"], names
    wait("traces", lambda: all(page.drawn(f"trace_{channel}") > 500 for channel in range(3)))
    wait("an event in the log", lambda: len(log(page)) >= 2)
    kinds = {row[2] for row in log(page)}
    assert kinds <= {"burst", "train", "artefact", "response"}, kinds
    wait("an event on the screen", lambda: any(page.text(f"event_{i}") for i in range(3)))
    # After ten seconds of tones the monitor raises it by itself.
    assert 100 <= shown_threshold(page, 0) <= 400, shown_threshold(page, 0)

    page.click("mute_1")
    wait("muted", lambda: page.run(
        "return document.getElementById('mute_1').getAttribute('aria-pressed')") == "true")
    wait("the answer", lambda: page.text("said") == "oris: muted")
    page.type("threshold_2", CONTROL + "a" + CONTROL + "250" + ENTER)
    wait("the threshold", lambda: page.text("said") == "drawn <b>: threshold 250 µV")
    page.run("document.activeElement.blur()")
    wait("the threshold of the monitor", lambda: 250 <= shown_threshold(page, 2) <= 400)
    page.type("stimulus", CONTROL + "a" + CONTROL + "0.3" + ENTER)
    wait("the current", lambda: page.text("said") == "probe: 0.3 mA")
    page.run("document.activeElement.blur()")
    wait("the current of the probe", lambda: page.run(
        "return document.getElementById('stimulus').value") == "0.300")
    page.click("search_0")
    # A busy machine may show the answer first.
    words = ("looking for the least current that oculi", "oculi answers from")
    wait("a search", lambda: page.text("probe").startswith(words))
    page.picture(folder / "nerve-monitor.png", height=1400)
    page.picture(folder / "nerve-monitor-narrow.png", 620, 1300)
    wide = page.run("return document.documentElement.scrollWidth > window.innerWidth")
    assert not wide, "the narrow page scrolls sideways"

    # At the nerve itself an answer of 100 µV needs about 0.09 mA.
    wait("the end of the search", lambda: not page.text("probe").startswith("looking"))
    assert page.text("probe").startswith("oculi answers from"), page.text("probe")
    found = float(page.text("probe").split()[3])
    assert 0.07 < found < 0.13, found

    print("CLOSE", flush=True)
    wait("the banner of a lost connection", lambda: not page.hidden("lost"))
    complaints = [c for c in page.complaints() if "ERR_" not in c]  # of the lost connection
    assert not complaints, complaints


def main():
    url, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    page = Driver(folder)
    try:
        look(page, url, folder)
    finally:
        page.close()


main()

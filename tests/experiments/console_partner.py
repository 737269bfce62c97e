"""Looks at the panel of a partner's session in headless Chromium, and moves the lead with it.

    console_partner.py URL FOLDER

The session is linked from the beginning; its link is lost once the lead was handed over. Leaves a
picture in FOLDER. Exit status 0: all was as it should be.
"""

import pathlib
import sys

from browser import look_at, state, wait


def shown(page):
    names = ("link", "lead", "round_trip", "jitter", "loss", "energy")
    return {name: page.text("partner_" + name) for name in names}


def look(page, folder):
    state(page, "Running")
    wait("the panel", lambda: not page.hidden("partner"))
    found = shown(page)
    assert found == {
        "link": "not heard yet",
        "lead": "100 %",
        "round_trip": "\u2013",
        "jitter": "0.0 ms",
        "loss": "0.0 %",
        "energy": "0.0 mJ",
    }, found

    page.click("take_lead")
    wait("the lead", lambda: "taken here" in page.text("partner_lead"))
    found = shown(page)
    assert found == {
        "link": "coupled",
        "lead": "75 %, taken here",
        "round_trip": "103.4 ms",
        "jitter": "8.3 ms",
        "loss": "4.9 %",
        "energy": "12.5 mJ",
    }, found
    page.picture(folder / "console-partner.png", height=1060)
    wide = page.run("return document.documentElement.scrollWidth > window.innerWidth")
    assert not wide, "the page scrolls sideways"

    page.key("h")  # hand over
    wait("the loss of the link", lambda: "lost 2 times" in page.text("partner_link"))
    assert page.run("return document.getElementById('partner_link').className") == "bad"
    assert page.text("partner_lead") == "100 %, taken there", page.text("partner_lead")


url, to = sys.argv[1], pathlib.Path(sys.argv[2])
look_at(url, to, lambda page: look(page, to))

"""Tunes a pilot on its page in headless Chromium.

    tuning_browser.py URL FOLDER

Leaves pictures and the saved definition in FOLDER. Exit status 0: all was as it should be.
"""

import pathlib
import sys

from browser import Driver, wait

CONTROL, ENTER, RIGHT = "\ue009", "\ue007", "\ue014"
GAIN = "tools-cutting-feel-second_gain"
LIMIT = "tools-cutting-feel-force_limit"


def value(page, name):
    return float(page.run(f"return document.getElementById('{name}').value"))


def type_number(page, key, text):
    page.type("number_" + key, CONTROL + "a" + CONTROL + text + ENTER)


def look(page, url, folder):
    page.open(url)
    wait("connected", lambda: page.text("link") == "connected")
    wait("the keys", lambda: page.run("return document.querySelectorAll('.key').length") == 19)
    assert page.run("return document.querySelector('.mark').textContent") == "PILOT"
    assert page.text("taken") == "nothing is changed"
    assert "N/mm stiff" in page.text("contact"), page.text("contact")

    before = value(page, "number_" + GAIN)
    for _ in range(3):
        page.type("slider_" + GAIN, RIGHT)
    wait("a stiffer bone", lambda: value(page, "number_" + GAIN) > before)
    wait("the answer", lambda: page.text("said").startswith("tools.cutting.feel.second_gain = "))
    wait("that nobody drills", lambda: "waits for the next tick" in page.text("taken"))

    type_number(page, LIMIT, "-3")
    wait("a refusal", lambda: page.text("said").startswith("NOT CHANGED: "))
    assert "force_limit is -3" in page.text("said"), page.text("said")
    type_number(page, LIMIT, "7.5")
    wait("the limit", lambda: page.text("said") == "tools.cutting.feel.force_limit = 7.5")
    page.run("document.activeElement.blur()")
    wait("its mark", lambda: page.run("return document.querySelectorAll('.changed').length") == 2)

    page.run("scrollTo(0, 0)")
    page.picture(folder / "tuning.png", height=1100)
    page.picture(folder / "tuning-narrow.png", 620, 1300)
    wide = page.run("return document.documentElement.scrollWidth > window.innerWidth")
    assert not wide, "the narrow page scrolls sideways"
    page.resize()

    page.call("POST", "/goog/cdp/execute", {"cmd": "Page.setDownloadBehavior", "params": {
        "behavior": "allow", "downloadPath": str(folder)}})
    page.click("save")
    saved = folder / "study_tuned.toml"
    wait("the saved definition", lambda: saved.exists() and saved.stat().st_size > 0)

    print("CLOSE", flush=True)
    wait("the banner of a lost connection", lambda: not page.hidden("lost"))
    complaints = [c for c in page.complaints() if "ERR_" not in c and "400" not in c]
    assert not complaints, complaints


def main():
    url, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    page = Driver(folder)
    try:
        look(page, url, folder)
    finally:
        page.close()


main()

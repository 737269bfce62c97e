"""Looks at the pages of a trainee in headless Chromium.

    trainee_browser.py OVERVIEW FOLDER

OVERVIEW is the page of several procedures. Leaves pictures in FOLDER. Exit status 0: all was as it
should be.
"""

import pathlib
import sys

from browser import Driver, wait

SOFTWARE = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
RIGHT, DOWN = "\ue014", "\ue015"

# Shares of the canvas's pixels, by kind of colour, and a number that follows from all of them.
COLOURS = """
const c = document.getElementById("canvas"), d = document.createElement("canvas");
d.width = c.width; d.height = c.height;
const g = d.getContext("2d"); g.drawImage(c, 0, 0);
const p = g.getImageData(0, 0, d.width, d.height).data;
let bone = 0, green = 0, magenta = 0, sum = 0;
for (let i = 0; i < p.length; i += 4) {
  const [r, q, b] = [p[i], p[i + 1], p[i + 2]];
  if (r > 70 && Math.abs(r - q) < 40 && q >= b) ++bone;
  if (q > 1.3 * r && q > 1.2 * b && q > 60) ++green;
  if (r > 1.6 * q && b > 1.4 * q && r > 70) ++magenta;
  sum = (sum * 31 + r + 3 * q + 7 * b) % 1000000007;
}
return {bone, green, magenta, sum, pixels: p.length / 4};"""


def only_itself(page):
    asked = page.requested()
    assert asked, "nothing was logged"
    strangers = [url for url in asked if not url.startswith(("file:", "data:", "chrome", "about:"))]
    assert not strangers, strangers
    bad = [c for c in page.complaints() if "GPU stall" not in c]  # of reading pixels back
    assert not bad, bad


def choose(page, name, value):
    page.run(f"const s = document.getElementById('{name}'); s.value = '{value}';"
             "s.dispatchEvent(new Event('change'));")


def drag(page, across, upwards):
    canvas = page.element("canvas")
    move = {"type": "pointerMove", "duration": 60, "x": across, "y": upwards, "origin": "pointer"}
    page.call("POST", "/actions", {"actions": [{
        "type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": [
            {"type": "pointerMove", "duration": 0, "x": 0, "y": 0,
             "origin": {"element-6066-11e4-a52e-4f735466cecf": canvas}},
            {"type": "pointerDown", "button": 0}, move, {"type": "pointerUp", "button": 0}]}]})


def turned(page, url, folder):
    page.resize(640, 600)  # drawn by the processor
    page.call("POST", "/url", {"url": url})
    links = page.run("return [...document.querySelectorAll('#procedures a')].map((a) => a.href)")
    assert len(links) == 2, links
    assert page.run("return document.querySelectorAll('.plot').length") > 10
    assert "SIMULATED" in page.run("return document.title")
    page.picture(folder / "trainee-overview.png", 640, 600)
    only_itself(page)

    page.run("document.querySelector('#procedures a').click()")
    wait("the view", lambda: page.run("return document.documentElement.dataset.view") == "webgl")
    assert page.hidden("picture")
    page.run("document.getElementById('stage').scrollIntoView()")
    first = page.run(COLOURS)
    assert first["bone"] + first["green"] > 0.01 * first["pixels"], first
    assert first["green"] > 200, first
    page.picture(folder / "trainee-page.png", 640, 600)
    first = page.run(COLOURS)
    drag(page, 120, 30)
    dragged = page.run(COLOURS)
    assert dragged["sum"] != first["sum"], "the mouse turns the bone"
    page.run("document.getElementById('canvas').focus()")
    page.key(RIGHT)
    page.key(DOWN)
    keyed = page.run(COLOURS)
    assert keyed["sum"] != dragged["sum"], "the keys turn the bone"
    page.key("0")
    assert page.run(COLOURS)["sum"] == first["sum"], "0 is the first view"
    page.key("+")
    assert page.run(COLOURS)["sum"] != first["sum"], "plus zooms"
    page.key("0")

    page.click("fault_0")
    without = page.run(COLOURS)
    assert without["green"] < 0.2 * first["green"], (first, without)
    page.click("fault_0")
    choose(page, "bone", "solid")
    solid = page.run(COLOURS)
    assert solid["bone"] > 0.1 * solid["pixels"], solid
    choose(page, "bone", "none")
    assert page.run(COLOURS)["bone"] < solid["bone"]
    page.click("strokes")
    page.picture(folder / "trainee-strokes.png", 640, 600)
    only_itself(page)

    page.run("document.getElementById('overview').click()")
    wait("the overview", lambda: page.run("return document.getElementById('procedures') !== null"))


def flat(page, url):
    page.call("POST", "/url", {"url": url})
    page.run("document.querySelector('#procedures a').click()")
    wait("the picture", lambda: page.run(
        "const i = document.querySelector('#picture img'); return i ? i.naturalWidth : 0") > 500)
    assert not page.hidden("picture") and page.hidden("canvas")
    assert "no WebGL" in page.text("help")
    assert page.run("return document.documentElement.dataset.view || ''") == ""


def main():
    url, folder = pathlib.Path(sys.argv[1]).resolve().as_uri(), pathlib.Path(sys.argv[2])
    for flags, look in ((SOFTWARE, lambda page: turned(page, url, folder)),
                        (["--disable-3d-apis"], lambda page: flat(page, url))):
        page = Driver(folder, flags)
        try:
            look(page)
        finally:
            page.close()


main()

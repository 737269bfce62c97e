"""Looks at the panel of a drilling in headless Chromium.

    console_drilling.py URL FOLDER

The session drills from its second status on. Leaves a picture in FOLDER. Exit status 0: all was as
it should be.
"""

import pathlib
import sys

from browser import look_at, state, wait

EXPECTED = {
    "figures_title": "Procedure 2",
    "figures_simulated": "SIMULATED",
    "rate": "998 of 1\u202f000 Hz",
}
ROWS = [
    ["Time (drilling)", "2:05 (0:48)"],
    ["Bone removed", "1234.5 mm\u00b3"],
    ["Voxels removed (visible)", "51973 (88 %)"],
    ["Path of the tool", "0.0 mm"],
    ["Mean force while drilling", "2.35 N"],
    ["Vital structures", "2 injured"],
    ["Facial nerve", "12 voxels"],
    ["Sigmoid sinus and dura <b>", "1004 voxels"],
]


def look(page, folder):
    state(page, "Instructions")
    assert page.hidden("figures"), "no panel where nothing is drilled"
    assert not page.hidden("target_row"), "a force to follow"
    page.key(" ")
    state(page, "Running")
    wait("the panel", lambda: not page.hidden("figures"))
    assert page.hidden("target_row"), "no force to follow in a drilling"
    assert page.hidden("applied_row"), "nothing to compare with a target"
    assert page.text("hand") == "\u26a0\ufe0e 11.00 N", page.text("hand")
    assert page.run("return document.getElementById('hand_row').classList.contains('near')")
    width = page.run("return document.getElementById('hand_bar').getAttribute('width')")
    assert abs(float(width) - 100 * 11 / 12) < 0.01, width
    wait("the drawn scale", lambda: "limit of 12.0 N" in page.text("scale"))
    page.run("document.getElementById('loop').open = true")  # its figures are read below
    for name, wanted in EXPECTED.items():
        shown = page.text(name).strip().removeprefix("\u26a0\ufe0e").strip()
        assert shown == wanted, f"{name} is {shown!r}, not {wanted!r}"
    rows = page.run(
        "return [...document.getElementById('figures_rows').rows]"
        ".map((row) => [...row.cells].map((cell) => cell.textContent))"
    )
    assert rows == ROWS, rows
    page.picture(folder / "console-drilling.png", height=1060)
    page.picture(folder / "console-drilling-narrow.png", 620, 1500)


url, to = sys.argv[1], pathlib.Path(sys.argv[2])
look_at(url, to, lambda page: look(page, to))

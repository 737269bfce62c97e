"""Rules of accessibility, by the npm package axe-core."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from npm_package import npm_package  # noqa: E402


class Rules:
    """@throws OutOfReach"""

    def __init__(self, folder):
        package = npm_package(folder, "axe-core")
        self.script = (package / "axe.min.js").read_text(encoding="utf-8")

    def findings(self, page):
        """What the page that is open breaks, in its light and its dark colours. Frames without
        scripts are pages of their own."""
        found = []
        for scheme in ("light", "dark"):
            page.call("POST", "/goog/cdp/execute", {"cmd": "Emulation.setEmulatedMedia", "params": {
                "features": [{"name": "prefers-color-scheme", "value": scheme}]}})
            page.run(self.script)
            found += [scheme + ": " + each for each in page.call("POST", "/execute/async", {
                "args": [], "script":
                "const done = arguments[arguments.length - 1];"
                "axe.run(document, {iframes: false, resultTypes: ['violations']}).then((found) =>"
                " done(found.violations.map((rule) => rule.id + ': ' + rule.help + ': ' +"
                " rule.nodes.map((node) => node.html.slice(0, 160) + ' ' + node.any.map((any) =>"
                " any.message).join('; ')).slice(0, 4).join(' | '))), (error) => done([String(error)]))"})]
        return found

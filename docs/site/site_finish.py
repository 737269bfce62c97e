"""What is mended in a made site: site_finish SITE."""

import pathlib
import sys

site = pathlib.Path(sys.argv[1])

# The search index also as a script, for pages that are opened as files (theme/search/local.js).
index = (site / "search/search_index.json").read_text()
(site / "search/search_index.js").write_text("window.__index = " + index + ";\n")

# Doxygen links to a list of nested classes that it leaves out where all of them are private.
LINK = '<a href="#nested-classes">Classes</a> &#124;\n'
for page in (site / "headers").glob("*.html"):
    text = page.read_text()
    if LINK in text and 'name="nested-classes"' not in text:
        page.write_text(text.replace(LINK, ""))

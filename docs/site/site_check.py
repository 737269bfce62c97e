"""Checks every link of a made site: site_check SITE. Prints the dead ones; exit status 1 if any."""

import functools
import pathlib
import re
import sys
import urllib.parse

REFERENCE = re.compile(r"""<(?:a|img|script|link|iframe)\b[^>]*?\s(?:href|src)=(?:"([^"]*)"|'([^']*)'|([^\s>"']+))""")
ANCHOR = re.compile(r"""\s(?:id|name)=(?:"([^"]*)"|'([^']*)'|([^\s>"']+))""")


def first(groups):
    return next((each for each in groups if each), "")


@functools.cache
def anchors(file):
    return {first(found) for found in ANCHOR.findall(file.read_text())}


def dead(page, link):
    """Whether a link of a page leads nowhere; None for one that leaves the site."""
    address = urllib.parse.urlsplit(link.replace("&amp;", "&"))
    if address.scheme or address.netloc:
        return None
    file = page.parent / urllib.parse.unquote(address.path) if address.path else page
    if not file.exists():
        return True
    anchor = urllib.parse.unquote(address.fragment)
    shown = anchor and not anchor.startswith("__") and file.suffix == ".html"
    return bool(shown) and anchor not in anchors(file)


def main(site):
    links, found = 0, []
    for page in sorted(pathlib.Path(site).rglob("*.html")):
        if page.name == "404.html":  # for servers, from whose root it links
            continue
        for link in {first(groups) for groups in REFERENCE.findall(page.read_text())}:
            gone = dead(page, link) if link else None
            links += gone is not None
            if gone:
                found.append(f"{page.relative_to(site)}: {link}")
    print(f"{links} links, {len(found)} dead")
    print("\n".join(found[:50]))
    return 1 if found or links < 1000 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))

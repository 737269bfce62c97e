"""The list of public headers, each with its first sentence and its page."""

import pathlib
import re
import xml.etree.ElementTree


def pages_of(root, tags):
    """Path of each header to the name of its page; empty without Doxygen's tag file."""
    if not tags.exists():
        return {}
    found = {}
    for file in xml.etree.ElementTree.parse(tags).iterfind("compound[@kind='file']"):
        path = pathlib.Path(file.findtext("path")) / file.findtext("name")
        found[path.relative_to(root).as_posix()] = file.findtext("filename")
    return found


def sentence(text):
    """The first sentence of the first comment that describes something."""
    block = re.search(r"^ *///(?!/) ?(.*(?:\n *///.*)*)", text, re.M)
    words = re.sub(r"\s*\n *///\s*", " ", block[1]).strip() if block else ""
    words = re.split(r"(?<=[.:;]) ", words)[0].rstrip(":;")
    return re.sub(r"([<|*_\\])", r"\\\1", words)


def index(root, headers):
    lines = ["# Every public header\n", "Made from the comments in the headers by Doxygen; all pages: "
             "[files](../headers/files.html), [classes](../headers/annotated.html).\n"]
    folder = None
    for path in sorted(headers, key=lambda each: (str(pathlib.Path(each).parent), each)):
        if pathlib.Path(path).parent != folder:
            folder = pathlib.Path(path).parent
            lines.append(f"\n## {folder}\n\n| header | begins with |\n| --- | --- |")
        name = pathlib.Path(path).name
        lines.append(f"| [{name}](../headers/{headers[path]}) | {sentence((root / path).read_text())} |")
    return "\n".join(lines) + "\n"

#!/usr/bin/env python3
"""Draws docs/images/folders.svg from CMakeLists.txt: a box for each folder, an arrow to each folder
that it links and that no other of its links leads to. With --counts also prints file pairs of each
folder, circles among them and lines, as Markdown."""
import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
COLOURS = {"core": "#dbe9f6", "protocols": "#fde9c9", "analysis": "#dff0d8", "experiments": "#f3dfee"}
ROW, COLUMN, BOX = 46, 176, (160, 32)


def modules():
    """{name: (folder, links)} of haptrial_module() and haptrial_group()."""
    text = re.sub(r"#[^\n]*", "", (ROOT / "CMakeLists.txt").read_text())
    found = {}
    for words in re.findall(r"haptrial_(?:module|group)\(([^)]*)\)", text):
        words = words.split()
        links = []
        if "LINKS" in words:
            links = words[words.index("LINKS") + 1:]
            links = links[:links.index("USES")] if "USES" in links else links
        found[words[0]] = (words[1], [link for link in links if "::" not in link])
    return found


def reach(links, name, seen=None):
    seen = set() if seen is None else seen
    for link in links[name]:
        if link not in seen:
            seen.add(link)
            reach(links, link, seen)
    return seen


def reduced(links):
    """Without links that others of the same module lead to."""
    return {name: [link for link in direct
                   if not any(link in reach(links, other) for other in direct if other != link)]
            for name, direct in links.items()}


def places(links):
    """{name: (column, row)}: what links nothing at the bottom, above it what links that."""
    depth = {}

    def depth_of(name):
        if name not in depth:
            depth[name] = 1 + max((depth_of(link) for link in links[name]), default=-1)
        return depth[name]

    rows = collections.defaultdict(list)
    for name in links:
        rows[depth_of(name)].append(name)
    place = {}
    for row in sorted(rows):
        def middle(name):
            below = [place[link][0] for link in links[name] if link in place]
            return sum(below) / len(below) if below else 0.0
        for column, name in enumerate(sorted(rows[row], key=lambda n: (middle(n), n))):
            place[name] = (column, row)
    widest = max(len(names) for names in rows.values())
    return {name: (column + (widest - len(rows[row])) / 2.0, row)
            for name, (column, row) in place.items()}


def drawing(folders, links):
    place = places(links)
    top = max(row for _, row in place.values())
    width = int((max(column for column, _ in place.values()) + 1) * COLUMN) + 20
    height = (top + 1) * (ROW + 26) + 20

    def corner(name):
        column, row = place[name]
        return 10 + column * COLUMN, 10 + (top - row) * (ROW + 26)

    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
             'font-family="sans-serif" font-size="11">',
             '<title>Folders of the source, and which of them link which</title>',
             f'<rect width="{width}" height="{height}" fill="#ffffff"/>']
    for name, direct in links.items():
        x, y = corner(name)
        for link in direct:
            to_x, to_y = corner(link)
            lines.append(f'<path d="M{x + BOX[0] / 2:.0f} {y + BOX[1]} C{x + BOX[0] / 2:.0f} '
                         f'{y + BOX[1] + 20} {to_x + BOX[0] / 2:.0f} {to_y - 20} '
                         f'{to_x + BOX[0] / 2:.0f} {to_y}" fill="none" stroke="#8a8f98"/>')
    for name in links:
        x, y = corner(name)
        folder = folders[name]
        layer = folder.split("/")[0]
        label = folder.split("/", 1)[1] if "/" in folder else folder
        lines.append(f'<rect x="{x:.0f}" y="{y}" width="{BOX[0]}" height="{BOX[1]}" rx="4" '
                     f'fill="{COLOURS[layer]}" stroke="#555b66"/>')
        lines.append(f'<text x="{x + BOX[0] / 2:.0f}" y="{y + 13}" text-anchor="middle" '
                     f'fill="#555b66">{layer}/</text>')
        lines.append(f'<text x="{x + BOX[0] / 2:.0f}" y="{y + 26}" text-anchor="middle">'
                     f'{label}</text>')
    return "\n".join(lines + ["</svg>"]) + "\n"


def sources():
    for layer in COLOURS:
        for path in sorted((ROOT / layer).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                yield path


def circles():
    """Sets of file pairs whose includes lead back to themselves."""
    includes = collections.defaultdict(set)
    for path in sources():
        pair = str(path.relative_to(ROOT).with_suffix(""))
        includes[pair] |= set()
        for header in re.findall(r'^#include "([^"]+)"', path.read_text(), re.M):
            other = header.rsplit(".", 1)[0]
            # "bvh" and "bvh_internal" are one idea.
            same = other.removesuffix("_internal") == pair.removesuffix("_internal")
            if not same and (ROOT / header).exists():
                includes[pair].add(other)
    changed = True
    while changed:
        included = set().union(*includes.values()) if includes else set()
        left = {pair: {o for o in others if o in includes} for pair, others in includes.items()
                if pair in included}
        left = {pair: others for pair, others in left.items() if others}
        changed = left != includes
        includes = left
    return sorted(includes)


def print_counts():
    pairs = collections.defaultdict(set)
    lines = 0
    for path in sources():
        pairs[path.parent.relative_to(ROOT)].add(re.sub(r"_internal$", "", path.stem))
        lines += len(path.read_text().splitlines())
    print("| folder | file pairs |\n| --- | --- |")
    for folder in sorted(pairs):
        print(f"| `{folder}` | {len(pairs[folder])} |")
    print(f"\n{len(pairs)} folders, at most {max(map(len, pairs.values()))} file pairs in one, "
          f"{lines} lines, {len(circles())} file pairs in circles")


def main():
    found = modules()
    links = reduced({name: list(direct) for name, (_, direct) in found.items()})
    folders = {name: folder for name, (folder, _) in found.items()}
    (ROOT / "docs/images/folders.svg").write_text(drawing(folders, links))
    if "--counts" in sys.argv[1:]:
        print_counts()


if __name__ == "__main__":
    main()

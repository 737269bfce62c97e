"""Prepares what mkdocs makes the site from: site_pages ROOT HAPTRIAL WORK.

WORK/pages gets the documents under the paths that they have in the repository, so that their links
hold in both places, and beside them the pages that are made here.
"""

import pathlib
import re
import shutil
import subprocess
import sys

import site_gallery
import site_headers
from site_links import Linker

COPIED = {".svg", ".png", ".jpg", ".gif", ".csv", ".json", ".html"}  # browsers show or keep them


def documents(root):
    found = [root / "README.md", root / "CHANGELOG.md"]
    for folder in ("docs", "results"):
        found += sorted((root / folder).rglob("*.md"))
    return found


def title(text):
    return re.search(r"^# (.*)", text, re.M)[1]


def commands(haptrial):
    """The help of every command, and of those below it."""
    def names(text):
        block = re.search(r"^Subcommands:\n(.*?)(\n\n|\Z)", text, re.M | re.S)
        return re.findall(r"^  ([a-z-]+) ", block[1] + "\n", re.M) if block else []

    def page(path):
        text = subprocess.run([haptrial, *path, "--help"], capture_output=True, text=True,
                              check=True).stdout
        yield f"## {' '.join(['haptrial', *path])}\n\n```text\n{text.rstrip()}\n```\n"
        for name in names(text):
            yield from page([*path, name])
    return "# Every command\n\nWhat `--help` says.\n\n" + "\n".join(page([]))


def roles(readme):
    """The rows of README's table "Read on": for whom, and the pages linked."""
    table = readme.split("## Read on")[1].split("\n## ")[0]
    for line in table.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        links = re.findall(r"\[([^]]*)\]\(([^)#]+\.md)\)", cells[-1])
        if len(cells) == 2 and links:
            yield cells[0], links


HOW_TO = {"experimenters", "analysts", "developers", "two people at one task"}  # rows of README


def navigation(pages):
    """Four entries: Start, How to, Reference, Science. Guides by role as in README; each page
    once."""
    readme = (pages / "README.md").read_text()
    start = [("Overview", "README.md"), ("Gallery", "gallery/index.md"),
             ("A first experiment", "docs/guide-first-experiment.md"),
             ("The first participant", "docs/guide-first-participant.md")]
    reference = [("Commands", "reference/commands.md"), ("Keys of a definition", "docs/keys.md"),
                 ("Tables of a session file", "docs/session-file.md"),
                 ("Notices and warnings", "docs/notices.md"), ("Devices", "docs/devices.md"),
                 ("Headers", "reference/headers.md"), ("Sections of the source", "docs/sections.md")]
    shown = {path for _, path in start + reference}
    lines = []

    def entry(text, path, depth):
        lines.append(f"{'    ' * depth}  - {quoted(capital(text))}: {path}")

    def group(name, links, depth):
        kept = [(text, path) for text, path in links
                if path not in shown and (pages / path).exists()]
        shown.update(path for _, path in kept)
        if kept:
            lines.append(f"{'    ' * depth}  - {quoted(capital(name))}:")
            for text, path in kept:
                entry(text, path, depth + 1)

    def top(name, links):
        lines.append(f"  - {name}:")
        for text, path in links:
            if (pages / path).exists():
                entry(text, path, 1)

    rows = list(roles(readme))
    top("Start", start)
    lines.append("  - How to:")
    for role, links in rows:
        if role in HOW_TO:
            group(role, links, 1)
    science = len(lines)
    for role, links in rows:
        if role not in HOW_TO and role != "everybody":
            group(role, links, 1)
    of_science = lines[science:]
    del lines[science:]
    top("Reference", reference)
    for role, links in rows:
        if role == "everybody":
            for text, path in links:
                if path not in shown:
                    shown.add(path)
                    entry(text, path, 1)
    everything = [(title(file.read_text()), file.relative_to(pages).as_posix())
                  for file in sorted(pages.rglob("*.md"))]
    for name, folder in (("Decisions", "docs/decisions/"), ("Shipped experiments", "gallery/"),
                         ("More pages", "docs/"), ("Files", "code/")):
        group(name, [each for each in everything if each[1].startswith(folder)], 1)
    lines.append("  - Science:")
    lines.extend(of_science)
    for name, folder in (("Results", "results/"), ("Project", "")):
        group(name, [each for each in everything if each[1].startswith(folder)], 1)
    return "\n".join(lines)


def capital(text):
    return text if "_" in text else text[:1].upper() + text[1:]


def quoted(text):
    return '"' + text.replace("\\", "").replace('"', '\\"').replace("`", "") + '"'


def settings(pages, theme):
    return f"""site_name: haptrial
site_url: ""
docs_dir: {pages}
use_directory_urls: false
theme:
  name: material
  custom_dir: {theme}
  font: false
  features: [navigation.top, search.highlight]
plugins: [search]
markdown_extensions:
  - tables
  - fenced_code
  - sane_lists
  - codehilite: {{guess_lang: false}}
  - toc: {{permalink: true, slugify: !!python/name:site_links.anchor }}
nav:
{navigation(pages)}
"""


def main(root, haptrial, work):
    root, work = pathlib.Path(root), pathlib.Path(work)
    pages = work / "pages"
    linker = Linker(root, pages, site_headers.pages_of(root, work / "headers.xml"))
    made = {"reference/commands.md": commands(haptrial), **site_gallery.pages(root, haptrial, pages)}
    if linker.headers:
        made["reference/headers.md"] = site_headers.index(root, linker.headers)
    for path, text in made.items():
        (pages / path).parent.mkdir(parents=True, exist_ok=True)
        (pages / path).write_text(text)
    for folder in ("docs", "results"):
        for file in (root / folder).rglob("*"):
            if file.suffix in COPIED and root / "docs/site" not in file.parents:
                target = pages / file.relative_to(root)
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(file, target)
    for file in documents(root):
        linker.write(file)
    (work / "mkdocs.yml").write_text(settings(pages, root / "docs/site/theme"))


main(*sys.argv[1:])

"""Links of the documents on the site: those to files that browsers do not show lead to pages."""

import json
import os
import re

LINK = re.compile(r"(\]\()([^)#\s]+)(#[^)]*)?(\))")
LANGUAGES = {".cpp": "cpp", ".h": "cpp", ".py": "python", ".R": "r", ".toml": "toml", ".sh": "bash"}


def anchor(text, separator="-"):
    """The anchor of a heading, as the repository's web view makes it."""
    text = re.sub(r"<[^>]*>", "", text).strip().lower()
    return re.sub(r"[^\w -]", "", text).replace(" ", separator)


def parts(text):
    """Stretches of a document: outside and inside of code, in turns."""
    return re.split(r"(^ *```.*?^ *```$|`[^`\n]*`)", text, flags=re.M | re.S)


def notebook(file):
    """A notebook as a page: its words and its code."""
    pieces = []
    for cell in json.loads(file.read_text())["cells"]:
        text = "".join(cell["source"])
        pieces.append(text if cell["cell_type"] == "markdown" else f"````python\n{text}\n````")
    return "\n\n".join(pieces) + "\n"


class Linker:
    def __init__(self, root, pages, headers):
        self.root, self.pages, self.headers = root, pages, headers

    def write(self, document):
        """Writes a document into the pages, with the pages that it needs."""
        text = document.read_text()
        text = re.sub(r"(^<!--.*-->)\n(?=\|)", r"\1\n\n", text, flags=re.M)  # a table is a block
        stretches = parts(text)
        for i in range(0, len(stretches), 2):
            stretches[i] = LINK.sub(lambda found: self.link(document, found), stretches[i])
        target = self.pages / document.relative_to(self.root)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text("".join(stretches))

    def link(self, document, found):
        path = found[2]
        file = (document.parent / path).resolve()
        if "://" in path or not file.is_relative_to(self.root) or not file.exists():
            return found[0]
        target = self.page(file)
        here = (self.pages / document.relative_to(self.root)).parent
        return found[1] + os.path.relpath(target, here) + (found[3] or "") + found[4]

    def page(self, file):
        """The page on the site, made if need be, for a file or folder of the repository."""
        name = file.relative_to(self.root)
        if name.as_posix() in self.headers:
            return self.pages / "headers" / self.headers[name.as_posix()]
        if name.parent.as_posix() == "experiments" and (self.pages / "gallery" / f"{file.stem}.md").exists():
            return self.pages / "gallery" / f"{file.stem}.md"
        if file.is_dir():
            return self.folder(file, name)
        if file.suffix == ".md" or (self.pages / name).exists():
            return self.pages / name
        target = self.pages / "code" / f"{name}.md"
        target.parent.mkdir(parents=True, exist_ok=True)
        if file.suffix == ".ipynb":
            target.write_text(notebook(file))
            return target
        language = LANGUAGES.get(file.suffix, "text")
        target.write_text(f"# {name}\n\n````{language}\n{file.read_text()}````\n")
        return target

    def folder(self, file, name):
        if (file / "README.md").exists():
            return self.pages / name / "README.md"
        target = self.pages / name / "index.md"
        target.parent.mkdir(parents=True, exist_ok=True)
        lines = [f"# {name}\n"]
        for each in sorted(file.iterdir()):
            text = each.name
            if each.suffix == ".md":
                text = re.search(r"^# (.*)", each.read_text(), re.M)[1]
            if each.is_file():
                lines.append(f"- [{text}]({os.path.relpath(self.page(each), target.parent)})")
        target.write_text("\n".join(lines) + "\n")
        return target

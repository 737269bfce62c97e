"""The gallery: each shipped definition with pictures, its report and its text."""

import pathlib
import re
import shutil
import subprocess
import tempfile

# Drillings take long to rehearse; their pictures are those of the guides.
PICTURES = {
    "bone_drilling": ["docs/images/bone-drilled.png"],
    "burr_shapes": ["docs/images/burr-shapes.png"],
    "construct_validity": ["docs/images/validity-live.jpg"],
    "first_drilling": ["docs/images/first-drilling.png"],
    "nerve_training": ["docs/algorithms/nerve-monitor.png"],
    "sinus_exposure": ["docs/images/bone-drilled.png"],
    "two_hands": ["docs/images/two-hands.png"],
}
TABLES = ("scores.csv", "estimates.csv", "metrics.csv")


def headline(text):
    """The comment that a definition begins with, as one paragraph."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# "))
    return " ".join(lines)


def rehearsed(definition, haptrial, folder):
    """Three moments of a virtual participant's first trial, as it was seen."""
    def run(*words):
        subprocess.run([haptrial, *map(str, words)], check=True, capture_output=True)

    with tempfile.TemporaryDirectory() as work:
        out, frames = pathlib.Path(work) / "out", pathlib.Path(work) / "frames"
        run("dry-run", definition, "--subjects", 1, "--trials", 1, "--out", out)
        run("replay", out / "S01.h5", "--trial", 1, "--fps", 3, "--frames", frames)
        shown = sorted(frames.rglob("*.png"))
        chosen = [shown[len(shown) // 4], shown[len(shown) // 2], shown[-1]]
        folder.mkdir(parents=True, exist_ok=True)
        for number, picture in enumerate(chosen, 1):
            shutil.copy(picture, folder / f"{definition.stem}-{number}.png")
    return [f"pictures/{definition.stem}-{number}.png" for number in range(1, 4)]


def report(root, name):
    folder = root / "results" / name
    if not (folder / "report.html").exists():
        return f"No report of it is kept: `haptrial dry-run experiments/{name}.toml`, then `haptrial analyze`."
    links = [f"[report](../results/{name}/report.html)"]
    links += [f"[{table}](../results/{name}/{table})" for table in TABLES if (folder / table).exists()]
    return "Of **simulated** participants: " + ", ".join(links) + "."


def page(root, definition, pictures):
    text = definition.read_text()
    shown = " | ".join(f"![What is seen: {number}]({picture})" for number, picture in enumerate(pictures, 1))
    if len(pictures) > 1:  # side by side
        shown = f"|{' |' * len(pictures)}\n|{' --- |' * len(pictures)}\n| {shown} |"
    other = [file.name for file in sorted(definition.parent.glob(f"{definition.stem}.texts.*.toml"))]
    texts = "".join(f"\n## {name}\n\n```toml\n{(definition.parent / name).read_text()}```\n" for name in other)
    return (f"# {definition.stem}\n\n{headline(text)}\n\n{shown}\n\n## Report\n\n{report(root, definition.stem)}\n\n"
            f"## Definition\n\nA copy to change: `haptrial new study.toml --from {definition.stem}`\n\n"
            f"```toml\n{text}```\n{texts}")


def pages(root, haptrial, folder):
    made, rows = {}, []
    for definition in sorted((root / "experiments").glob("*.toml")):
        if ".texts." in definition.name:
            continue
        name = definition.stem
        if name in PICTURES:
            pictures = ["../" + picture for picture in PICTURES[name]]
        else:
            pictures = rehearsed(definition, haptrial, folder / "gallery/pictures")
        made[f"gallery/{name}.md"] = page(root, definition, pictures)
        first = re.split(r"(?<=[.?]) ", headline(definition.read_text()))[0]
        rows.append(f"| [![{name}]({pictures[-1] if len(pictures) == 1 else pictures[1]})]({name}.md) | "
                    f"[{name}]({name}.md): {first} |")
    made["gallery/index.md"] = ("# Gallery of experiments\n\nEvery shipped definition: what is seen, its report, its "
                                "text. `haptrial examples` lists them.\n\n| | |\n| --- | --- |\n" + "\n".join(rows) + "\n")
    return made

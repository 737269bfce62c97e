"""What the tests of the Python module share: the command, and studies simulated by it."""
import functools
import os
import pathlib
import subprocess
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[3]
COMMAND = os.environ.get("HAPTRIAL_COMMAND", str(SOURCE / "build" / "haptrial"))
_folder = tempfile.TemporaryDirectory(prefix="haptrial-python-")
FOLDER = pathlib.Path(_folder.name)


def command(*arguments):
    """Runs the command; its output, and its sentence where it refuses something."""
    done = subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


@functools.lru_cache(maxsize=None)
def simulated(name, *options):
    """The folder of a study of virtual subjects that ran a shipped definition, analysed."""
    folder = FOLDER / name
    for arguments in (["dry-run", SOURCE / "experiments" / f"{name}.toml", "--out", folder, *options],
                      ["analyze", folder]):
        status, _, error = command(*arguments)
        if status != 0:
            raise RuntimeError(f"haptrial {arguments[0]}: {error}")
    return folder


def force_study():
    return simulated("force_training", "--subjects", "2", "--trials", "6")


def stiffness_study():
    return simulated("stiffness_discrimination", "--subjects", "2")

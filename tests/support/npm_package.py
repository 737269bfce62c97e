"""Packages of npm that tests use. Each holds all that it needs, so neither npm nor dependencies are.

    npm_package.py FOLDER NAME    puts one into a folder and prints where its files are. Exit status
                                  3: the package registry is out of reach.
"""
import base64
import hashlib
import io
import os
import pathlib
import shutil
import sys
import tarfile
import urllib.request

PACKAGES = {  # version and SHA-512
    "axe-core": ("4.14.1", "FHfa+lmNjQZfJz1q8wKqIDwC6DExcHt/pkjNQb09a3NPjCKg2rhu5qb2S4r76ASy"
                           "FNNtuFooJpZe37OgudVGtQ=="),
    "bids-validator": ("1.15.0", "gZ0UUTLBt5L3nuhLia/VfvK5OaM0yoTBPJvGmC4slQ8yDzpanWZOHHBS+PAua0ri"
                                 "Q7Cwa51HER/Fnd9v17MHUw=="),
    "mujoco": ("3.1.16", "h+B+e7DfLzdTtdCAkp5QKlL/Uo5KPHmgwOK0bF8QQq3Id3PCoWfCSLWEGULw/alN"
                         "NszCDKetcl+7T3SUVOj0Pw=="),
}


class OutOfReach(Exception):
    """The package registry cannot be reached."""


def npm_package(folder, name):
    """Puts a package into a folder, unless it is there. @returns the folder of its files"""
    version, sha512 = PACKAGES[name]
    to = pathlib.Path(folder) / f"{name}-{version}"
    if not to.exists():
        url = f"https://registry.npmjs.org/{name}/-/{name}-{version}.tgz"
        try:
            package = urllib.request.urlopen(url, timeout=60).read()
        except OSError as error:
            raise OutOfReach(f"{url}: {error}") from None
        found = base64.b64encode(hashlib.sha512(package).digest()).decode()
        if found != sha512:
            raise SystemExit(f"{url} is not what is expected: sha512-{found}")
        new = to.with_name(f"{to.name}.{os.getpid()}")
        with tarfile.open(fileobj=io.BytesIO(package)) as archive:
            archive.extractall(new)
        try:
            new.rename(to)
        except OSError:  # another process was first
            shutil.rmtree(new)
    return to / "package"


if __name__ == "__main__":
    try:
        print(npm_package(*sys.argv[1:]))
    except OutOfReach as error:
        print(error, file=sys.stderr)
        sys.exit(3)

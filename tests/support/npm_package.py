"""Packages of npm that tests use. Each holds all that it needs, so neither npm nor dependencies are.
"""
import base64
import hashlib
import io
import os
import pathlib
import shutil
import tarfile
import urllib.request


class OutOfReach(Exception):
    """The package registry cannot be reached."""


def npm_package(folder, name, version, sha512):
    """Puts a package into a folder, unless it is there. @returns the folder of its files"""
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

"""Puts the official validator, the npm package bids-validator, into a folder and prints the file
that node runs. The package holds all that it needs, so neither npm nor its dependencies are.
Exit status 3: the package registry is out of reach.

    bids_validator.py FOLDER
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

VERSION = "1.15.0"
SHA512 = "gZ0UUTLBt5L3nuhLia/VfvK5OaM0yoTBPJvGmC4slQ8yDzpanWZOHHBS+PAua0riQ7Cwa51HER/Fnd9v17MHUw=="

folder = pathlib.Path(sys.argv[1]) / f"bids-validator-{VERSION}"
if not folder.exists():
    url = f"https://registry.npmjs.org/bids-validator/-/bids-validator-{VERSION}.tgz"
    try:
        package = urllib.request.urlopen(url, timeout=60).read()
    except OSError as error:
        print(f"{url}: {error}", file=sys.stderr)
        sys.exit(3)
    found = base64.b64encode(hashlib.sha512(package).digest()).decode()
    if found != SHA512:
        sys.exit(f"{url} is not what is expected: sha512-{found}")
    new = folder.with_name(f"{folder.name}.{os.getpid()}")
    with tarfile.open(fileobj=io.BytesIO(package)) as archive:
        archive.extractall(new)
    try:
        new.rename(folder)
    except OSError:  # another process was first
        shutil.rmtree(new)
print(folder / "package" / "bin" / "bids-validator")

"""Puts the official validator, the npm package bids-validator, into a folder and prints the file
that node runs. Exit status 3: the package registry is out of reach.

    bids_validator.py FOLDER
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from npm_package import OutOfReach, npm_package  # noqa: E402

VERSION = "1.15.0"
SHA512 = "gZ0UUTLBt5L3nuhLia/VfvK5OaM0yoTBPJvGmC4slQ8yDzpanWZOHHBS+PAua0riQ7Cwa51HER/Fnd9v17MHUw=="

try:
    print(npm_package(sys.argv[1], "bids-validator", VERSION, SHA512) / "bin" / "bids-validator")
except OutOfReach as error:
    print(error, file=sys.stderr)
    sys.exit(3)

"""Descriptions of data sets that `edifice data describe` writes, read by MLCommons' own library (`pip install mlcroissant`).

usage: croissant.py EDIFICE PICTURE...
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

import mlcroissant


def main(edifice, *pictures):
    with tempfile.TemporaryDirectory() as folder:
        for picture in pictures:
            shutil.copy(picture, folder)
        subprocess.run([edifice, "data", "describe", folder], check=True, capture_output=True)
        read = mlcroissant.Dataset(jsonld=str(pathlib.Path(folder) / "croissant.json"))
        errors = list(read.metadata.issues.errors)
        assert not errors, errors
        described = {record.name for record in read.metadata.distribution}
        assert described, "no file is described"
    print(f"{len(pictures)} pictures: read by mlcroissant without errors")


main(*sys.argv[1:])

"""Bundles that `edifice sweep bundle --ro-crate` writes, read by the RO-Crate library (`pip install rocrate`).

usage: ro_crate.py EDIFICE LAYOUT.facade.json...
"""

import pathlib
import subprocess
import sys
import tempfile
import zipfile

from rocrate.rocrate import ROCrate


def main(edifice, *layouts):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        paths = [str(pathlib.Path(layout).resolve()) for layout in layouts]
        text = f'study = "facade_grammar/infer"\ndata = {paths!r}\n[[arm]]\nname = "greedy"\nset.method = "greedy"\n'
        (folder / "s.toml").write_text(text)
        run = lambda *words: subprocess.run([edifice, "sweep", *words], check=True, capture_output=True, cwd=folder)
        run("run", "s.toml", "--out", "out")
        licence = "https://creativecommons.org/licenses/by/4.0/"
        run("bundle", "s.toml", "--out", "out", "-o", "crate.zip", "--ro-crate", "--published", "2026-01-02", "--licence", licence)
        crate = ROCrate(str(folder / "crate.zip"))
        assert crate.datePublished.date().isoformat() == "2026-01-02", crate.datePublished
        assert crate.license.id == licence, crate.license
        with zipfile.ZipFile(folder / "crate.zip") as packed:
            names = set(packed.namelist()) - {"manifest.json", "ro-crate-metadata.json"}
            sizes = {name: packed.getinfo(name).file_size for name in names}
        files = {entity.id: entity for entity in crate.data_entities}
        assert set(files) == names, set(files) ^ names
        assert all(int(files[name]["contentSize"]) == sizes[name] for name in names)
        run_of_it = crate.dereference("#run")
        assert {made.id for made in run_of_it["result"]} == {"results.csv", "times.csv"}
        assert all(hasattr(given, "id") for given in run_of_it["object"]), "a link that leads nowhere"
    print(f"{len(files)} files: read by rocrate, each with its size")


main(*sys.argv[1:])

#!/usr/bin/env bash
# IfcOpenShell (PyPI `ifcopenshell`, whose express rules need `pytest`) on 100 houses that the program writes as IFC4: 70 generated ones and 30 of the shipped ones. Every file has to be valid by the
# schema and by its express rules; every wall, window and door has to give triangles; windows and doors have to be as many as in the house, and
# their surface the same. Exit code 1 for any error. Where Python or the package cannot be had, it says so and passes.
#
# usage: tests/external/ifc.sh [PATH_OF_EDIFICE]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

skip() {
    printf 'ifc: not run: %s\n' "$1"
    exit 0
}
command -v python3 >/dev/null || skip 'python3 is not installed'
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv" 2>"$folder/install.log" || skip 'python3 has no venv'
"$folder/venv/bin/pip" install --quiet ifcopenshell pytest >"$folder/install.log" 2>&1 ||
    skip "pip cannot install ifcopenshell ($(tail -n 1 "$folder/install.log"))"

edifice=${1:-}
if [ -z "$edifice" ]; then
    cargo build --quiet --bin edifice
    edifice=${CARGO_TARGET_DIR:-target}/debug/edifice
fi

"$edifice" building generate -n 70 -o "$folder/generated" --format json,obj,ifc --quiet
head -n 30 datasets/building_exteriors/houses.buildings.jsonl >"$folder/few.buildings.jsonl"
"$edifice" building attributes "$folder/few.buildings.jsonl" >"$folder/few.csv"
"$edifice" building build "$folder/few.csv" -o "$folder/built" --format json,obj,ifc --quiet
"$folder/venv/bin/python" tests/external/ifc.py 100 "$folder/generated" "$folder/built"

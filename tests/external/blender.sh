#!/usr/bin/env bash
# Textured houses as Blender imports them (PyPI `bpy`, in an environment of its own): names, parents, custom properties,
# texture coordinates, materials and images. Exit code 1 for any fault. Where no Python has a `bpy` it says so and passes.
#
# usage: tests/external/blender.sh [PATH_OF_EDIFICE]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Each version of `bpy` is for one version of Python.
python=
for name in python3.11 python3.13 python3.12 python3; do
    command -v "$name" >/dev/null && "$name" -m venv --clear "$folder/venv" >"$folder/log" 2>&1 &&
        "$folder/venv/bin/pip" install --quiet bpy >"$folder/log" 2>&1 && python=$folder/venv/bin/python && break
done
[ -n "$python" ] || {
    printf 'blender: not run: no Python can install bpy (%s)\n' "$(tail -n 1 "$folder/log" 2>/dev/null)"
    exit 0
}

edifice=${1:-}
if [ -z "$edifice" ]; then
    cargo build --quiet --bin edifice
    edifice=${CARGO_TARGET_DIR:-target}/debug/edifice
fi

head -n 8 datasets/building_exteriors/houses.buildings.jsonl >"$folder/few.buildings.jsonl"
"$edifice" building attributes "$folder/few.buildings.jsonl" >"$folder/few.csv"
"$edifice" building build "$folder/few.csv" -o "$folder/houses" --format glb
"$python" tests/external/blender_houses.py "$folder"/houses/*.glb

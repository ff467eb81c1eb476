#!/usr/bin/env bash
# The 3D Tiles validator (npm `3d-tiles-validator`) on tiles that the program writes: a city of instances in several levels.
# Exit code 1 for any error. Where node, npm, the registry or the package is missing it says so and passes.
#
# usage: tests/external/tiles_validator.sh [PATH_OF_EDIFICE]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

skip() {
    printf 'tiles_validator: not run: %s\n' "$1"
    exit 0
}
for tool in node npm; do
    command -v "$tool" >/dev/null || skip "$tool is not installed"
done

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
(cd "$folder" && npm init -y && npm install --no-audit --no-fund 3d-tiles-validator) >"$folder/npm.log" 2>&1 ||
    skip "npm cannot install 3d-tiles-validator ($(grep -m 1 "npm error 404" "$folder/npm.log" || tail -n 1 "$folder/npm.log"))"

edifice=${1:-}
if [ -z "$edifice" ]; then
    cargo build --quiet --bin edifice
    edifice=${CARGO_TARGET_DIR:-target}/debug/edifice
fi

houses=datasets/building_exteriors/houses.buildings.jsonl
head -n 12 "$houses" >"$folder/few.buildings.jsonl"
"$edifice" building attributes "$folder/few.buildings.jsonl" >"$folder/few.csv"
"$edifice" building build "$folder/few.csv" -o "$folder/houses" --format obj
"$edifice" city proceduralize "$folder"/houses/*.obj -o "$folder/a.city-grammar.json"
"$edifice" city tiles "$folder/a.city-grammar.json" -o "$folder/tiles" --instances 8
(cd "$folder" && npx 3d-tiles-validator --tilesetFile tiles/tileset.json) >"$folder/report.json"
grep -q '"numErrors": 0' "$folder/report.json" || {
    cat "$folder/report.json"
    exit 1
}
printf 'tiles_validator: no errors\n'

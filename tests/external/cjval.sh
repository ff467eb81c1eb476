#!/usr/bin/env bash
# cjval, the validator of CityJSON (cargo install cjval --features build-binary), on cities that the program writes: derived from a grammar of houses, with
# a reference system, and with identifiers and attributes; and on houses and a village of level of detail 3. Exit code 1 for any error. Where cjval is not installed and
# cannot be, it says so and passes.
#
# usage: tests/external/cjval.sh [PATH_OF_EDIFICE]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

skip() {
    printf 'cjval: not run: %s\n' "$1"
    exit 0
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cjval=$(command -v cjval) || {
    cargo install --quiet --locked --features build-binary --root "$folder/cjval" cjval >"$folder/install.log" 2>&1 ||
        skip "cargo cannot install it ($(tail -n 1 "$folder/install.log"))"
    cjval=$folder/cjval/bin/cjval
}

edifice=${1:-}
if [ -z "$edifice" ]; then
    cargo build --quiet --bin edifice
    edifice=${CARGO_TARGET_DIR:-target}/debug/edifice
fi

houses=datasets/building_exteriors/houses.buildings.jsonl
head -n 4 "$houses" >"$folder/few.buildings.jsonl"
"$edifice" building attributes "$folder/few.buildings.jsonl" >"$folder/few.csv"
"$edifice" building build "$folder/few.csv" -o "$folder/houses" --format obj
valid() {
    "$cjval" --summary "$1" >"$folder/report.txt" || true
    grep -qiE 'is valid|✅|100% valid' "$folder/report.txt" && ! grep -qiE 'invalid|❌' "$folder/report.txt" || {
        cat "$folder/report.txt"
        printf 'cjval: errors %s\n' "$2"
        exit 1
    }
}
for system in null '"EPSG:7415"' '"urn:ogc:def:crs:EPSG::28992"' '"somewhere"'; do
    "$edifice" city proceduralize "$folder"/houses/*.obj -o "$folder/a.city-grammar.json"
    sed -i "s/\"reference_system\": null/\"reference_system\": $system/" "$folder/a.city-grammar.json"
    sed -i '0,/"id":"/s//"attributes":{"year":1931},"id":"/' "$folder/a.city-grammar.json"
    "$edifice" city derive "$folder/a.city-grammar.json" -o "$folder/a.city.json"
    valid "$folder/a.city.json" "with reference system $system"
done
"$edifice" building generate -n 100 -o "$folder/detailed" --format cityjson
"$edifice" building complete datasets/building_exteriors/real.houses.json datasets/building_exteriors/village.city.json \
    --facades -o "$folder/detailed/village.city.json"
for file in "$folder"/detailed/*.city.json; do
    valid "$file" "in $(basename "$file")"
done
printf 'cjval: 105 files without errors\n'

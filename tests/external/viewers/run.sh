#!/usr/bin/env bash
# 3D Tiles in the viewers people use: 3DTilesRendererJS (three.js) and CesiumJS, in a browser without a window. Installs what it needs itself:
# the viewers from npm into a folder of its own, and chromium from Debian where there is none. The browser reaches this machine alone.
#   tests/external/viewers/run.sh [EDIFICE] [PICTURES] [TILESET_FOLDER...]
# EDIFICE is the program (built by cargo where it is not given or empty); pictures go to PICTURES, a new folder by default.
# Each TILESET_FOLDER holds a `tileset.json`. Without any, the shipped town is written as tiles, where it is, at
# the coordinates of a national grid, and compressed on the earth; two of them are worked as countries, too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

browser=$(tests/external/chromium.sh)
program=${1:-}
if [ -z "$program" ]; then
    cargo build --quiet --bin edifice
    program=${CARGO_TARGET_DIR:-target}/debug/edifice
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
pictures=${2:-$work/pictures}
mkdir -p "$pictures"

folders=("${@:3}")
if [ ${#folders[@]} -eq 0 ]; then
    town=datasets/city_proceduralization/town.city-grammar.json
    "$program" city derive -q "$town" -o "$work/town.obj"
    # Coordinates this large do not fit into 32 bits to the millimetre: what is written has an origin of its own.
    awk '/^v / { printf "v %.3f %.3f %.3f\n", $2 + 85000, $3 + 446000, $4; next } { print }' "$work/town.obj" >"$work/far.obj"
    "$program" city proceduralize -q "$work/far.obj" -o "$work/far.city-grammar.json" >/dev/null
    "$program" city tiles -q "$town" -o "$work/town" >/dev/null
    # Few instances in a tile, so that there are tiles of tiles.
    "$program" city tiles -q --instances 100 "$work/far.city-grammar.json" -o "$work/far" >/dev/null
    # On the earth, compressed: those are coordinates of the Dutch grid.
    sed 's/"reference_system": *null/"reference_system": "EPSG:28992"/' "$work/far.city-grammar.json" >"$work/earth.city-grammar.json"
    "$program" city tiles -q --compress --instances 100 "$work/earth.city-grammar.json" -o "$work/earth" >/dev/null
    folders=("$work/town" "$work/far" "$work/earth")
    for city in town far; do
        "$program" city plan -q "$work/$city.obj" --tile 150 --scenes -o "$work/$city.plan" >/dev/null
        "$program" city work -q "$work/$city.plan" >/dev/null
        mv "$work/$city.plan"/city-*/3dtiles "$work/$city-country"
        folders+=("$work/$city-country")
    done
fi

cp tests/external/viewers/*.mjs "$work"
# Below version 1 it is the second number that promises not to break.
(cd "$work" && npm init -y >/dev/null && npm install --no-audit --no-fund --silent \
    playwright-core@1 cesium@1 three@0.187 3d-tiles-renderer@0.5 esbuild@0.28)
(cd "$work" && npx esbuild three.mjs --bundle --format=esm --log-level=warning --outfile=three.bundle.mjs)
BROWSER=$browser PICTURES=$(realpath "$pictures") node "$work/viewers.mjs" "${folders[@]}"

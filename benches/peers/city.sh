#!/usr/bin/env bash
# Bytes at equal volumetric IoU: our compact grammars against gltfpack's simplification followed by Draco, on real cities.
# Prints CSV: city, method, setting, bytes, iou. Needs node, npm, Python with PyPI, and a release build.
#
# usage: benches/peers/city.sh EDIFICE DATA_FOLDER WORK_FOLDER [CITY...]     (cities: midtown, delft)
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
edifice=$(realpath "$1")
data=$(realpath "$2")
mkdir -p "$3"
cd "$3"
shift 3
[ $# -gt 0 ] || set -- midtown delft

[ -d node_modules/gltfpack ] || {
    npm init -y
    npm install --no-audit --no-fund gltfpack@1.3.0 draco3dgltf@1.5.7
} >npm.log 2>&1
[ -x venv/bin/python ] || {
    python3 -m venv venv
    venv/bin/pip install --quiet numpy==2.4.6
} >pip.log 2>&1

iou() { "$edifice" city compare "$1" "$2" --resolution 1 --json | tail -n 1 | sed -E 's/.*"iou":([0-9.]+).*/\1/'; }

for city in "$@"; do
    case $city in
    midtown) file=$data/city/nyc_midtown4500.npz ;;
    delft) file=$data/city/delft_bag3d.npz ;;
    *) file=$city ;;
    esac
    [ -e "$city.glb" ] || venv/bin/python "$here/city.py" "$file" "$city.glb" "$city-each.glb"
    # One mesh: identities are lost.
    for ratio in 1 0.95 0.7 0.5 0.4 0.3; do
        node_modules/.bin/gltfpack -noq -si "$ratio" -i "$city.glb" -o "$city-$ratio.glb" >>gltfpack.log
        NODE_PATH=node_modules node "$here/city.cjs" "$city-$ratio.glb" "$city-$ratio" 10,11,12,13,14,16 >"$city-$ratio.txt"
        while read -r bits bytes obj; do
            echo "$city,gltfpack+draco,si $ratio $bits bits,$bytes,$(iou "$file" "$obj")"
            rm "$obj"
        done <"$city-$ratio.txt"
    done
    # A mesh for each building.
    NODE_PATH=node_modules node "$here/city.cjs" "$city-each.glb" "$city-each" 5,6,7,8,10,12 >"$city-each.txt"
    while read -r bits bytes obj; do
        echo "$city,draco per mesh,$bits bits,$bytes,$(iou "$file" "$obj")"
        rm "$obj"
    done <"$city-each.txt"
    for keep in shape buildings ids; do
        for level in 2 3 4 5 6; do
            "$edifice" city proceduralize "$file" --level "$level" --keep "$keep" -o "$city.city-grammar.bin" 2>/dev/null >/dev/null
            echo "$city,ours ($keep),level $level,$(stat -c %s "$city.city-grammar.bin"),$(iou "$file" "$city.city-grammar.bin")"
        done
    done
done

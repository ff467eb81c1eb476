#!/usr/bin/env bash
# The Khronos validator (npm `gltf-validator`) on files that the program writes: twelve textured houses, a street of houses,
# facades on a town, a city of instances, with and without textures. Exit code 1 for any error. Where node, npm or the registry is missing it says so and passes.
#
# usage: tests/external/gltf_validator.sh [PATH_OF_EDIFICE]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

skip() {
    printf 'gltf_validator: not run: %s\n' "$1"
    exit 0
}
for tool in node npm; do
    command -v "$tool" >/dev/null || skip "$tool is not installed"
done

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
(cd "$folder" && npm init -y && npm install --no-audit --no-fund gltf-validator@2.0.0-dev.3.10) >"$folder/npm.log" 2>&1 ||
    skip "npm cannot install gltf-validator ($(tail -n 1 "$folder/npm.log"))"

edifice=${1:-}
if [ -z "$edifice" ]; then
    cargo build --quiet --bin edifice
    edifice=${CARGO_TARGET_DIR:-target}/debug/edifice
fi

houses=datasets/building_exteriors/houses.buildings.jsonl
head -n 12 "$houses" >"$folder/few.buildings.jsonl"
"$edifice" building attributes "$folder/few.buildings.jsonl" >"$folder/few.csv"
"$edifice" building build "$folder/few.csv" -o "$folder/houses" --format glb,obj --street
"$edifice" reproduce facade_grammar --only figure_15 --budget smoke --out "$folder/reports" >/dev/null
"$edifice" city proceduralize "$folder/houses/house_0001.obj" -o "$folder/a.city-grammar.json" --glb "$folder/city.glb"
# With a texture on its four walls.
base64 -d >"$folder/wall.png" <<'END'
iVBORw0KGgoAAAANSUhEUgAAAAQAAAAECAIAAAAmkwkpAAAAFElEQVR42mM4gQQYgFgDDLBx4AAADGEeASW79/0AAAAASUVORK5CYII=
END
printf 'newmtl wall\nmap_Kd wall.png\n' >"$folder/wall.mtl"
cat >"$folder/wall.obj" <<'END'
mtllib wall.mtl
v 0 0 0
v 9 0 0
v 9 6 0
v 0 6 0
v 0 0 4
v 9 0 4
v 9 6 4
v 0 6 4
vt 0 0
vt 1 0
vt 1 1
vt 0 1
o house
usemtl wall
f 1/1 2/2 6/3 5/4
f 2/1 3/2 7/3 6/4
f 3/1 4/2 8/3 7/4
f 4/1 1/2 5/3 8/4
f 5 6 7 8
END
"$edifice" city proceduralize "$folder/wall.obj" -o "$folder/b.city-grammar.json" --glb "$folder/textured.glb"
"$edifice" city derive "$folder/b.city-grammar.json" --no-instancing -o "$folder/textured_nodes.glb"
grep -q '"texture"' "$folder/b.city-grammar.json"

# Compressed, and as tiles.
"$edifice" city derive datasets/city_proceduralization/town.city-grammar.json --compress -o "$folder/compressed.glb"
"$edifice" city tiles datasets/city_proceduralization/town.city-grammar.json -o "$folder/tiles"
"$edifice" city tiles datasets/city_proceduralization/town.city-grammar.json --compress -o "$folder/small_tiles"
mapfile -t files < <(find "$folder" -name '*.glb' -not -path '*/node_modules/*' | sort)
[ "${#files[@]}" -ge 20 ] || {
    printf 'gltf_validator: only %d files were written\n' "${#files[@]}" >&2
    exit 1
}
cat >"$folder/validate.cjs" <<'END'
const fs = require("fs");
const validator = require("gltf-validator");
(async () => {
  let bad = 0;
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    const { numErrors, numWarnings, messages } = report.issues;
    console.log(`${file.split("/").pop()}: ${numErrors} errors, ${numWarnings} warnings`);
    for (const m of messages.filter((m) => m.severity === 0)) console.log(`  ${m.code} ${m.pointer}: ${m.message}`);
    bad += numErrors;
  }
  process.exit(bad > 0 ? 1 : 0);
})();
END
(cd "$folder" && node validate.cjs "${files[@]}")
printf 'gltf_validator: %d files without errors\n' "${#files[@]}"

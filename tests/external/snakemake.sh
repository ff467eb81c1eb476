#!/usr/bin/env bash
# Sweeps through Snakemake (local executor): installs it from PyPI into a folder of its own unless SNAKEMAKE names one, runs
# what `edifice sweep submit --engine snakemake` wrote, compares with a run by threads, kills Snakemake on the way and starts it
# again. A minute and the installation. Not part of .ci/run, which has no such time left: run it by hand after a change of
# `experiments/sweep/submit`. EDIFICE names the program; without it the debug build is made.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
root=$PWD

say() { printf 'snakemake.sh: %s\n' "$*" >&2; }
fail() {
    say "FAILED: $*"
    exit 1
}

if [ -z "${EDIFICE:-}" ]; then
    cargo build --quiet --bin edifice
    EDIFICE="${CARGO_TARGET_DIR:-target}/debug/edifice"
fi
EDIFICE=$(realpath "$EDIFICE")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [ -z "${SNAKEMAKE:-}" ]; then
    say "installing snakemake"
    python3 -m venv "$work/venv"
    "$work/venv/bin/pip" install --quiet snakemake
    SNAKEMAKE=$work/venv/bin/snakemake
fi
SNAKEMAKE=$(realpath -s "$SNAKEMAKE")
PATH="$(dirname "$SNAKEMAKE"):$PATH"
say "snakemake $("$SNAKEMAKE" --version)"

# A folder whose name a careless script would trip over.
mkdir "$work/it's a folder"
cd "$work/it's a folder"
edifice() { "$EDIFICE" sweep "$@"; }
sweep() { # rounds, pack
    printf 'study = "optim/annealing"\ndata = ["*.knapsack.json"]\nseeds = 5\n[base]\nrounds = %s\n[[grid]]\nset.start = [0.1, 0.3, 1.0, 3.0, 10.0]\n[task]\nmem = "200M"\npack = "%s"\n' "$1" "$2"
}
snakemake() { "$SNAKEMAKE" --quiet --cores 2 --snakefile "$1/Snakefile" "${@:2}"; }

sweep 50 200s >quick.toml
edifice run quick.toml --out one --threads 1
edifice collect quick.toml --out one
edifice submit quick.toml --out snake --engine snakemake
snakemake snake
cmp one/results.csv snake/results.csv
say "250 tasks: the same bytes by 1 thread and by Snakemake"

sweep 2000 200s >slow.toml
edifice run slow.toml --out whole --threads 2
edifice collect slow.toml --out whole
edifice submit slow.toml --out faults --engine snakemake
setsid "$SNAKEMAKE" --quiet --cores 2 --snakefile faults/Snakefile &
group=$!
for _ in $(seq 200); do
    [ "$(cat faults/journal/*.jsonl 2>/dev/null | wc -l)" -lt 30 ] || break
    sleep 0.1
done
kill -9 -- "-$group"
wait "$group" 2>/dev/null || true
before=$(cat faults/journal/*.jsonl | wc -l)
[ "$before" -lt 250 ] || fail "it was done before it could be killed"
say "killed Snakemake and its tasks after $before results"
# What is left is packed anew; marks of the jobs that were killed say nothing of these.
edifice submit slow.toml --out faults --engine snakemake
"$SNAKEMAKE" --quiet --snakefile faults/Snakefile --unlock
snakemake faults --rerun-incomplete
cmp whole/results.csv faults/results.csv
say "250 tasks: the same bytes after Snakemake was killed"

"$EDIFICE" --quiet city derive "$root/datasets/city_proceduralization/town.city-grammar.json" -o town.obj
"$EDIFICE" --quiet city plan town.obj --tile 60 -o country
cp -r country jobs
"$EDIFICE" --quiet city work country
"$EDIFICE" city submit jobs --engine snakemake --workers 3
snakemake jobs
diff -r country/city-* jobs/city-* || fail "workers of Snakemake wrote other bytes"
say "a country in tiles: the same bytes by one worker and by three jobs of Snakemake"
say passed

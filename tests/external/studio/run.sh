#!/usr/bin/env bash
# The studio in a real browser: each editor's story from opening to the saved file. Installs what it needs itself:
# playwright-core and axe-core from npm into a folder of its own, and chromium from Debian where there is none.
#   tests/external/studio/run.sh [EDIFICE] [SCREENSHOTS] [SCRIPT [ARGUMENT]]
# EDIFICE is the program (built by cargo where it is not given); pictures go to SCREENSHOTS, a new folder by default;
# SCRIPT is stories.mjs (ARGUMENT: one story), speed.mjs (page times of 200 edits of each editor) or thumbnails.mjs (pictures of the examples).
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
cp tests/external/studio/*.mjs "$work"
(cd "$work" && npm init -y >/dev/null && npm install --no-audit --no-fund --silent playwright-core@1 axe-core@4)
pictures=${2:-$work/pictures}
mkdir -p "$pictures"
REPORT=$(realpath reports/index.html) EDIFICE=$(realpath "$program") BROWSER=$browser PICTURES=$(realpath "$pictures") node "$work/${3:-stories.mjs}" ${4:+"$4"}

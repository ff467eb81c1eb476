#!/usr/bin/env bash
# Prints the path of a chromium, installed from Debian where there is none; exit code 1 where none can be had.
set -euo pipefail

find_it() { command -v chromium || command -v chromium-browser || command -v google-chrome; }
find_it && exit
if ! command -v apt-get >/dev/null || ! apt-get install -y --no-install-recommends chromium >&2; then
    printf 'no chromium here, and none to install: nothing was checked in a browser\n' >&2
    exit 1
fi
find_it

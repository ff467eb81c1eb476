#!/usr/bin/env bash
# The static program (or the one named) in a root folder that has nothing else but /tmp: no glibc, no shell, no fonts, no /proc. It makes
# every table and figure at the smoke budget there. Needs root, or a kernel that lets users have namespaces.
set -euo pipefail
cd "$(dirname "$0")/../.."
program=${1:-}
if [ -z "$program" ]; then
    archive=$(packaging/static | tail -n 1)
    program=${archive%.tar.gz}/edifice
fi
if ldd "$program" 2> /dev/null | grep -q '=>'; then
    echo "$program asks for shared libraries" >&2
    exit 1
fi
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
mkdir "$root/tmp"
cp "$program" "$root/edifice"
# The environment is empty, so that the program has its path here.
within=("$(command -v chroot)")
[ "$(id -u)" -eq 0 ] || within=("$(command -v unshare)" --map-root-user "${within[@]}")
inside() { env -i "${within[@]}" "$root" /edifice "$@"; }
inside --version
inside reproduce --budget smoke --out /tmp/report --quiet
made=$(find "$root/tmp/report" -name '*.csv' | wc -l)
[ -s "$root/tmp/report/index.html" ] && [ "$made" -ge 50 ] || { echo "only $made tables were made" >&2; exit 1; }
echo "static: $made tables and figures without a system around them"

#!/usr/bin/env bash
# Completions of the command line in the shells themselves: each loads the script, and bash and fish are asked what may follow.
# Usage: completions.sh PROGRAM; bash, zsh and fish have to be there.
set -euo pipefail
program=$(realpath "$1")
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
ln -s "$program" "$place/edifice"
export PATH="$place:$PATH" HOME="$place"
for shell in bash zsh fish; do edifice completions "$shell" > "$place/$shell"; done
ask='COMP_WORDS=(edifice facade co); COMP_CWORD=2; _edifice edifice co facade; printf "%s\n" "${COMPREPLY[@]}"'
bash --norc -c "source '$place/bash'; $ask" | grep -qx compare
# zsh: the function is defined and registered for the command.
zsh -f -c "autoload -U compinit && compinit -u && source '$place/zsh' && [[ \${_comps[edifice]} == _edifice ]] && whence -w _edifice" | grep -q function
fish --no-config -c "source '$place/fish'; complete -C 'edifice facade co'" | cut -f 1 | grep -qx compare
echo 'completions: bash, zsh and fish load them'

#!/usr/bin/env python3
"""Mutation testing of a random sample (needs `cargo install cargo-mutants --locked`).

    tests/external/mutants.py GROUP NUMBER [--seed S] [--out DIR] [--survivors] --in TREE

GROUP is `proofs` (grammar bounds, cost and derivation of grammars, elimination, expectation maximization, exact solids) or
`rest` (every other file of the library's crates). The sample is the first NUMBER mutants of the group after a shuffle with the
seed, so that a larger number holds a smaller one. Each crate's mutants are judged by the crate's own tests
(`.cargo/mutants.toml`); with `--survivors` those that they missed are judged by the programs at the root that test the crate
(`AT_THE_ROOT`) as well. What is left is written to DIR/missed.txt. Mutants run in
TREE, a clean copy of the repository that is changed in place; outcomes that DIR holds already are kept, so that a run that was
stopped goes on.
"""

import argparse
import json
import pathlib
import random
import re
import subprocess
import sys

PROOFS = re.compile(
    r"src/methods/facade_grammar/lagrangian/"
    r"|src/grammar/(cost|derive|evaluate|rule|weights)\.rs"
    r"|src/model/(elimination/|em\.rs|hierarchy/(fit|infer|learn)\.rs|network/(expect|learn)\.rs"
    r"|network/structure/incomplete\.rs|gmm/(block|missing)\.rs)"
    r"|src/shape/solid/"
)
# The command line, the studio and the experiments are judged end to end.
ELSEWHERE = re.compile(r"src/(cli|studio|editing)/|experiments/|datasets/|src/main\.rs")
# Programs in `tests/` of the root that judge survivors of a crate.
AT_THE_ROOT = {
    "edifice-model": ["model"],
    "edifice-grammar": ["facade_grammar", "generic"],
    "edifice-facade-grammar": ["facade_grammar"],
    "edifice-shape": ["generic", "city_proceduralization"],
    "edifice-layout": ["generic", "facade_grammar"],
    "edifice-io": ["generic"],
    "edifice-io-city": ["city_proceduralization"],
    "edifice-structure-completion": ["structure_completion"],
    "edifice-procedural-logic": ["procedural_logic"],
    "edifice-building-exteriors": ["building_exteriors"],
    "edifice-city-proceduralization": ["city_proceduralization"],
}
KINDS = {"CaughtMutant": "caught", "MissedMutant": "missed", "Unviable": "unviable", "Timeout": "timeout"}


def sample(tree, out, group, number, seed):
    """The names of the first mutants of the group in an order drawn by the seed, with their crates."""
    kept = out / f"list-{subprocess.check_output(['git', 'rev-parse', 'HEAD'], cwd=tree, text=True).strip()}.json"
    if not kept.exists():
        command = ["cargo", "mutants", "--workspace", "--list", "--json"]
        kept.write_bytes(subprocess.run(command, cwd=tree, check=True, stdout=subprocess.PIPE).stdout)
    mutants = [m for m in json.loads(kept.read_text()) if bool(PROOFS.match(m["file"])) == (group == "proofs")]
    mutants = sorted((m["name"], m["package"]) for m in mutants if not ELSEWHERE.match(m["file"]))
    random.Random(seed).shuffle(mutants)
    print(f"{group}: {min(number, len(mutants))} of {len(mutants)} mutants, seed {seed}", file=sys.stderr)
    return mutants[:number]


def outcomes(out):
    """What became of each mutant so far: its name, its kind, the seconds it took. Survivors' folders sort last."""
    found = {}
    for path in sorted(out.glob("*/mutants.out/outcomes.json")):
        for outcome in json.loads(path.read_text())["outcomes"]:
            if outcome["summary"] in KINDS:
                seconds = sum(phase["duration"] for phase in outcome["phase_results"])
                found[outcome["scenario"]["Mutant"]["name"]] = (KINDS[outcome["summary"]], seconds)
    return found


def run(tree, out, package, names, survivors=False):
    """Runs one crate's mutants; a folder of its own, so that nothing of an earlier run is lost."""
    stem = f"zz-{package}" if survivors else package
    folder = out / f"{stem}-{len(list(out.glob(stem + '-*')))}"
    folder.mkdir(parents=True)
    command = ["cargo", "mutants", "--in-place", "--package", package, "--output", folder, "--no-times", "--colors=never"]
    for name in names:
        command += ["--re", f"^{re.escape(name)}$"]
    # Mutants that delete a field of a struct pass every `--re` (cargo-mutants 27.1): only the files of the sample are asked.
    for file in sorted({name.split(":")[0] for name in names}):
        command += ["--file", file]
    if survivors:
        programs = AT_THE_ROOT.get(package, ["generic"])
        # Not the arguments of the crate's own tests.
        command += ["--config", "/dev/null", "--test-package", "edifice", "--"] + [word for p in programs for word in ("--test", p)]
    subprocess.run(command, cwd=tree, check=False)


def main():
    """Runs what is missing of the sample and prints a row of the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("group", choices=["proofs", "rest"])
    parser.add_argument("number", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("target/mutants"))
    parser.add_argument("--in", dest="tree", type=pathlib.Path, required=True)
    parser.add_argument("--survivors", action="store_true", help="judge what unit tests missed by the tests at the root")
    parser.add_argument("--chunk", type=int, default=25, help="mutants between two writings of the table")
    arguments = parser.parse_args()
    out = arguments.out.resolve() / arguments.group
    out.mkdir(parents=True, exist_ok=True)
    chosen = sample(arguments.tree, out, arguments.group, arguments.number, arguments.seed)
    for start in range(0, len(chosen), arguments.chunk):
        known = outcomes(out)
        packages = {}
        for name, package in chosen[start : start + arguments.chunk]:
            if name not in known:
                packages.setdefault(package, []).append(name)
        for package, names in sorted(packages.items()):
            run(arguments.tree, out, package, names)
        table(arguments.group, chosen, outcomes(out), out)
    if arguments.survivors:
        known, packages = outcomes(out), {}
        for name, package in chosen:
            if known.get(name, ("",))[0] == "missed":
                packages.setdefault(package, []).append(name)
        for package, names in sorted(packages.items()):
            run(arguments.tree, out, package, names, survivors=True)
        table(arguments.group, chosen, outcomes(out), out)


def table(group, chosen, known, out):
    """One row: how many ran, how they ended, and how long they took. Unviable mutants do not compile and count for nothing."""
    ran = [(name, *known[name]) for name, _ in chosen if name in known]
    count = {kind: sum(k == kind for _, k, _ in ran) for kind in KINDS.values()}
    viable = len(ran) - count["unviable"]
    caught = count["caught"] + count["timeout"]
    share = 100 * caught / viable if viable else 0
    row = [group, len(ran), *(count[k] for k in KINDS.values()), f"{share:.0f} %", f"{sum(s for *_, s in ran):.0f}"]
    print("| group | ran | caught | missed | unviable | timeout | of the viable | seconds |")
    print("| " + " | ".join(map(str, row)) + " |", flush=True)
    (out / "missed.txt").write_text("".join(f"{name}\n" for name, kind, _ in ran if kind == "missed"))


if __name__ == "__main__":
    main()

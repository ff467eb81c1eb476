#!/usr/bin/env python3
"""Mutation testing of a random sample by every test of the workspace.

    tests/external/mutants.py --in TREE --out DIR [--proofs 200] [--rest 200] [--seed S]

Needs `cargo install cargo-mutants --locked` and `pip install tree-sitter tree-sitter-rust`. The groups are `proofs` (grammar
bounds, cost and derivation of grammars, elimination, expectation maximization, exact solids) and `rest` (every other file of
the library's crates). A group's sample is its first mutants after a shuffle with the seed, so that a larger number holds a
smaller one.

All mutants are written into TREE, a clean copy of the repository that is changed in place, each behind a switch
(`mutant_schemata.py`), and built once. Then every test runs in a process of its own without a mutant, which tells its time and
the mutants that it comes past; then each mutant is judged by the tests that come past it, those of its own crate first and the
quick ones before the slow ones, until one of them fails twice; tests of more than a minute do not judge. Mutants that do not compile are `unviable`; those that no
switch can express, as in constants, are judged by the tests of their crate after a build of their own.

DIR keeps outcomes as they come, so that a run that was stopped goes on: `build.json`, `tests.json`, `outcomes.jsonl`; what no
test caught is written to `missed.txt` with the number of tests that came past.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time

import mutant_schemata

PROOFS = re.compile(
    r"src/methods/facade_grammar/lagrangian/"
    r"|src/grammar/(cost|derive|evaluate|rule|weights)\.rs"
    r"|src/model/(elimination/|em\.rs|hierarchy/(fit|infer|learn)\.rs|network/(expect|learn)\.rs"
    r"|network/structure/incomplete\.rs|gmm/(block|missing)\.rs)"
    r"|src/shape/solid/"
)
# The command line, the studio and the experiments are not drawn: they call what is.
ELSEWHERE = re.compile(r"src/(cli|studio|editing)/|experiments/|datasets/|src/main\.rs")
JOBS = 2
# Of one process; a mutant of elimination took 14 GB.
MEMORY = 12 << 30


def call(command, tree, **more):
    """Runs a command in the tree and returns what it printed."""
    return subprocess.run(command, cwd=tree, check=True, stdout=subprocess.PIPE, text=True, **more).stdout


def sample(tree, numbers, seed):
    """The chosen mutants by number, each with its group."""
    listed = json.loads(call(["cargo", "mutants", "--workspace", "--list", "--json"], tree))
    chosen = []
    for group, most in numbers.items():
        of_group = [m for m in listed if bool(PROOFS.match(m["file"])) == (group == "proofs") and not ELSEWHERE.match(m["file"])]
        of_group.sort(key=lambda m: (m["name"], m["package"]))
        random.Random(seed).shuffle(of_group)
        print(f"{group}: {min(most, len(of_group))} of {len(of_group)} mutants, seed {seed}", file=sys.stderr)
        chosen += [m | {"group": group} for m in of_group[:most]]
    return dict(enumerate(chosen))


def root_files(tree):
    """The root file of each package's library."""
    packages = json.loads(call(["cargo", "metadata", "--no-deps", "--format-version", "1"], tree))["packages"]
    return {p["name"]: t["src_path"] for p in packages for t in p["targets"] if "lib" in t["kind"]}


def restore(tree):
    """Takes back all changes of the tree."""
    subprocess.run(["git", "checkout", "--quiet", "--", "."], cwd=tree, check=True)


def compile_errors(tree, command):
    """The primary places (file, line) of the errors of a build."""
    done = subprocess.run([*command, "--message-format", "json"], cwd=tree, check=False, stdout=subprocess.PIPE, text=True)
    places = set()
    for line in done.stdout.splitlines():
        told = json.loads(line)
        if told["reason"] == "compiler-message" and told["message"]["level"] == "error":
            for span in (s for s in told["message"]["spans"] if s["is_primary"]):
                # A macro's own text is elsewhere; where it is called is what counts.
                while span["expansion"]:
                    span = span["expansion"]["span"]
                places.add((span["file_name"], span["line_start"]))
    if done.returncode != 0 and not places:
        sys.exit("the tree does not build, and not because of a mutant")
    return places


def switch_all(tree, mutants):
    """Instruments the tree with all mutants that compile as switches; returns the numbers of the others."""
    roots, left_out = root_files(tree), set()
    while True:
        restore(tree)
        tried = {n: m for n, m in mutants.items() if n not in left_out}
        left_out |= set(mutant_schemata.instrument(tree, tried, roots))
        places = compile_errors(tree, ["cargo", "check", "--workspace", "--keep-going"])
        if not places:
            return left_out
        wrong = set()
        for file, line in places:
            lines = pathlib.Path(tree, file).read_text().split("\n")
            near = [(abs(line - 1 - at), int(n)) for at, text in enumerate(lines) for n in re.findall(r"crate::mutant\((\d+)\)", text)]
            if not near:
                sys.exit(f"an error in {file}:{line}, which holds no mutant")
            wrong |= {n for distance, n in near if distance == min(near)[0]}
        print(f"{len(wrong)} mutants do not compile as switches", file=sys.stderr)
        left_out |= wrong


def programs(tree):
    """The test programs: their package, its folder and the built file."""
    told = call(["cargo", "test", "--workspace", "--no-run", "--tests", "--message-format", "json"], tree)
    found = []
    for line in map(json.loads, told.splitlines()):
        if line["reason"] == "compiler-artifact" and line["profile"]["test"] and line["executable"]:
            folder = pathlib.Path(line["manifest_path"]).parent
            package = re.split(r"[#@]", line["package_id"].rsplit("/", 1)[-1])
            found.append((package[-2] if len(package) > 2 else line["target"]["name"], str(folder), line["executable"]))
    return found


def one_test(test, environment, seconds):
    """Runs one test in a process of its own; says whether it passed in time, and its seconds."""
    program, folder, name = test
    scratch = tempfile.mkdtemp(prefix="mutants-")
    limit = lambda: (resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY)), os.setsid())
    start = time.monotonic()
    process = subprocess.Popen(
        [program, "--exact", name, "--test-threads=1"],
        cwd=folder,
        env=os.environ | {"TMPDIR": scratch, "CARGO": "cargo", "CARGO_MANIFEST_DIR": folder} | environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        preexec_fn=limit,
    )
    try:
        passed = process.wait(seconds) == 0
    except subprocess.TimeoutExpired:
        passed = False
    try:
        os.killpg(process.pid, 9)
    except ProcessLookupError:
        pass
    process.wait()
    shutil.rmtree(scratch, ignore_errors=True)
    return passed, time.monotonic() - start


def baseline(tree, out):
    """Every test without a mutant: its package, whether it passed, its seconds, the mutants that it reached."""
    kept = out / "tests.json"
    if kept.exists():
        return json.loads(kept.read_text())
    tests = []
    for package, folder, program in programs(tree):
        listed = call([program, "--list", "--format", "terse"], folder)
        names = [line.removesuffix(": test") for line in listed.splitlines() if line.endswith(": test")]
        ignored = call([program, "--list", "--format", "terse", "--ignored"], folder).splitlines()
        tests += [{"package": package, "test": [program, folder, n]} for n in names if f"{n}: test" not in ignored]
    print(f"{len(tests)} tests", file=sys.stderr)

    def run(numbered):
        number, test = numbered
        log = out / f"reached-{number}"
        log.unlink(missing_ok=True)
        passed, seconds = one_test(test["test"], {"EDIFICE_MUTANTS_REACHED": str(log)}, 900)
        reached = sorted({int(n) for n in log.read_text().split()}) if log.exists() else []
        log.unlink(missing_ok=True)
        return test | {"passed": passed, "seconds": seconds, "reached": reached}

    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        tests = list(pool.map(run, enumerate(tests)))
    kept.write_text(json.dumps(tests))
    return tests


def judge(number, mutant, tests, locks):
    """What becomes of one mutant under the tests that come past it."""
    past = [t for t in tests if number in t["reached"]]
    past.sort(key=lambda t: (t["seconds"] > 10, t["package"] != mutant["package"], t["seconds"]))
    spent = 0.0
    for test in past:
        limit = 5 * test["seconds"] + 30
        with locks[tuple(test["test"])]:
            # Twice, so that no test of times catches a mutant because the machine was busy.
            for _ in range(2):
                passed, seconds = one_test(test["test"], {"EDIFICE_MUTANT": str(number)}, limit)
                spent += seconds
                if passed:
                    break
        if not passed:
            outcome = "timeout" if seconds >= limit else "caught"
            return {"outcome": outcome, "by": test["test"][2], "past": len(past), "seconds": spent}
    return {"outcome": "missed", "past": len(past), "seconds": spent}


def alone(tree, mutant):
    """One mutant that no switch expresses: a build of its own, and the tests of its crate."""
    restore(tree)
    patch = mutant["diff"].replace("--- ", "--- a/", 1).replace(f"+++ {mutant['diff'].splitlines()[1][4:]}", f"+++ b/{mutant['file']}", 1)
    subprocess.run(["git", "apply", "--unidiff-zero", "-"], cwd=tree, check=True, input=patch, text=True)
    silent = {"cwd": tree, "check": False, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    start = time.monotonic()
    try:
        if subprocess.run(["cargo", "check", "-p", mutant["package"]], **silent).returncode != 0:
            return {"outcome": "unviable", "seconds": time.monotonic() - start}
        passed = subprocess.run(["cargo", "test", "-p", mutant["package"], "--tests"], **silent, timeout=900).returncode == 0
        return {"outcome": "missed" if passed else "caught", "by": "tests of the crate", "seconds": time.monotonic() - start}
    except subprocess.TimeoutExpired:
        return {"outcome": "timeout", "seconds": time.monotonic() - start}
    finally:
        restore(tree)


def main():
    """Builds, runs what is missing and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--proofs", type=int, default=200, help="mutants of the proofs")
    parser.add_argument("--rest", type=int, default=200, help="mutants of everything else")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--longest", type=float, default=60.0, help="seconds beyond which a test does not judge")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--in", dest="tree", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    tree, out = arguments.tree.resolve(), arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    restore(tree)
    mutants = sample(tree, {"proofs": arguments.proofs, "rest": arguments.rest}, arguments.seed)
    known_switches, log = out / "build.json", out / "outcomes.jsonl"
    if known_switches.exists():
        left_out = set(json.loads(known_switches.read_text()))
        mutant_schemata.instrument(tree, {n: m for n, m in mutants.items() if n not in left_out}, root_files(tree))
    else:
        left_out = switch_all(tree, mutants)
    known_switches.write_text(json.dumps(sorted(left_out)))
    tests = baseline(tree, out)
    print(f"not passed without a mutant: {[t['test'][2] for t in tests if not t['passed']]}", file=sys.stderr)
    tests = [t for t in tests if t["passed"] and t["seconds"] <= arguments.longest]
    known = {o["number"]: o for o in map(json.loads, log.read_text().splitlines())} if log.exists() else {}
    locks = {tuple(t["test"]): threading.Lock() for t in tests}

    def note(number, outcome):
        known[number] = {"number": number, "name": mutants[number]["name"], "group": mutants[number]["group"], **outcome}
        with log.open("a") as file:
            file.write(json.dumps(known[number]) + "\n")

    todo = [n for n in mutants if n not in known and n not in left_out]
    todo.sort(key=lambda n: sum(t["seconds"] for t in tests if n in t["reached"]))
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        running = {pool.submit(judge, n, mutants[n], tests, locks): n for n in todo}
        for future in concurrent.futures.as_completed(running):
            note(running[future], future.result())
    for number in sorted(left_out - set(known)):
        note(number, alone(tree, mutants[number]))
    table(mutants, known, out)


def table(mutants, known, out):
    """A row for each group: how many ran, how they ended, and how long they took. Unviable mutants count for nothing."""
    print("| group | ran | caught | missed | unviable | timeout | of the viable | seconds |\n" + "| --- " * 8 + "|")
    for group in ("proofs", "rest"):
        ran = [o for o in known.values() if o["group"] == group]
        count = {kind: sum(o["outcome"] == kind for o in ran) for kind in ("caught", "missed", "unviable", "timeout")}
        viable = len(ran) - count["unviable"]
        share = 100 * (count["caught"] + count["timeout"]) / viable if viable else 0
        seconds = sum(o["seconds"] for o in ran)
        print("| " + " | ".join(map(str, [group, len(ran), *count.values(), f"{share:.0f} %", f"{seconds:.0f}"])) + " |")
    missed = [o for o in known.values() if o["outcome"] == "missed"]
    (out / "missed.txt").write_text("".join(f"{o['group']} {o.get('past', '?')} {o['name']}\n" for o in missed))


if __name__ == "__main__":
    main()

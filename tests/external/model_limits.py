#!/usr/bin/env python3
"""Time limits and interrupts of `model learn`, `evaluate` and `structure` on four shapes of tables.

usage: model_limits.py EDIFICE [--limit 10] [--commands learn,evaluate,structure] [--shapes 200x500,...]

Tables of 200 x 500, 800 x 60, 100,000 x 12 and 1,000,000 x 12 are drawn with a seed: five groups of rows, three columns in ten
categories, the others numbers. Each command runs once with `--time-limit`, which must end within the limit + 2 s, and is
interrupted (SIGINT) at an eighth, a half and all of the limit, which must end it within 2 s. Exit status 1 if any was later.
Needs a release build, and NumPy.
"""
import argparse, os, signal, subprocess, sys, tempfile, time

import numpy as np

SHAPES = {"200x500": (200, 500), "800x60": (800, 60), "100000x12": (100_000, 12), "1000000x12": (1_000_000, 12)}
SLACK = 2.0
# Done; ended by a second interrupt; interrupted while the table was read.
ENDED = (0, 130, -signal.SIGINT)


def table(path, rows, columns):
    rng = np.random.default_rng(5)
    group, cells = rng.integers(0, 5, rows), []
    for _ in range(columns):
        if rng.random() < 0.3:
            shares = rng.dirichlet(np.ones(4), 5)
            drawn = (shares[group].cumsum(1) > rng.random((rows, 1))).argmax(1)
            cells.append(np.array(list("abcd"))[drawn])
        else:
            mean, deviation = rng.normal(0, 3, 5), rng.uniform(0.5, 1.5, 5)
            cells.append(np.char.mod("%.4f", mean[group] + deviation[group] * rng.normal(size=rows)))
    with open(path, "w") as out:
        out.write(",".join(f"c{i}" for i in range(columns)) + "\n")
        out.writelines(",".join(row) + "\n" for row in zip(*cells))


def run(command, interrupt=None):
    """Status, seconds in all, and seconds after the interrupt."""
    start = time.time()
    # A shell that runs this in the background ignores interrupts, and so would the program until it heeds them.
    heed = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, preexec_fn=heed)
    if interrupt is not None:
        try:
            process.wait(interrupt)
            return process.returncode, time.time() - start, 0.0
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGINT)
    sent = time.time()
    _, complaint = process.communicate()
    if process.returncode not in ENDED:
        print(complaint.decode()[-300:], file=sys.stderr)
    return process.returncode, time.time() - start, time.time() - sent


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("edifice")
    parser.add_argument("--limit", type=float, default=10)
    parser.add_argument("--commands", default="learn,evaluate,structure")
    parser.add_argument("--shapes", default=",".join(SHAPES))
    asked = parser.parse_args()
    late = 0
    print("| shape | command | time limit | ends after (s) | after an interrupt at 1/8, 1/2, 1 of it (s) |")
    print("| --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for shape in asked.shapes.split(","):
            path = os.path.join(folder, shape + ".csv")
            table(path, *SHAPES[shape])
            for name in asked.commands.split(","):
                command = [asked.edifice, "model", name, path]
                if name != "evaluate":
                    command += ["-o", os.path.join(folder, "out.json")]
                status, seconds, _ = run(command + ["--time-limit", str(asked.limit)])
                late += seconds > asked.limit + SLACK or status not in ENDED
                after = []
                for share in (1 / 8, 1 / 2, 1):
                    status, _, wait = run(command, share * asked.limit)
                    after.append(wait)
                    late += wait > SLACK or status not in ENDED
                waits = ", ".join(f"{wait:.2f}" for wait in after)
                print(f"| {shape} | {name} | {asked.limit:g} s | {seconds:.1f} | {waits} |", flush=True)
    if late:
        sys.exit(f"{late} runs were late or failed")


if __name__ == "__main__":
    main()

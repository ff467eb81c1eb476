#!/usr/bin/env python3
"""Mutated cities and city grammars through the program, under a limit of memory: no abort, no panic, none slow.

usage: city_mutations.py EDIFICE [--cities 2000] [--grammars 2000] [--seed 1] [--keep FOLDER]

Files that are shipped or made here are mutated with a seed: bytes changed, cut, doubled; numbers replaced. Each runs under
3,000,000 KiB of address space and 20 s of processor time. A run fails if the program is killed by a signal, panics (status
101), or takes its 20 s. The failing files are kept in FOLDER. Exit status 1 if any failed.
"""
import argparse, json, os, random, re, resource, shutil, subprocess, sys, tempfile

REPO = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
MEMORY = 3_000_000 * 1024
SECONDS = 20
WALL = 300
NUMBERS = ["0", "-1", "1e308", "-1e18", "1e9", "4294967296", "0.0000001", "NaN", "99999999999999999999", "1e7", "-0", "\"x\"", "null"]
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")


def limited():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 1))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(command):
    try:
        done = subprocess.run(command, preexec_fn=limited, capture_output=True, timeout=WALL)
    except subprocess.TimeoutExpired:
        return "no end", b""
    if done.returncode < 0:
        return f"signal {-done.returncode}", done.stderr
    if done.returncode == 101 or b"panicked" in done.stderr:
        return "panic", done.stderr
    return None, done.stderr


def boxes(path, named=True):
    """Six houses as OBJ."""
    lines, count = [], 0
    for b in range(6):
        x, y, w, d, h = 20.0 * b, 3.0 * b, 8.0 + b, 10.0, 6.0 + 2 * b
        if named:
            lines.append(f"o house{b}")
        for z in (0.0, h):
            for u, v in ((0, 0), (w, 0), (w, d), (0, d)):
                lines.append(f"v {x + u} {y + v} {z}")
        lines.append(f"v {x + w / 2} {y + d / 2} {h + 3}")
        i = count + 1
        for face in ((0, 3, 2, 1), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 8), (5, 6, 8), (6, 7, 8), (7, 4, 8)):
            lines.append("f " + " ".join(str(i + k) for k in face))
        count += 9
    with open(path, "w") as out:
        out.write("\n".join(lines) + "\n")


def mutated(data, text, rng):
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 4, 16])):
        if not data:
            break
        kind = rng.randrange(6 if text else 4)
        at = rng.randrange(len(data))
        if kind == 0:
            data[at] = rng.randrange(256)
        elif kind == 1:
            data[at] ^= 1 << rng.randrange(8)
        elif kind == 2:
            end = min(len(data), at + rng.choice([1, 4, 64, 1 << 20]))
            del data[at:end]
        elif kind == 3:
            end = min(len(data), at + rng.choice([4, 64, 256]))
            data[at:at] = data[at:end]
        else:
            found = list(NUMBER.finditer(bytes(data)))
            if found:
                m = rng.choice(found)
                data[m.start():m.end()] = rng.choice(NUMBERS).encode()
    return bytes(data)


def refit(data):
    """A compact grammar with the checksum of its bytes, so that the mutation is met behind it."""
    import zlib
    if len(data) > 10 and data[:4] == b"EdCG":
        return data[:6] + (zlib.crc32(data[10:])).to_bytes(4, "little") + data[10:]
    return data


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("edifice")
    parser.add_argument("--cities", type=int, default=2000)
    parser.add_argument("--grammars", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", default=None)
    args = parser.parse_args()
    rng = random.Random(args.seed)
    edifice = os.path.abspath(args.edifice)
    folder = tempfile.mkdtemp()
    at = lambda name: os.path.join(folder, name)
    boxes(at("a.obj"))
    boxes(at("heap.obj"), named=False)
    for command in (
        ["convert", at("a.obj"), "-o", at("a.city.json")],
        ["proceduralize", at("a.obj"), "-o", at("a.city-grammar.json"), "--glb", at("a.glb")],
        ["proceduralize", at("a.obj"), "-o", at("a.city-grammar.bin"), "--templates", "2"],
    ):
        done = subprocess.run([edifice, "city"] + command, capture_output=True)
        if done.returncode:
            sys.exit(done.stderr.decode())
    town = os.path.join(REPO, "datasets/city_proceduralization/town.city-grammar.json")
    for command in (
        ["derive", town, "--compress", "-o", at("small.glb")],
        ["tiles", town, "--compress", "--instances", "60", "-o", at("tiles")],
    ):
        subprocess.run([edifice, "city"] + command, capture_output=True, check=True)
    # Its mutants stand among its tiles.
    shutil.move(at("tiles/tileset.json"), at("tileset.json"))
    gml = os.path.join(REPO, "fuzz/seeds/city_gml/wall.gml")
    cities = [at("a.obj"), at("heap.obj"), at("a.city.json"), at("a.glb"), gml, at("small.glb"), at("tileset.json")]
    grammars = [at("a.city-grammar.json"), at("a.city-grammar.bin"), at("a.city-grammar.bin"), town]
    failures = []
    slowest = 0.0
    for kind, count, files in (("city", args.cities, cities), ("grammar", args.grammars, grammars)):
        for i in range(count):
            source = files[i % len(files)]
            data = open(source, "rb").read()
            name = os.path.basename(source)
            data = mutated(data, not name.endswith((".bin", ".glb")), rng)
            if name.endswith(".bin"):
                data = refit(data)
            path = at("tiles/" + name if name == "tileset.json" else "mutant-" + name)
            with open(path, "wb") as out:
                out.write(data)
            if kind == "city":
                commands = [
                    ["proceduralize", path, "-o", at("o.city-grammar.bin")],
                    ["draw", path, "-o", at("o.png"), "--size", "64x48"],
                    ["compare", path, at("a.obj")],
                    ["proceduralize", path, "--mode", "paper", "-o", at("o.city-grammar.json")],
                ]
                command = commands[(i // len(files)) % len(commands)]
            else:
                commands = [
                    ["derive", path, "-o", at("o.glb")],
                    ["synthesize", path, "--polygon", "0,0,60,0,60,60,0,60", "-o", at("o.obj")],
                    ["draw", path, "-o", at("o.png"), "--size", "64x48"],
                    ["show", path],
                    ["compare", path, at("a.obj")],
                ]
                command = commands[(i // len(files)) % len(commands)]
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            failed, said = run([edifice, "city"] + command)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            taken = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            slowest = max(slowest, taken)
            if failed:
                failures.append(f"{kind} {i} ({name}, {command[0]}): {failed}: {said[-200:]!r}")
                print(failures[-1], flush=True)
                if args.keep:
                    os.makedirs(args.keep, exist_ok=True)
                    shutil.copy(path, os.path.join(args.keep, f"{kind}-{i}-{name}"))
    shutil.rmtree(folder)
    print(json.dumps({"cities": args.cities, "grammars": args.grammars, "seed": args.seed,
                      "failures": len(failures), "slowest_cpu_seconds": round(slowest, 2)}))
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()

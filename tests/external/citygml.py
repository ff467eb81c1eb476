#!/usr/bin/env python3
"""An independent reader of CityGML 2 and 3 (lxml and NumPy): counts of buildings, their volumes and the EPSG code, against those of
`edifice city proceduralize --templates all` and `edifice city convert`-like output (CityJSON).

usage: tests/external/citygml.py EDIFICE FILE...
It builds whole trees in memory and computes volumes by fans of polygons, without triangulating; holes are subtracted by their
orientation. Exit code 1 when a count, a code or a volume (by more than 0.1 per cent) differs."""
import json, math, lzma, re, subprocess, sys, tempfile, pathlib
import numpy as np
from lxml import etree

GEOGRAPHIC = {4326, 4979, 4258, 6668, 6697}
LINK = "{http://www.w3.org/1999/xlink}href"


def local(e):
    return etree.QName(e).localname if isinstance(e.tag, str) else ""


def identifier(e):
    return next((v for k, v in e.attrib.items() if k.endswith("}id")), None)


def ring(e):
    text = " ".join((c.text or "") for c in e if local(c) in ("posList", "pos"))
    return np.array(text.split(), float).reshape(-1, 3)


def code(root):
    for e in root.iter():
        name = e.get("srsName") if isinstance(e.tag, str) else None
        if name:
            found = re.search(r"EPSG[:/]+(?:[\d.]+[:/])?(\d+)", name, re.I)
            if found:
                return int(found.group(1))
            utm = re.search(r"ETRS89_UTM(\d\d)", name)
            if utm:
                return 25800 + int(utm.group(1))
    return None


def signed(points, origin):
    """Six times the signed volume of the cone over a ring, as a fan."""
    p = points - origin
    return float(np.einsum("ij,ij->i", np.cross(p[1:-1], p[2:]), np.repeat(p[:1], len(p) - 2, 0)).sum())


def read(path):
    data = lzma.open(path).read() if str(path).endswith(".xz") else open(path, "rb").read()
    root = etree.fromstring(data, etree.XMLParser(huge_tree=True))
    epsg = code(root)
    named = {identifier(e): e for e in root.iter() if isinstance(e.tag, str) and identifier(e)}
    project = lambda p: p
    if epsg in GEOGRAPHIC:
        first = next(ring(e) for e in root.iter() if local(e) == "LinearRing")[0]
        # WGS 84, metres of a degree by the series of the meridian and the parallel.
        f = math.radians(first[0])
        north = 111132.92 - 559.82 * math.cos(2 * f) + 1.175 * math.cos(4 * f) - 0.0023 * math.cos(6 * f)
        east = 111412.84 * math.cos(f) - 93.5 * math.cos(3 * f) + 0.118 * math.cos(5 * f)
        project = lambda p: np.c_[(p[:, 1] - first[1]) * east, (p[:, 0] - first[0]) * north, p[:, 2]]

    def polygons(e):
        for c in e.iter():
            if local(c) in ("Polygon", "Triangle"):
                yield c
            elif c.get(LINK) and local(c) in ("surfaceMember", "baseSurface", "exterior"):
                target = named.get(c.get(LINK).lstrip("#"))
                if target is not None:
                    yield from polygons(target)

    out = {}
    for member in (e for e in root.iter() if local(e) == "Building"):
        total = 0.0
        parts = [member] + [e for e in member.iter() if local(e) == "BuildingPart"]
        for part in parts:
            own = {}
            stack = list(part)
            while stack:
                e = stack.pop()
                if local(e) == "BuildingPart":
                    continue
                m = re.fullmatch(r"lod([123])(Solid|MultiSurface|Geometry)", local(e))
                if m:
                    own.setdefault((int(m.group(1)), m.group(2) == "Solid"), []).append(e)
                    continue
                stack.extend(e)
            if not own:
                continue
            level = max(k[0] for k in own)
            chosen = own.get((level, True)) or own[(level, False)]
            rings = [[project(ring(r)) for r in p.iter() if local(r) == "LinearRing"] for g in chosen for p in polygons(g)]
            corners = np.vstack([r for p in rings for r in p])
            origin = corners.min(0)
            total += sum(signed(r, origin) for p in rings for r in p) / 6
        out[identifier(member)] = abs(total)
    return epsg, out


def volumes(path):
    """Volumes of the buildings of a CityJSON file."""
    city = json.load(open(path))
    t = city["transform"]
    v = np.array(city["vertices"], float) * t["scale"]
    out = {}
    for name, o in city["CityObjects"].items():
        tri = np.array([s[0] for g in o["geometry"] for s in g["boundaries"]])
        p = v[tri]
        p = p - p.reshape(-1, 3).min(0)
        out[name] = abs(float(np.einsum("ij,ij->i", np.cross(p[:, 0], p[:, 1]), p[:, 2]).sum() / 6))
    system = city.get("metadata", {}).get("referenceSystem", "")
    found = re.search(r"(\d+)$", system)
    return (int(found.group(1)) if found else None), out


def main():
    edifice, files = sys.argv[1], sys.argv[2:]
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "a.city.json"
        for path in files:
            subprocess.run([edifice, "city", "convert", path, "-o", str(out)], check=True)
            (epsg, ours), (theirs_epsg, theirs) = volumes(out), read(path)
            worst = max((abs(ours.get(k, 0) - v) / max(v, 1e-9) for k, v in theirs.items() if v > 1), default=0)
            same = set(ours) == set(theirs)
            ok = same and epsg == theirs_epsg and worst <= 1e-3
            wrong += not ok
            print(f"{pathlib.Path(path).name}: {len(ours)} of {len(theirs)} buildings, EPSG {epsg} and {theirs_epsg}, "
                  f"volumes {sum(ours.values()):.1f} and {sum(theirs.values()):.1f} m3, worst {100 * worst:.4f} %{'' if ok else ': WRONG'}")
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()

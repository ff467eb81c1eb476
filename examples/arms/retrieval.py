"""Retrieval: the distance of the numbers of columns and rows, and of the shares of the labels."""
import csv, json, pathlib, sys

queries, output, folder = [row[0] for row in list(csv.reader(open(sys.argv[1])))[1:]], sys.argv[2], pathlib.Path(sys.argv[3])
features = {}
for path in sorted(folder.glob("*.grid.json")):
    grid = json.loads(path.read_text())
    counts = {label: 0 for label in grid["labels"]}
    for row in grid["rows"]:
        for index in row:
            counts[grid["labels"][index]] += 1
    features[grid["name"]] = dict(counts, columns=len(grid["xs"]), rows=len(grid["ys"]))
distance = lambda a, b: sum(abs(a.get(k, 0) - b.get(k, 0)) for k in a.keys() | b.keys())
with open(output, "w") as file:
    writer = csv.writer(file)
    writer.writerow(["query", "facade", "distance"])
    writer.writerows([q, f, distance(features[q], features[f])] for q in queries for f in features if f != q)

"""Density of a table: independent Gaussians, one a column."""
import csv, math, statistics, sys

rows_of = lambda path: [list(map(float, row)) for row in list(csv.reader(open(path)))[1:]]
asked, output, learn = rows_of(sys.argv[1]), sys.argv[2], rows_of(sys.argv[3])
columns = [(statistics.fmean(c), statistics.pstdev(c) or 1.0) for c in zip(*learn)]
log = lambda row: sum(-0.5 * ((x - m) / s) ** 2 - math.log(s) - 0.5 * math.log(2 * math.pi) for x, (m, s) in zip(row, columns))
with open(output, "w") as file:
    print("log_density", *(repr(log(row)) for row in asked), sep="\n", file=file)

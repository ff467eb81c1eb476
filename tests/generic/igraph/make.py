"""Makes graphs.json: random graphs and the modularity of igraph's Girvan-Newman communities on each.

Needs: pip install igraph. Run: python3 make.py > graphs.json
"""
import json
import random

import igraph


def planted(groups, size, inside, outside, rng):
    """A graph of `groups` communities; edges with probability `inside` within, `outside` between."""
    n = groups * size
    pairs = ((a, b) for a in range(n) for b in range(a))
    return n, [(b, a) for a, b in pairs if rng.random() < (inside if a // size == b // size else outside)]


def geometric(n, reach, rng):
    """Points in the unit square, joined within `reach`: like types that stand near each other."""
    points = [(rng.random(), rng.random()) for _ in range(n)]
    near = lambda a, b: (points[a][0] - points[b][0]) ** 2 + (points[a][1] - points[b][1]) ** 2 < reach**2
    return n, [(b, a) for a in range(n) for b in range(a) if near(a, b)]


def main():
    rng = random.Random(2002)
    graphs = [planted(*args, rng) for args in [(3, 8, 0.6, 0.05), (4, 12, 0.5, 0.03), (5, 16, 0.35, 0.02),
                                              (8, 16, 0.3, 0.01), (10, 20, 0.22, 0.005), (1, 40, 0.1, 0.0)]]
    graphs += [geometric(*args, rng) for args in [(30, 0.25), (80, 0.16), (150, 0.12), (220, 0.09)]]
    out = []
    for n, edges in graphs:
        assert len(edges) <= 600, len(edges)
        graph = igraph.Graph(n=n, edges=edges)
        found = graph.community_edge_betweenness(directed=False).as_clustering()
        out.append({"nodes": n, "edges": edges, "communities": len(found), "modularity": found.modularity})
    rows = ",\n".join(json.dumps(row, separators=(",", ":")) for row in out)
    print(f'{{"igraph":"{igraph.__version__}","graphs":[\n{rows}\n]}}')


main()

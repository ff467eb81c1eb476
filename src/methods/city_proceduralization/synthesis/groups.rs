//! Groups of buildings that stand near each other, as they are copied together.

use petgraph::unionfind::UnionFind;
use rustc_hash::FxHashMap;

use super::footprint::CELL;
use super::shape::rotated;
use super::sources::Source;

/// Buildings that stand near each other: blocks with the sheds in their yards, or a single building.
#[derive(Debug)]
pub(super) struct Group {
    pub(super) buildings: Vec<usize>,
    /// The middle of its plan.
    pub(super) middle: [f64; 2],
    /// Square metres of plan.
    pub(super) area: f64,
    /// The direction of its walls, as of [`Source::walls`].
    pub(super) walls: [f64; 2],
    /// The direction of its length: area · (1 - width / length) · exp(2iφ), of the principal axes of its plan.
    pub(super) length: [f64; 2],
}

/// The groups of a city, of the pairs of buildings that are near each other. Buildings without a plan are in none.
pub(super) fn groups(buildings: &[Source], near: &[[usize; 2]]) -> Vec<Group> {
    let mut sets = UnionFind::new(buildings.len());
    for [i, j] in near {
        sets.union(*i, *j);
    }
    // A tower within the walls of its base may be far from them.
    let mut points: Vec<Vec<[f64; 2]>> = Vec::with_capacity(buildings.len());
    let mut owner: FxHashMap<[i64; 2], usize> = FxHashMap::default();
    for (i, b) in buildings.iter().enumerate() {
        let stand = |p| {
            let [x, y] = rotated(p, b.turn);
            [b.at[0] + x, b.at[1] + y]
        };
        let own: Vec<[f64; 2]> = b.footprint.covered().map(stand).collect();
        for p in &own {
            let cell = p.map(|v| (v / CELL).floor() as i64);
            sets.union(i, *owner.entry(cell).or_insert(i));
        }
        points.push(own);
    }
    // Groups are in the order of their first buildings.
    let set = sets.into_labeling();
    let mut place: FxHashMap<usize, usize> = FxHashMap::default();
    let mut members: Vec<Vec<usize>> = Vec::new();
    for i in (0..buildings.len()).filter(|&i| !points[i].is_empty()) {
        let group = *place.entry(set[i]).or_insert(members.len());
        match members.get_mut(group) {
            Some(own) => own.push(i),
            None => members.push(vec![i]),
        }
    }
    let group = |members: Vec<usize>| group(buildings, &points, members);
    members.into_iter().map(group).collect()
}

fn group(buildings: &[Source], points: &[Vec<[f64; 2]>], members: Vec<usize>) -> Group {
    let all = || members.iter().flat_map(|&i| &points[i]);
    let n = all().count() as f64;
    let middle = [0, 1].map(|k| all().map(|p| p[k]).sum::<f64>() / n);
    let [mut xx, mut xy, mut yy] = [0.0; 3];
    for p in all() {
        let [x, y] = [p[0] - middle[0], p[1] - middle[1]];
        xx += x * x / n;
        xy += x * y / n;
        yy += y * y / n;
    }
    // Eigenvalues of a symmetric matrix of two rows.
    let (mean, half) = ((xx + yy) / 2.0, ((xx - yy) / 2.0).hypot(xy));
    let slender = 1.0 - ((mean - half).max(0.0) / (mean + half).max(f64::MIN_POSITIVE)).sqrt();
    let double = xy.atan2((xx - yy) / 2.0);
    Group {
        middle,
        area: n * CELL * CELL,
        walls: [0, 1].map(|k| members.iter().map(|&i| buildings[i].walls[k]).sum()),
        length: [double.cos(), double.sin()].map(|v| v * n * slender),
        buildings: members,
    }
}

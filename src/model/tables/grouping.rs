//! Groups of real columns that move together, from coarse to fine.
//!
//! Groups are joined two at a time, those with the highest mean `|r|` between their columns first (average linkage; r is Pearson's
//! correlation over the rows that have both). What stands at 2, 4, 8, .. groups is returned: each is a split of the one
//! before, and a merge of the one after. That correlations see no curves decides only which groupings are tried.

use std::ops::ControlFlow;

use crate::ModelError;
use crate::hierarchy::{Group, Observer};
use crate::table::{Cell, Table};

/// The groupings of 2, 4, 8, .. groups of real columns, fewer than there are groups; groups of categories stay as they are, at the end. A
/// group that is given is never parted. At most `most` rows are looked at, evenly spread. O(rows d² + m³) for d real columns in
/// m groups; empty where the observer ends it.
///
/// # Errors
/// [`ModelError::Unknown`] for a group of a column that `data` lacks.
pub(super) fn levels(
    data: &Table,
    groups: &[Group],
    most: usize,
    observer: &Observer,
) -> Result<Vec<Vec<Group>>, ModelError> {
    let (mut reals, mut rest) = (Vec::new(), Vec::new());
    for group in groups {
        match group.columns.first() {
            Some(first) if data.column(first)?.categories().is_none() => reals.push(group),
            _ => rest.push(group.clone()),
        }
    }
    let mut columns = Vec::new();
    let mut owner = Vec::new();
    for (g, group) in reals.iter().enumerate() {
        for name in &group.columns {
            columns.push(standard(data, name, most)?);
            owner.push(g);
        }
    }
    // Sums of |r| between the columns of two groups.
    let mut sums = vec![vec![0.0; reals.len()]; reals.len()];
    for (i, a) in columns.iter().enumerate() {
        if observer(None) == ControlFlow::Break(()) {
            return Ok(Vec::new());
        }
        for (j, b) in columns.iter().enumerate().skip(i + 1) {
            let r = correlation(a, b).abs();
            sums[owner[i]][owner[j]] += r;
            sums[owner[j]][owner[i]] += r;
        }
    }
    let mut sets: Vec<Vec<usize>> = (0..reals.len()).map(|g| vec![g]).collect();
    let mut widths: Vec<f64> = reals.iter().map(|g| g.columns.len() as f64).collect();
    let mut found = Vec::new();
    while sets.len() > 2 {
        let (a, b) = nearest(&sums, &widths);
        let gone = sums.swap_remove(b);
        sums.iter_mut().for_each(|row| {
            row.swap_remove(b);
        });
        // The last group now stands in the place of the one that was taken out.
        let last = sums.len();
        let at = |k: usize| if k == b { last } else { k };
        for k in (0..last).filter(|k| *k != a) {
            sums[a][k] += gone[at(k)];
            sums[k][a] = sums[a][k];
        }
        let taken = sets.swap_remove(b);
        sets[a].extend(taken);
        widths[a] += widths.swap_remove(b);
        if sets.len().is_power_of_two() {
            found.push(named(&sets, &reals, &rest));
        }
    }
    found.reverse();
    Ok(found)
}

/// True if joined groups of a table would be dear: more than `few` groups of real columns, more than `small` values in these, and most rows
/// lack one of them.
///
/// # Errors
/// As [`levels`].
pub(super) fn dear(
    data: &Table,
    groups: &[Group],
    small: usize,
    few: usize,
) -> Result<bool, ModelError> {
    let (mut reals, mut columns) = (0, Vec::new());
    for group in groups {
        let own: Result<Vec<_>, _> = group.columns.iter().map(|name| data.column(name)).collect();
        let own = own?;
        if own.first().is_some_and(|c| c.categories().is_none()) {
            reals += 1;
            columns.extend(own);
        }
    }
    let lacks = |row: &usize| columns.iter().any(|c| c.cell(*row) == Cell::Missing);
    let large = reals > few && data.rows() * columns.len() > small;
    Ok(large && 2 * (0..data.rows()).filter(lacks).count() > data.rows())
}

/// The two groups, the first below the second, of the highest mean; of several the first.
fn nearest(sums: &[Vec<f64>], widths: &[f64]) -> (usize, usize) {
    let mut best = (f64::NEG_INFINITY, 0, 1);
    for a in 0..sums.len() {
        for b in a + 1..sums.len() {
            let mean = sums[a][b] / (widths[a] * widths[b]);
            if mean > best.0 {
                best = (mean, a, b);
            }
        }
    }
    (best.1, best.2)
}

/// The groups of some sets, in the order of their first columns; a set of one keeps its name.
fn named(sets: &[Vec<usize>], reals: &[&Group], rest: &[Group]) -> Vec<Group> {
    let mut sets: Vec<Vec<usize>> = sets.to_vec();
    sets.iter_mut().for_each(|set| set.sort_unstable());
    sets.sort();
    let taken: Vec<&str> = reals
        .iter()
        .copied()
        .chain(rest)
        .map(|group| group.name.as_str())
        .collect();
    let mut all = Vec::new();
    for (i, set) in sets.iter().enumerate() {
        if let [one] = set.as_slice() {
            all.push(reals[*one].clone());
            continue;
        }
        let mut name = format!("numbers_{}", i + 1);
        while taken.contains(&name.as_str()) {
            name.push('_');
        }
        let columns = set.iter().flat_map(|&g| reals[g].columns.clone());
        all.push(Group {
            name,
            columns: columns.collect(),
        });
    }
    all.extend(rest.iter().cloned());
    all
}

/// The values of some rows, less their mean and over their deviation; not a number where missing, and where all are equal.
fn standard(data: &Table, name: &str, most: usize) -> Result<Vec<f64>, ModelError> {
    let column = data.column(name)?;
    let step = data.rows().div_ceil(most.max(1)).max(1);
    let cells = (0..data.rows()).step_by(step);
    let mut values: Vec<f64> = cells
        .map(|row| match column.cell(row) {
            Cell::Real(value) => value,
            Cell::Code(_) | Cell::Missing => f64::NAN,
        })
        .collect();
    let seen = || values.iter().filter(|v| !v.is_nan());
    let count = seen().count() as f64;
    let mean = seen().sum::<f64>() / count;
    let deviation = (seen().map(|v| (v - mean).powi(2)).sum::<f64>() / count).sqrt();
    values.iter_mut().for_each(|v| *v = (*v - mean) / deviation);
    values
        .iter_mut()
        .filter(|v| v.is_infinite())
        .for_each(|v| *v = f64::NAN);
    Ok(values)
}

/// Pearson's r of two columns over the rows that have both; 0 where it is not a number.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let (mut n, mut x, mut y, mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(b).filter(|(a, b)| !a.is_nan() && !b.is_nan()) {
        n += 1.0;
        x += a;
        y += b;
        xx += a * a;
        yy += b * b;
        xy += a * b;
    }
    let r = (n * xy - x * y) / ((n * xx - x * x) * (n * yy - y * y)).sqrt();
    if r.is_finite() { r } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;
    use rand::seq::SliceRandom;
    use rand::{Rng, RngExt};
    use std::collections::BTreeSet;

    /// Columns of so many hidden numbers, each copied with noise.
    fn table(copies: &[usize], missing: bool, rng: &mut impl Rng) -> (Table, Vec<Group>) {
        let rows = 300;
        let (mut data, mut groups) = (Table::new(), Vec::new());
        for (h, &count) in copies.iter().enumerate() {
            let hidden: Vec<f64> = (0..rows).map(|_| rng.random()).collect();
            for c in 0..count {
                let name = format!("h{h}_{c}");
                let cells: Vec<Option<f64>> = hidden
                    .iter()
                    .map(|x| {
                        let noise: f64 = rng.random();
                        (!missing || rng.random_range(0..10) > 0).then_some(x + 0.2 * noise)
                    })
                    .collect();
                data = data.real(&name, cells).unwrap();
                groups.push(Group::new(&name, &[&name]));
            }
        }
        (data, groups)
    }

    fn go_on(_: Option<&crate::hierarchy::SearchStep>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    #[test]
    fn copies_are_found_again_in_any_order_with_missing_cells() {
        for seed in 0..20 {
            let mut rng = stream(seed, "grouping", 0);
            let (data, mut groups) = table(&[3, 2, 4, 1], seed % 2 == 1, &mut rng);
            groups.shuffle(&mut rng);
            let found = levels(&data, &groups, 3000, &go_on).unwrap();
            // Ten columns: 2, 4 and 8 groups.
            assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [2, 4, 8]);
            let four: BTreeSet<BTreeSet<&str>> = found[1]
                .iter()
                .map(|g| g.columns.iter().map(|c| &c[..2]).collect())
                .collect();
            let wanted = ["h0", "h1", "h2", "h3"].map(|h| BTreeSet::from([h]));
            assert_eq!(four, BTreeSet::from(wanted));
        }
    }

    #[test]
    fn joined_groups_are_dear_where_most_rows_of_many_columns_lack_a_value() {
        let mut rng = stream(1, "dear", 0);
        // Ten columns of 300 rows; with missing cells, of a tenth, two rows in three lack one.
        let (whole, groups) = table(&[3, 2, 4, 1], false, &mut rng);
        let (gaps, _) = table(&[3, 2, 4, 1], true, &mut rng);
        let of = |data, small, few| dear(data, &groups, small, few).unwrap();
        assert!(of(&gaps, 2999, 9));
        assert!(!of(&whole, 2999, 9) && !of(&gaps, 3000, 9) && !of(&gaps, 2999, 10));
    }

    #[test]
    fn every_level_splits_the_one_before_and_keeps_every_column_once() {
        for seed in 0..20 {
            let mut rng = stream(seed, "levels", 0);
            let (data, mut groups) = table(&[2, 1, 1, 3, 1, 5], false, &mut rng);
            // A group of two columns, a constant column, a category, and a name that is taken.
            let pair = groups.remove(1);
            groups[0].columns.extend(pair.columns);
            groups[3].name = "numbers_1".to_owned();
            let same = (0..300).map(|_| Some(1.0));
            let data = data.real("same", same).unwrap();
            let data = data
                .binary("kind", (0..300).map(|i| Some(i % 2 == 0)))
                .unwrap();
            groups.push(Group::new("same", &["same"]));
            groups.push(Group::new("kind", &["kind"]));
            let found = levels(&data, &groups, 100, &go_on).unwrap();
            assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [3, 5, 9]);
            for level in &found {
                let columns = level.iter().flat_map(|g| &g.columns);
                let columns: BTreeSet<&String> = columns.collect();
                let all = groups.iter().flat_map(|g| &g.columns).collect();
                assert_eq!(columns, all);
                let count: usize = level.iter().map(|g| g.columns.len()).sum();
                assert_eq!(count, columns.len());
                let names: BTreeSet<&String> = level.iter().map(|g| &g.name).collect();
                assert_eq!(names.len(), level.len());
                assert_eq!(level.last().unwrap().name, "kind");
            }
            for (coarse, fine) in found.iter().zip(found.iter().skip(1)) {
                for group in fine {
                    let inside = |c: &Group| group.columns.iter().all(|x| c.columns.contains(x));
                    assert!(coarse.iter().any(inside));
                }
            }
        }
    }

    #[test]
    fn tables_of_few_groups_have_nothing_between() {
        let mut rng = stream(1, "few", 0);
        for copies in [&[][..], &[1], &[2]] {
            let (data, groups) = table(copies, false, &mut rng);
            assert_eq!(
                levels(&data, &groups, 3000, &go_on).unwrap(),
                Vec::<Vec<Group>>::new()
            );
        }
    }
}

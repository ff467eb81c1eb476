//! Of more types than are asked for, those that remove most mismatched volume for their triangles.
//!
//! Without a type, each of its components takes the next best type that is near to it. The difference of the mismatched volumes, over the
//! type's triangles, is the type's worth. The type of least worth is taken out, again and again: the reverse greedy
//! choice of facility location. Worths only grow as others leave, so that one that was computed before is a lower bound.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use rayon::prelude::*;

use super::gain::Gain;
use super::medoids::{CANDIDATES, Price, Table, mismatch};
use super::nearest::Nearest;
use super::uses::Use;

/// A type near to a component: what it costs, in cubic metres, and how it is used.
#[derive(Clone, Copy)]
struct Near {
    cost: f64,
    uses: Use,
}

/// At most `count` of the types with these `medoids`, and the use of one of them for each row of `table`.
pub(super) fn pruned(
    table: &Table,
    medoids: &[usize],
    uses: &[Use],
    price: Price,
    count: usize,
) -> (Vec<usize>, Vec<Use>) {
    let near = near(table, medoids, uses, price);
    let mut stays = vec![true; medoids.len()];
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); medoids.len()];
    for (i, list) in near.iter().enumerate() {
        if let Some(first) = list.first() {
            members[first.uses.kind].push(i);
        }
    }
    let next = |i: usize, without: usize, stays: &[bool]| {
        let others = near[i].iter().filter(|n| n.uses.kind != without);
        others.copied().find(|n| stays[n.uses.kind])
    };
    let worth = |kind: usize, members: &[Vec<usize>], stays: &[bool]| {
        let lost = members[kind].iter().map(|&i| {
            let own = near[i].iter().find(|n| n.uses.kind == kind);
            // What no type near to it stands for is mismatched whole.
            let other = next(i, kind, stays).map_or(table.weights[i], |n| n.cost);
            (other - own.map_or(0.0, |n| n.cost)).max(0.0)
        });
        lost.sum::<f64>() / table.cost(medoids[kind])
    };
    let gain = |candidate: usize, members: &[Vec<usize>], stays: &[bool]| {
        let value = worth(candidate, members, stays);
        Reverse(Gain { value, candidate })
    };
    let all = 0..medoids.len();
    let mut heap: BinaryHeap<Reverse<Gain>> =
        all.clone().map(|k| gain(k, &members, &stays)).collect();
    let mut left = medoids.len();
    while left > count
        && let Some(Reverse(least)) = heap.pop()
    {
        let kind = least.candidate;
        let now = gain(kind, &members, &stays);
        if heap.peek().is_some_and(|other| now < *other) {
            heap.push(now);
            continue;
        }
        stays[kind] = false;
        left -= 1;
        for i in std::mem::take(&mut members[kind]) {
            if let Some(n) = next(i, kind, &stays) {
                members[n.uses.kind].push(i);
            }
        }
    }
    let kept: Vec<usize> = all.filter(|&k| stays[k]).collect();
    let mut number = vec![0; medoids.len()];
    kept.iter()
        .enumerate()
        .for_each(|(new, &old)| number[old] = new);
    let medoids: Vec<usize> = kept.iter().map(|&k| medoids[k]).collect();
    let nearest = Nearest::new(&table.rows, table.d, &medoids);
    let one = |i: usize| match near[i].iter().find(|n| stays[n.uses.kind]) {
        Some(found) => Use {
            kind: number[found.uses.kind],
            ..found.uses
        },
        None => Use {
            kind: nearest.of(table.row(i), 1).first().copied().unwrap_or(0),
            quarter: 0,
        },
    };
    let uses = (0..near.len()).into_par_iter().map(one).collect();
    (medoids, uses)
}

/// The types near to each row, those of least cost first.
fn near(table: &Table, medoids: &[usize], uses: &[Use], price: Price) -> Vec<Vec<Near>> {
    let nearest = Nearest::new(&table.rows, table.d, medoids);
    let one = |i: usize| {
        let mut kinds = nearest.of(table.row(i), CANDIDATES);
        if !kinds.contains(&uses[i].kind) {
            kinds.push(uses[i].kind);
        }
        let found = kinds.into_iter().map(|kind| {
            let medoid = medoids[kind];
            let price = price.derived * table.counts[i] * table.triangles[medoid];
            let costs = (0..4).map(|quarter| {
                let apart = mismatch(table.forms[medoid], table.forms[i], quarter);
                let cost = table.weights[i] * apart + price;
                let uses = Use { kind, quarter };
                Near { cost, uses }
            });
            costs.min_by(|a, b| a.cost.total_cmp(&b.cost))
        });
        let mut found: Vec<Near> = found.flatten().collect();
        let order =
            |a: &Near, b: &Near| (a.cost.total_cmp(&b.cost)).then(a.uses.kind.cmp(&b.uses.kind));
        found.sort_by(order);
        found
    };
    (0..uses.len()).into_par_iter().map(one).collect()
}

//! Positions of new lines that continue the seen ones by rule.
//!
//! The chain draws lines in bins of an eighth of an element; what is built is exact. Between two seen lines, `k` new
//! lines divide the space equally. Beyond the outermost seen line, `k` new ones continue it with one gap (the median, the
//! outermost or another seen one, or what leaves the margin of the other side), with the last two gaps in turn, or as mirror
//! images about the middle of the facade. Of these the sequence nearest to the draw is taken, if each of its lines
//! lies within 0.35 of the extent of an element from its own; else the lines stay where they were drawn.

use crate::layout::lines::median;

/// Largest way of a line to its place by rule, in units of the extent of an element.
const REACH: f64 = 0.35;
/// Cost of each place down the list of rules, in the same unit: a later rule must be nearer by it.
const LATER: f64 = 0.02;

/// The new lines of one axis, each at its place by rule; `seen` and `new` increase, and lie in `[0, length]`. `size` is
/// the typical extent of an element.
pub(super) fn by_rule(seen: &[f64], new: &[f64], length: f64, size: f64) -> Vec<f64> {
    let mut placed = Vec::with_capacity(new.len());
    let mut rest = new;
    for k in 0..=seen.len() {
        let end = seen.get(k).copied().unwrap_or(f64::INFINITY);
        let count = rest.partition_point(|&x| x < end);
        let (run, further) = rest.split_at(count);
        rest = further;
        if run.is_empty() {
            continue;
        }
        let rules = match (k.checked_sub(1).and_then(|k| seen.get(k)), seen.get(k)) {
            (Some(&a), Some(&b)) => between(a, b, run.len(), seen, length),
            (Some(_), None) => beyond(seen, run.len(), length),
            (None, Some(_)) => {
                let mirrored: Vec<f64> = seen.iter().rev().map(|x| length - x).collect();
                let rules = beyond(&mirrored, run.len(), length);
                let back = |rule: Vec<f64>| rule.into_iter().rev().map(|x| length - x).collect();
                rules.into_iter().map(back).collect()
            }
            (None, None) => alone(run, length),
        };
        placed.extend(nearest(run, &rules, length, size));
    }
    placed
}

/// The rule that is nearest to a run of drawn lines, or the run itself.
fn nearest(run: &[f64], rules: &[Vec<f64>], length: f64, size: f64) -> Vec<f64> {
    let mut best: Option<(f64, &Vec<f64>)> = None;
    for (k, rule) in rules.iter().enumerate() {
        let inside = rule.iter().all(|x| (0.0..=length).contains(x));
        if rule.len() != run.len() || !inside {
            continue;
        }
        let ways = run.iter().zip(rule).map(|(a, b)| (a - b).abs() / size);
        let most = ways.fold(0.0, f64::max);
        let cost = most + LATER * k as f64;
        if most <= REACH && best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, rule));
        }
    }
    best.map_or_else(|| run.to_vec(), |(_, rule)| rule.clone())
}

/// Rules for `count` lines between two seen ones.
fn between(a: f64, b: f64, count: usize, seen: &[f64], length: f64) -> Vec<Vec<f64>> {
    let part = (b - a) / (count + 1) as f64;
    let equal = (1..=count).map(|k| a + part * k as f64).collect();
    let images = seen.iter().rev().map(|x| length - x);
    let images: Vec<f64> = images.filter(|x| *x > a && *x < b).collect();
    vec![equal, images]
}

/// Rules for `count` lines beyond the last seen one.
fn beyond(seen: &[f64], count: usize, length: f64) -> Vec<Vec<f64>> {
    let (Some(&first), Some(&last)) = (seen.first(), seen.last()) else {
        return Vec::new();
    };
    let mut rules = Vec::new();
    let with = |gap: f64| (1..=count).map(|k| last + gap * k as f64).collect();
    let gaps: Vec<f64> = seen.windows(2).map(|w| w[1] - w[0]).collect();
    let images = seen.iter().rev().map(|x| length - x);
    rules.push(images.filter(|x| *x > last).collect());
    rules.extend(median(gaps.iter().copied()).map(with));
    rules.extend(gaps.last().copied().map(with));
    let mirrored_margin = (length - first - last) / count as f64;
    if mirrored_margin > 0.0 {
        rules.push(with(mirrored_margin));
    }
    if let [.., before, own] = gaps[..] {
        let in_turn = |at: &mut f64, k: usize| {
            *at += if k.is_multiple_of(2) { before } else { own };
            Some(*at)
        };
        rules.push((0..count).scan(last, in_turn).collect());
    }
    let mut others = gaps;
    others.sort_by(f64::total_cmp);
    others.dedup_by(|b, a| *b - *a < 0.02 * *a);
    rules.extend(others.into_iter().map(with));
    rules
}

/// Rules for all lines, where none is seen: equal gaps with equal margins.
fn alone(run: &[f64], length: f64) -> Vec<Vec<f64>> {
    let (Some(first), Some(last)) = (run.first(), run.last()) else {
        return Vec::new();
    };
    let count = run.len();
    let margin = (first + length - last) / 2.0;
    let gap = (length - 2.0 * margin) / (count.max(2) - 1) as f64;
    let at = |k: usize| match count {
        1 => length / 2.0,
        _ => margin + gap * k as f64,
    };
    vec![(0..count).map(at).collect()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_take_the_place_that_a_rule_gives() {
        let size = 10.0;
        // Between: equal parts. Beyond: the same gap; mirrored margins.
        let seen = [20.0, 40.0, 100.0];
        let placed = by_rule(&seen, &[61.0, 78.5, 119.0, 142.0], 160.0, size);
        assert_eq!(placed, [60.0, 80.0, 120.0, 140.0]);
        // Before the first one too.
        assert_eq!(
            by_rule(&[60.0, 80.0], &[22.0, 39.0], 200.0, size),
            [20.0, 40.0]
        );
        // Gaps in turn.
        let placed = by_rule(&[10.0, 30.0, 60.0, 80.0], &[111.0, 129.0], 300.0, size);
        assert_eq!(placed, [110.0, 130.0]);
        // Nothing near: as drawn.
        assert_eq!(by_rule(&[60.0, 80.0], &[93.0], 400.0, size), [93.0]);
        assert_eq!(
            by_rule(&[], &[21.0, 40.0, 61.0], 80.0, size),
            [20.0, 40.0, 60.0]
        );
        assert!(by_rule(&[1.0], &[], 80.0, size).is_empty());
    }

    #[test]
    fn a_mirrored_facade_gives_mirrored_lines() {
        let (seen, new) = ([31.0, 50.0, 71.0], [11.0, 89.0, 112.0]);
        let length = 130.0;
        let mirror =
            |lines: &[f64]| -> Vec<f64> { lines.iter().rev().map(|x| length - x).collect() };
        let placed = by_rule(&seen, &new, length, 10.0);
        let other = by_rule(&mirror(&seen), &mirror(&new), length, 10.0);
        for (a, b) in placed.iter().zip(mirror(&other)) {
            assert!((a - b).abs() < 1e-9, "{placed:?} {other:?}");
        }
    }
}

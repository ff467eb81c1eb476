//! The rules that exploration draws from: "a subset of rules that seem reasonable" (Sec. 4.2).

use rustc_hash::{FxHashMap, FxHashSet};

use crate::operations::Operations;
use crate::regions::{Strips, TypeId};
use crate::rules::Arrangement;
use edifice_shape::Axis;

/// A rule that seems reasonable: its lines are indices into the cuts, ends included.
#[derive(Debug)]
pub(crate) struct Candidate {
    pub axis: Axis,
    pub arrangement: Arrangement,
    pub lines: Vec<u16>,
    /// Its inner lines as runs of neighbours, from the first up to but without the second.
    runs: Vec<(u16, u16)>,
}

/// For every cost that occurs, all lines that cost no more: whole, and within each period.
pub(crate) fn along(
    axis: Axis,
    strips: &Strips,
    line_costs: &[f64],
    operations: Operations,
    repeated: &FxHashSet<TypeId>,
) -> Vec<Candidate> {
    let n = strips.intervals() as u16;
    let mut candidates = Candidates {
        axis,
        all: Vec::new(),
    };
    if n < 2 {
        return candidates.all;
    }
    let mut add = |arrangement, lines| candidates.add(arrangement, lines);
    for lines in nested_sets(line_costs, n)
        .into_iter()
        .filter(|lines| lines.len() > 2)
    {
        add(Arrangement::Split(axis), lines);
    }
    for lines in isolating_sets(strips, |id| repeated.contains(&id), operations.repeat) {
        add(Arrangement::Split(axis), lines);
    }
    if operations.repeat {
        for period in &strips.periods {
            add(Arrangement::Repeat(axis), vec![0, period.intervals]);
            for lines in nested_sets(line_costs, period.intervals)
                .into_iter()
                .filter(|lines| lines.len() > 2)
            {
                add(Arrangement::Repeat(axis), lines);
            }
        }
    }
    if operations.repeat_aba {
        for &(a, b) in &strips.alternations {
            add(Arrangement::RepeatAba(axis), vec![0, a, b]);
        }
    }
    if operations.sym_split {
        for lines in nested_sets(line_costs, n) {
            let (arrangement, half) = mirrored_half(axis, strips, &lines);
            if half.len() > 2 || (half.len() == 2 && half[1] < n) {
                add(arrangement, half);
            }
        }
    }
    candidates.all
}

/// Rules along one axis.
struct Candidates {
    axis: Axis,
    all: Vec<Candidate>,
}

impl Candidates {
    fn add(&mut self, arrangement: Arrangement, lines: Vec<u16>) {
        let inner = &lines[1..lines.len() - 1];
        let neighbours = inner.chunk_by(|a, b| a + 1 == *b);
        let runs = neighbours.map(|run| (run[0], run[0] + run.len() as u16));
        self.all.push(Candidate {
            axis: self.axis,
            arrangement,
            runs: runs.collect(),
            lines,
        });
    }
}

/// For every cost that a line along either axis has, the columns and rows of the grid of all lines that
/// cost no more.
pub(crate) fn grids(
    line_costs: &[Vec<f64>; 2],
    (across, up): (u16, u16),
) -> Vec<(Vec<u16>, Vec<u16>)> {
    let mut grids: Vec<(Vec<u16>, Vec<u16>)> = Vec::new();
    let inner = |axis: usize, end: u16| line_costs[axis][1..usize::from(end)].iter();
    for &level in inner(0, across).chain(inner(1, up)) {
        let columns = lines_up_to(level, &line_costs[0], across);
        let rows = lines_up_to(level, &line_costs[1], up);
        if columns.len() > 2 && rows.len() > 2 {
            grids.push((columns, rows));
        }
    }
    grids.sort();
    grids.dedup();
    grids
}

/// The lines below `end` that cost at most `level`; ends included.
fn lines_up_to(level: f64, line_costs: &[f64], end: u16) -> Vec<u16> {
    let cheap = (1..end).filter(|l| line_costs[usize::from(*l)] <= level + 1e-9);
    std::iter::once(0).chain(cheap).chain([end]).collect()
}

impl Candidate {
    /// Its number of successors without the blocked lines, and the cost of the lines between them;
    /// `None` when it cannot do without the blocked lines.
    pub(crate) fn without(&self, open: &OpenLines) -> Option<(usize, f64)> {
        let (mut kept, mut cut) = (0, 0.0);
        for &(from, to) in &self.runs {
            let (before, upto) = (open.before[usize::from(from)], open.before[usize::from(to)]);
            kept += upto.0 - before.0;
            cut += upto.1 - before.1;
        }
        let end_is_open = || open.contains(self.lines[self.lines.len() - 1]);
        let enough = match self.arrangement {
            Arrangement::Split(_) => kept > 0,
            Arrangement::Repeat(_) => end_is_open(),
            Arrangement::RepeatAba(_) | Arrangement::Symmetric(..) | Arrangement::Grid => {
                kept + 2 == self.lines.len() && end_is_open()
            }
        };
        enough.then_some((kept + 1, cut))
    }
}

/// The lines of a type that no protected region blocks.
#[derive(Debug)]
pub(crate) struct OpenLines {
    /// Number of open lines before each cut, and the sum of their costs.
    before: Vec<(usize, f64)>,
}

impl OpenLines {
    /// The lines along one axis.
    pub(crate) fn new(blocked: &[bool], line_costs: &[f64]) -> Self {
        let mut before = vec![(0, 0.0)];
        let (mut count, mut cost) = (0, 0.0);
        for (blocked, line_cost) in blocked.iter().zip(line_costs) {
            if !blocked {
                count += 1;
                cost += line_cost;
            }
            before.push((count, cost));
        }
        Self { before }
    }

    fn contains(&self, line: u16) -> bool {
        let line = usize::from(line);
        self.before[line + 1].0 > self.before[line].0
    }
}

/// The sets of lines below `end` that cost at most `c`, for every cost `c` of one of them; ends
/// included.
fn nested_sets(line_costs: &[f64], end: u16) -> Vec<Vec<u16>> {
    let mut levels: Vec<f64> = line_costs[1..usize::from(end)].to_vec();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    levels
        .into_iter()
        .map(|level| lines_up_to(level, line_costs, end))
        .collect()
}

/// For every repeated region that stands in the region as a whole strip: all lines that cut none of
/// its occurrences; with `runs`, moreover none of the lines between occurrences that touch, so that
/// a repeat can take the run.
fn isolating_sets(strips: &Strips, repeated: impl Fn(TypeId) -> bool, runs: bool) -> Vec<Vec<u16>> {
    let n = strips.intervals() as u16;
    let mut occurrences: Vec<Vec<(u16, u16)>> = Vec::new();
    let mut index: FxHashMap<TypeId, usize> = FxHashMap::default();
    for b in 1..=n {
        for (a, &id) in (0..b)
            .zip(strips.ending_at(b.into()))
            .filter(|(_, id)| repeated(**id))
        {
            let group = *index.entry(id).or_insert_with(|| {
                occurrences.push(Vec::new());
                occurrences.len() - 1
            });
            if occurrences[group].last().is_none_or(|(_, end)| *end <= a) {
                occurrences[group].push((a, b));
            }
        }
    }
    let mut sets: Vec<Vec<u16>> = Vec::new();
    for group in &occurrences {
        let keeping = |kept: &[(u16, u16)]| -> Vec<u16> {
            (0..=n)
                .filter(|l| !kept.iter().any(|(a, b)| a < l && l < b))
                .collect()
        };
        sets.push(keeping(group));
        let joined = join(group);
        if runs && joined.len() < group.len() {
            sets.push(keeping(&joined));
        }
    }
    sets.retain(|lines| lines.len() > 2);
    sets.sort();
    sets.dedup();
    sets
}

/// Intervals with those that touch made one.
fn join(intervals: &[(u16, u16)]) -> Vec<(u16, u16)> {
    let mut joined: Vec<(u16, u16)> = Vec::new();
    for &(a, b) in intervals {
        match joined.last_mut() {
            Some(last) if last.1 == a => last.1 = b,
            _ => joined.push((a, b)),
        }
    }
    joined
}

/// The left half of a set of lines that mirrors itself as far as the region does; the middle part
/// is what lies between the innermost mirrored lines.
fn mirrored_half(axis: Axis, strips: &Strips, lines: &[u16]) -> (Arrangement, Vec<u16>) {
    let mut half = vec![0];
    let mut inner = strips.intervals() as u16;
    for &(left, right) in strips.mirrors.iter().skip(1) {
        if !lines.contains(&left) || !lines.contains(&right) {
            continue;
        }
        let before = half[half.len() - 1];
        if strips.strip(before.into(), left.into()) != strips.strip(right.into(), inner.into()) {
            break;
        }
        half.push(left);
        inner = right;
    }
    let middle = half[half.len() - 1];
    if middle < inner {
        half.push(inner);
    }
    (Arrangement::Symmetric(axis, middle < inner), half)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Oracle: go through the lines one by one.
        #[test]
        fn blocked_lines_leave_what_counting_leaves(
            lines in prop::collection::vec((any::<bool>(), any::<bool>(), 0u8..9), 2..20),
            repeat in any::<bool>(),
        ) {
            let end = lines.len() as u16;
            // Neither end of a region is ever blocked.
            let blocked: Vec<bool> = (0..=end)
                .map(|l| 0 < l && l < end && lines[usize::from(l)].1)
                .collect();
            let costs: Vec<f64> = (0..=lines.len())
                .map(|l| lines.get(l).map_or(0.0, |line| f64::from(line.2)))
                .collect();
            let inner: Vec<u16> = (1..end).filter(|l| lines[usize::from(*l)].0).collect();
            let mut candidates = Candidates { axis: Axis::X, all: Vec::new() };
            let arrangement = match repeat {
                true => Arrangement::Repeat(Axis::X),
                false => Arrangement::Split(Axis::X),
            };
            let all = std::iter::once(0).chain(inner.iter().copied()).chain([end]);
            candidates.add(arrangement, all.collect());
            let left: Vec<u16> = inner.into_iter().filter(|l| !blocked[usize::from(*l)]).collect();
            let cut: f64 = left.iter().map(|l| costs[usize::from(*l)]).sum();
            let expected = (repeat || !left.is_empty()).then_some((left.len() + 1, cut));
            let open = OpenLines::new(&blocked, &costs);
            prop_assert_eq!(candidates.all[0].without(&open), expected);
        }
    }

    #[test]
    fn a_repeat_whose_period_ends_on_a_blocked_line_is_gone() {
        let mut candidates = Candidates {
            axis: Axis::X,
            all: Vec::new(),
        };
        candidates.add(Arrangement::Repeat(Axis::X), vec![0, 1, 2]);
        let costs = [0.0, 0.0, 0.0, 0.0, 0.0];
        let without =
            |blocked: [bool; 5]| candidates.all[0].without(&OpenLines::new(&blocked, &costs));
        assert_eq!(without([false, true, false, false, false]), Some((1, 0.0)));
        assert_eq!(without([false, false, true, false, false]), None);
    }
}

//! Features of pairs of grids (Sec. 4.2): the pattern of their elements, and their alignment.

use serde::{Deserialize, Serialize};

use super::grid::Grid;

/// Longest period that is told from others.
const LONGEST: usize = 6;
/// Lines are aligned when they differ by less than this share of the facade's extent.
const ALIGNED: f64 = 0.01;
/// Rows (columns) of two grids are the same when they differ by less than this share of the smaller size.
const SAME_LINE: f64 = 0.35;

/// The repeating sequence of two interleaved grids, the first element being A: bit i is set where
/// element i is a B. Length 0 stands for all that repeat less often than every six elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) struct Pattern {
    /// Number of elements of the sequence.
    pub length: u8,
    /// Bit i is set where element i is a B.
    pub bits: u8,
}

impl Pattern {
    /// The pattern in letters.
    pub(super) fn letters(self) -> String {
        let letter = |i| if self.bits >> i & 1 == 1 { 'B' } else { 'A' };
        match self.length {
            0 => "other".into(),
            n => (0..n).map(letter).collect(),
        }
    }

    /// The minimal period of a sequence; the last period may be cut off.
    fn of(sequence: &[bool]) -> Self {
        let first = sequence.first().copied().unwrap_or(false);
        let repeats = |n: usize| (n..sequence.len()).all(|i| sequence[i] == sequence[i - n]);
        let period = (2..=LONGEST.min(sequence.len())).find(|&n| repeats(n));
        match period {
            None => Self { length: 0, bits: 0 },
            Some(n) => Self {
                length: n as u8,
                bits: (0..n).fold(0, |bits, i| bits | u8::from(sequence[i] != first) << i),
            },
        }
    }
}

/// True if the extents of two grids overlap along an axis.
fn overlapping(a: &Grid, b: &Grid, axis: usize) -> bool {
    a.low[axis] < b.high[axis] && b.low[axis] < a.high[axis]
}

/// True if a line of one grid is also one of the other.
fn share_a_line(a: &Grid, b: &Grid, axis: usize) -> bool {
    let tolerance = SAME_LINE * a.size[axis].min(b.size[axis]);
    matches(&a.lines[axis], &b.lines[axis], tolerance) > 0
}

/// The pattern of two grids along an axis, where they are interleaved: they share a line across the
/// axis, their lines along the axis differ, and they change from one grid to the other at least twice.
pub(super) fn pattern(a: &Grid, b: &Grid, axis: usize) -> Option<Pattern> {
    if !overlapping(a, b, axis) || !share_a_line(a, b, 1 - axis) || share_a_line(a, b, axis) {
        return None;
    }
    let (left, right) = (&a.lines[axis], &b.lines[axis]);
    let (mut i, mut j) = (0, 0);
    let mut sequence = Vec::with_capacity(left.len() + right.len());
    while i < left.len() || j < right.len() {
        let second = i == left.len() || (j < right.len() && right[j] < left[i]);
        sequence.push(second);
        if second {
            j += 1;
        } else {
            i += 1;
        }
    }
    let changes = sequence.windows(2).filter(|w| w[0] != w[1]).count();
    (changes >= 2).then(|| Pattern::of(&sequence))
}

/// Pairs of values, one of each ascending list, that differ by at most `tolerance`, one to one.
fn matches(a: &[f64], b: &[f64], tolerance: f64) -> usize {
    let (mut i, mut j, mut count) = (0, 0, 0);
    while i < a.len() && j < b.len() {
        if (a[i] - b[j]).abs() <= tolerance {
            count += 1;
            i += 1;
            j += 1;
        } else if a[i] < b[j] {
            i += 1;
        } else {
            j += 1;
        }
    }
    count
}

/// Gap and alignment coefficient (Eq. 6) of the lines along `axis` (0: columns, the vertical alignment)
/// of two grids whose projections on that axis overlap; both lengths are relative to the facade.
pub(super) fn alignment(a: &Grid, b: &Grid, axis: usize, facade: [f64; 2]) -> Option<(f64, f64)> {
    if !overlapping(a, b, axis) {
        return None;
    }
    let (low, high) = (a.low[axis].max(b.low[axis]), a.high[axis].min(b.high[axis]));
    let within = |lines: &[f64]| {
        let from = lines.partition_point(|l| *l < low);
        let to = lines.partition_point(|l| *l <= high);
        (from, to)
    };
    let (of_a, of_b) = (within(&a.lines[axis]), within(&b.lines[axis]));
    let most = (of_a.1 - of_a.0).max(of_b.1 - of_b.0);
    if most == 0 {
        return None;
    }
    let aligned = matches(
        &a.lines[axis][of_a.0..of_a.1],
        &b.lines[axis][of_b.0..of_b.1],
        ALIGNED * facade[axis],
    );
    let across = 1 - axis;
    let gap = (a.low[across] - b.high[across]).max(b.low[across] - a.high[across]);
    Some((gap.max(0.0) / facade[across], aligned as f64 / most as f64))
}

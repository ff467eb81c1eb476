//! From a step that makes some sizes equal to a projection: applied twice it changes nothing more.
//!
//! A *step* with reach `r` moves no line of its argument by more than `r`, and leaves each within its range: not
//! further than the tolerance `t` from where any line that it came from was at the start. It is taken when it
//! makes the layout simpler (fewer distinct sizes and cut lines together) and keeps what [`Layout::keeps`] names,
//! else one along x alone, or y alone, is tried.
//!
//! A layout is *regular* when the step of reach `t` from it saves less than a tenth of its sizes and lines, or is
//! none: below ten of them, every one counts. With `W_r(x)` for where steps of reach `r` from `x` end,
//!
//! ```text
//! R(x) = x if x is regular; else the first W_r(x) that is, r = t, 0.9 t, ..., 0.15 t; else x
//! ```
//! So `R(R(x)) = R(x)`: either `R(x) = x`, or `R(x)` is regular. Nothing here depends on what a step does, only
//! that it is deterministic. A tenth is left because steps are heuristics: from where one ends, another that
//! measures anew nearly always finds a little more.

use super::error::RegularizeError;

/// Reaches of the steps that are tried, as parts of the tolerance.
const REACHES: [f64; 8] = [1.0, 0.9, 0.75, 0.6, 0.5, 0.4, 0.3, 0.15];

/// Most steps of one reach.
const MAX_STEPS: usize = 12;

/// A layout that steps can be taken from.
pub(super) trait Layout: Sized + Clone {
    /// One step along the chosen axes, that leaves each line within its range; `None` when nothing more becomes
    /// equal.
    ///
    /// # Errors
    /// [`RegularizeError`].
    fn step(&self, limits: &Limits) -> Result<Option<Projected<Self>>, RegularizeError>;

    /// Coordinates of the cut lines along x and y.
    fn lines(&self) -> [&[f64]; 2];

    /// True if a layout made from this one has no more sizes, and all labels and elements.
    fn keeps(&self, made: &Self) -> bool;

    /// Number of distinct sizes and cut lines.
    fn complexity(&self) -> usize;
}

/// The limits of a step.
#[derive(Debug, Clone)]
pub(super) struct Limits {
    /// Longest way of any line from where it is.
    pub reach: f64,
    /// Depth of the deepest nick that may be filled.
    pub depth: f64,
    /// Along x and y, the lines before the step and their ranges.
    pub ranges: [Vec<(f64, [f64; 2])>; 2],
    /// True for x and y if lines along that axis may move.
    pub axes: [bool; 2],
}

/// The result of one step.
#[derive(Debug, Clone)]
pub(super) struct Projected<L> {
    /// The layout.
    pub layout: L,
    /// Lines along x and y before and after it.
    pub moved: [Vec<(f64, f64)>; 2],
    /// Depth of the deepest nick that was filled.
    pub filled: f64,
    /// Areas that became rectangles.
    pub squared: usize,
}

/// The result of several steps.
#[derive(Debug, Clone)]
pub(super) struct Made<L> {
    /// The layout.
    pub layout: L,
    /// Longest way of any edge.
    pub largest_move: f64,
    /// Areas that became rectangles.
    pub squared: usize,
    /// Depth of nicks that were filled, over all steps.
    filled: f64,
    /// The positions of lines along x and y, before all steps and now.
    tracks: [Vec<(f64, f64)>; 2],
}

/// `R(x)`; `None` when it is `x`.
///
/// # Errors
/// Those of the steps.
pub(super) fn project<L: Layout>(
    start: &L,
    tolerance: f64,
) -> Result<Option<Made<L>>, RegularizeError> {
    if tolerance == 0.0 || is_regular(start, tolerance)? {
        return Ok(None);
    }
    for part in REACHES {
        let made = walk(start, part * tolerance, tolerance)?;
        let simpler = made.layout.complexity() < start.complexity();
        if simpler && is_regular(&made.layout, tolerance)? {
            return Ok(Some(made));
        }
    }
    Ok(None)
}

/// True if no step saves enough to be worth it: a tenth of the complexity.
fn is_regular<L: Layout>(layout: &L, tolerance: f64) -> Result<bool, RegularizeError> {
    let made = Made::new(layout);
    let next = made.next(layout, tolerance, tolerance)?;
    Ok(next.is_none_or(|next| 10 * next.layout.complexity() > 9 * layout.complexity()))
}

/// Steps from `start` as long as each makes the layout simpler.
fn walk<L: Layout>(start: &L, reach: f64, tolerance: f64) -> Result<Made<L>, RegularizeError> {
    let mut made = Made::new(start);
    for _ in 0..MAX_STEPS {
        match made.next(start, reach, tolerance)? {
            Some(next) => {
                let (before, after) = (made.layout.complexity(), next.layout.complexity());
                made = next;
                // What is left to save is not worth the time.
                if 50 * (before - after) < before {
                    break;
                }
            }
            None => break,
        }
    }
    Ok(made)
}

impl<L: Layout> Made<L> {
    fn new(start: &L) -> Self {
        let same = |lines: &[f64]| lines.iter().map(|&l| (l, l)).collect::<Vec<_>>();
        Self {
            layout: start.clone(),
            largest_move: 0.0,
            squared: 0,
            filled: 0.0,
            tracks: start.lines().map(same),
        }
    }

    /// After one more step, along both axes or else along one; `None` when none makes the layout simpler.
    fn next(&self, start: &L, reach: f64, tolerance: f64) -> Result<Option<Self>, RegularizeError> {
        let mut limits = Limits {
            reach,
            depth: reach.min(tolerance - self.filled),
            ranges: [self.ranges(0, tolerance), self.ranges(1, tolerance)],
            axes: [true, true],
        };
        let lines = self.layout.lines().into_iter().flatten().copied();
        let hair = 1e-9 * lines.fold(0.0, f64::max);
        for axes in [[true, true], [true, false], [false, true]] {
            limits.axes = axes;
            let Some(step) = self.layout.step(&limits)? else {
                continue;
            };
            let next = self.after(step);
            let simpler = next.layout.complexity() < self.layout.complexity();
            if simpler && next.largest_move <= tolerance + hair && start.keeps(&next.layout) {
                return Ok(Some(next));
            }
        }
        Ok(None)
    }

    /// The range of each line, such that none of those at the start goes further than the tolerance.
    fn ranges(&self, axis: usize, tolerance: f64) -> Vec<(f64, [f64; 2])> {
        let mut ranges: Vec<(f64, [f64; 2])> = Vec::new();
        for &(from, at) in &self.tracks[axis] {
            let own = [from - tolerance, from + tolerance];
            match ranges.last_mut() {
                Some((last, range)) if *last == at => {
                    *range = [range[0].max(own[0]), range[1].min(own[1])];
                }
                _ => ranges.push((at, own)),
            }
        }
        ranges
    }

    fn after(&self, step: Projected<L>) -> Self {
        let mut next = Self {
            filled: self.filled + step.filled,
            squared: self.squared + step.squared,
            layout: step.layout,
            largest_move: self.largest_move,
            tracks: self.tracks.clone(),
        };
        let lines = self.layout.lines().into_iter().flatten().copied();
        let hair = 1e-7 * lines.fold(0.0, f64::max);
        next.largest_move = next.largest_move.max(next.filled);
        for (tracks, moved) in next.tracks.iter_mut().zip(&step.moved) {
            tracks.retain_mut(|(from, at)| {
                let after = moved.partition_point(|m| m.0 < *at - hair);
                let found = moved.get(after).filter(|m| m.0 <= *at + hair);
                // A line that is no edge any more has no way to go.
                let Some(&(_, to)) = found else { return false };
                *at = to;
                next.largest_move = next.largest_move.max((to - *from).abs());
                true
            });
        }
        next
    }
}

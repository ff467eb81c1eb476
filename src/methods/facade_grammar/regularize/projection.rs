//! From a step that makes some sizes equal to a projection: applied twice it changes nothing more.
//!
//! A *step* with reach `r` moves no line of its argument by more than `r`, and *frozen* lines not at all; it
//! returns nothing when it finds nothing more to make equal. It measures from its argument, so that after
//! one step another may well find more, and lines may go further in all than the tolerance `t`. Then they
//! are frozen, and the steps begin anew. Let `P_r(x, F)` be where they end when the lines `F` are frozen from the
//! start: no line has moved further than `t`, and the last step found nothing. It is undefined when the
//! result lacks something that [`Layout::keeps`] names. Where `y = P_r(x, F)` is not left alone by `P_r(., {})`, the lines
//! that would move are added to `F`, until it is:
//!
//! ```text
//! Q_r(x) = the first y = P_r(x, F) with P_r(y, {}) = y,  F growing from {}; undefined where P_r is
//! ```
//! So `Q_r(Q_r(x)) = Q_r(x)`. A smaller reach is for layouts where `Q` is undefined: for `t = r_0 > r_1 > ... > r_m`,
//!
//! ```text
//! y is *stable at i*  when Q_i(y) = y, and no j < i has a Q_j(y) that differs from y and is stable at j
//! R(x) = Q_i(x) for the first i for which it is stable at i; x if there is none
//! ```
//! Regularization is `R`, and `R(R(x)) = R(x)`. If no candidate of `x` was taken, `R(x) = x` and there is nothing to
//! show. Otherwise `y = R(x)` is stable at some `i`. What `R(y)` might take before it comes to `i` is `y`
//! itself, as no other `Q_j(y)` is stable at `j`; and at `i` it takes `Q_i(y) = y`. Nothing here depends on what a step
//! does, only that it is deterministic.

use super::RegularizeError;

/// Reaches that are tried, as parts of the tolerance.
const REACHES: [f64; 3] = [1.0, 0.7, 0.4];

/// Most steps of one reach.
const MAX_STEPS: usize = 20;

/// Most times that more lines are frozen.
const MAX_RESTARTS: usize = 5;

/// A layout that steps can be taken from.
pub trait Layout: Sized + Clone {
    /// One step that does not move the lines along x and y at the frozen coordinates; `None` when nothing more
    /// becomes equal.
    ///
    /// # Errors
    /// [`RegularizeError`].
    fn step(&self, reach: f64, frozen: &Frozen) -> Result<Option<Step<Self>>, RegularizeError>;

    /// Coordinates of the cut lines along x and y.
    fn lines(&self) -> [&[f64]; 2];

    /// Whether a layout made from this one has as few sizes, and all labels and elements.
    fn keeps(&self, made: &Self) -> bool;
}

/// Coordinates of lines along x and y that must not move.
pub type Frozen = [Vec<f64>; 2];

/// What one step made.
#[derive(Debug, Clone)]
pub struct Step<L> {
    /// The layout.
    pub layout: L,
    /// Lines along x and y before and after it.
    pub moved: [Vec<(f64, f64)>; 2],
    /// Depth of the deepest nick that was filled.
    pub filled: f64,
    /// Areas that became rectangles.
    pub squared: usize,
}

/// What several steps made.
#[derive(Debug, Clone)]
pub struct Made<L> {
    /// The layout.
    pub layout: L,
    /// Longest way of any edge.
    pub largest_move: f64,
    /// Areas that became rectangles.
    pub squared: usize,
    /// Where lines along x and y were, and are.
    tracks: [Vec<(f64, f64)>; 2],
}

/// Where steps lead to.
enum End<L> {
    /// No step found anything.
    Start,
    /// Elsewhere.
    Made(Made<L>),
    /// To nothing that is admitted.
    Nowhere,
}

/// `R(x)`; `None` when it is `x`.
///
/// # Errors
/// Those of the steps.
pub fn project<L: Layout>(start: &L, tolerance: f64) -> Result<Option<Made<L>>, RegularizeError> {
    for level in 0..REACHES.len() {
        match candidate(start, level, tolerance)? {
            // No earlier candidate was taken: this layout is stable.
            End::Start => return Ok(None),
            End::Made(made) if stable(&made.layout, level, tolerance)? => return Ok(Some(made)),
            End::Made(_) | End::Nowhere => {}
        }
    }
    Ok(None)
}

/// Whether a layout is stable at a level.
fn stable<L: Layout>(layout: &L, level: usize, tolerance: f64) -> Result<bool, RegularizeError> {
    if !matches!(candidate(layout, level, tolerance)?, End::Start) {
        return Ok(false);
    }
    for earlier in 0..level {
        if let End::Made(made) = candidate(layout, earlier, tolerance)?
            && stable(&made.layout, earlier, tolerance)?
        {
            return Ok(false);
        }
    }
    Ok(true)
}

/// `Q_level(start)`.
fn candidate<L: Layout>(
    start: &L,
    level: usize,
    tolerance: f64,
) -> Result<End<L>, RegularizeError> {
    let reach = REACHES[level] * tolerance;
    let mut frozen = Frozen::default();
    for restart in 0..=MAX_RESTARTS {
        let made = match end(start, reach, tolerance, &mut frozen)? {
            End::Made(made) => made,
            other => return Ok(other),
        };
        match end(&made.layout, reach, tolerance, &mut Frozen::default())? {
            End::Start => return Ok(End::Made(made)),
            End::Nowhere => return Ok(End::Nowhere),
            End::Made(next) => {
                for axis in 0..2 {
                    let restless = next.tracks[axis].iter().filter(|(from, to)| from != to);
                    for (at, _) in restless {
                        let here = made.tracks[axis].iter().filter(|(_, now)| now == at);
                        let lines: Vec<f64> = here.map(|(from, _)| *from).collect();
                        freeze(&mut frozen[axis], start.lines()[axis], &lines, restart);
                    }
                }
            }
        }
    }
    Ok(End::Nowhere)
}

/// `P_reach(start, frozen)`; `frozen` grows by the lines that went too far.
fn end<L: Layout>(
    start: &L,
    reach: f64,
    tolerance: f64,
    frozen: &mut Frozen,
) -> Result<End<L>, RegularizeError> {
    for restart in 0..=MAX_RESTARTS {
        match walk(start, reach, tolerance, frozen)? {
            Walk::Ended(end) => return Ok(end),
            Walk::TooFar(lines) => {
                for ((frozen, all), lines) in frozen.iter_mut().zip(start.lines()).zip(lines) {
                    freeze(frozen, all, &lines, restart);
                }
            }
        }
    }
    Ok(End::Nowhere)
}

/// Adds lines to the frozen ones, and at each restart four times as many of those beside them, lest there are
/// many restarts.
fn freeze(frozen: &mut Vec<f64>, all: &[f64], lines: &[f64], restart: usize) {
    let beside = (1 << (2 * restart)) - 1;
    for line in lines {
        let at = all.partition_point(|l| l < line);
        let from = at.saturating_sub(beside);
        let to = (at + beside + 1).min(all.len());
        frozen.extend(&all[from..to]);
    }
    frozen.sort_by(f64::total_cmp);
    frozen.dedup();
}

/// How repeated steps end.
enum Walk<L> {
    /// There is no further step.
    Ended(End<L>),
    /// Lines went further than the tolerance: where they started.
    TooFar(Frozen),
}

/// Takes steps until there are none.
fn walk<L: Layout>(
    start: &L,
    reach: f64,
    tolerance: f64,
    frozen: &Frozen,
) -> Result<Walk<L>, RegularizeError> {
    let Some(first) = start.step(reach, frozen)? else {
        return Ok(Walk::Ended(End::Start));
    };
    let longer = start.lines().into_iter().flatten().copied();
    let hair = 1e-9 * longer.fold(0.0, f64::max);
    let pair = |lines: &[f64]| lines.iter().map(|&l| (l, l)).collect::<Vec<_>>();
    let mut made = Made {
        layout: start.clone(),
        largest_move: 0.0,
        squared: 0,
        tracks: start.lines().map(pair),
    };
    let mut filled = 0.0;
    let mut next = Some(first);
    for _ in 0..MAX_STEPS {
        let Some(step) = next else {
            let kept = start.keeps(&made.layout) && made.largest_move <= tolerance + hair;
            return Ok(Walk::Ended(match kept {
                true => End::Made(made),
                false => End::Nowhere,
            }));
        };
        filled += step.filled;
        let mut far = Frozen::default();
        let mut longest = made.largest_move.max(filled);
        for ((tracks, moved), far) in made.tracks.iter_mut().zip(&step.moved).zip(&mut far) {
            tracks.retain_mut(|(from, at)| {
                let after = moved.partition_point(|m| m.0 < *at - 100.0 * hair);
                let found = moved.get(after).filter(|m| m.0 <= *at + 100.0 * hair);
                // A line that is no edge any more has no way to go.
                let Some(&(_, to)) = found else { return false };
                *at = to;
                longest = longest.max((to - *from).abs());
                if (to - *from).abs() > tolerance + hair {
                    far.push(*from);
                }
                true
            });
        }
        if far.iter().any(|lines| !lines.is_empty()) {
            return Ok(Walk::TooFar(far));
        }
        made.largest_move = longest;
        made.layout = step.layout;
        made.squared += step.squared;
        next = made.layout.step(reach, frozen)?;
    }
    Ok(Walk::Ended(End::Nowhere))
}

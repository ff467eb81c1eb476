//! From a step that makes some sizes equal to a projection: applied twice it changes nothing more.
//!
//! A *step* with reach `r` moves no line of its argument by more than `r`, and *frozen* lines not at all; it
//! returns nothing when it finds nothing more to make equal. It measures from its argument, so that after
//! one step another may well find more, and lines may go further in all than the tolerance `t`. Then they
//! are frozen, and the steps begin anew. Let `Q_r(x)` be where they end: no line has moved further than
//! `t`, and the last step found nothing. It is *admitted* if it also keeps what [`Layout::keeps`] names, and otherwise
//! undefined. For reaches `t = r_0 > r_1 > ... > r_m`,
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
const REACHES: [f64; 5] = [1.0, 0.75, 0.5, 0.25, 0.125];

/// Most steps of one reach.
const MAX_STEPS: usize = 12;

/// Most times that lines are frozen.
const MAX_FREEZES: usize = 12;

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
    for _ in 0..=MAX_FREEZES {
        match walk(start, reach, tolerance, &frozen)? {
            Walk::Ended(end) => return Ok(end),
            Walk::TooFar(lines) => {
                for (frozen, lines) in frozen.iter_mut().zip(lines) {
                    frozen.extend(lines);
                }
            }
        }
    }
    Ok(End::Nowhere)
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
    let mut tracks = start.lines().map(pair);
    let mut made = Made {
        layout: start.clone(),
        largest_move: 0.0,
        squared: 0,
    };
    let mut filled = 0.0;
    let mut next = Some(first);
    for _ in 0..MAX_STEPS {
        let Some(step) = next else {
            let kept = start.keeps(&made.layout) && made.largest_move <= tolerance + hair;
            if std::env::var("DBG").is_ok() { eprintln!("END reach {reach} kept {kept} moved {}", made.largest_move); }
            return Ok(Walk::Ended(match kept {
                true => End::Made(made),
                false => End::Nowhere,
            }));
        };
        filled += step.filled;
        let mut far = Frozen::default();
        for ((tracks, moved), far) in tracks.iter_mut().zip(&step.moved).zip(&mut far) {
            tracks.retain_mut(|(from, at)| {
                let after = moved.partition_point(|m| m.0 < *at - 100.0 * hair);
                let found = moved.get(after).filter(|m| m.0 <= *at + 100.0 * hair);
                // A line that is no edge any more has no way to go.
                let Some(&(_, to)) = found else { return false };
                *at = to;
                made.largest_move = made.largest_move.max((to - *from).abs());
                if (to - *from).abs() > tolerance + hair {
                    far.push(*from);
                }
                true
            });
        }
        if far.iter().any(|lines| !lines.is_empty()) {
            if std::env::var("DBG").is_ok() { eprintln!("FAR reach {reach} lines {}", far[0].len()+far[1].len()); }
            return Ok(Walk::TooFar(far));
        }
        made.largest_move = made.largest_move.max(filled);
        made.layout = step.layout;
        made.squared += step.squared;
        next = made.layout.step(reach, frozen)?;
    }
    Ok(Walk::Ended(End::Nowhere))
}

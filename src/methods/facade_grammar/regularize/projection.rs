//! From a step that makes some sizes equal to a projection: applied twice it changes nothing more.
//!
//! A *step* with reach `r` moves no line of its argument by more than `r`; it returns nothing when it finds
//! nothing more to make equal. Its argument is where it measures from, so that after one step another may
//! well find more. Let `S_r(x)` be what repeated steps lead to: `S_r(S_r(x)) = S_r(x)`, as the last step found
//! nothing. But lines may have gone further than the tolerance `t` in all, or something else may be wrong
//! with `S_r(x)`: call it *admitted* from `x` when all lines moved by at most `t` and its regularities are
//! not fewer than those of `x`. For the reaches `r_0 = t > r_1 > ... > r_m` let
//!
//! ```text
//! y is *settled at i*  when S_(r_i)(y) = y, and for every j < i: S_(r_j)(y) = y or S_(r_j)(y) is not admitted from y
//! R(x) = the first S_(r_i)(x) that is admitted from x and settled at i, else x
//! ```
//! `R(R(x)) = R(x)`: if no candidate of `x` was taken, `R(x) = x`, and there is nothing to show. Otherwise
//! `y = R(x)` is settled at some `i`. For `j < i` the candidate `S_(r_j)(y)` is `y` itself or is not admitted,
//! hence not taken; at `i` at the latest, the candidate is `y`, which is taken. So every candidate that `R(y)`
//! may take is `y`.

use super::RegularizeError;

/// Reaches that are tried, as parts of the tolerance.
const REACHES: [f64; 4] = [1.0, 0.5, 0.25, 0.125];

/// Most steps of one reach.
const MAX_STEPS: usize = 12;

/// A layout that steps can be taken from.
pub trait Layout: Sized + Clone {
    /// One step; `None` when nothing more becomes equal.
    ///
    /// # Errors
    /// [`RegularizeError`].
    fn step(&self, reach: f64) -> Result<Option<Step<Self>>, RegularizeError>;

    /// Coordinates of the cut lines along x and y.
    fn lines(&self) -> [&[f64]; 2];

    /// Whether a layout made from this one has as few sizes, and all labels and elements.
    fn keeps(&self, made: &Self) -> bool;
}

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

/// `R(x)`; `None` when it is `x`.
///
/// # Errors
/// Those of the steps.
pub fn project<L: Layout>(start: &L, tolerance: f64) -> Result<Option<Made<L>>, RegularizeError> {
    for (level, part) in REACHES.into_iter().enumerate() {
        let Some(made) = candidate(start, part * tolerance, tolerance)? else {
            continue;
        };
        let Some(made) = made else {
            return Ok(None);
        };
        if settled(&made.layout, level, tolerance)? {
            return Ok(Some(made));
        }
    }
    Ok(None)
}

/// Whether no longer reach leads away from a layout that its own leaves alone.
fn settled<L: Layout>(layout: &L, level: usize, tolerance: f64) -> Result<bool, RegularizeError> {
    for part in &REACHES[..level] {
        if let Some(Some(_)) = candidate(layout, part * tolerance, tolerance)? {
            return Ok(false);
        }
    }
    Ok(true)
}

/// `S_reach(start)`: the outer `None` when it is not admitted, the inner one when it is `start`.
#[allow(clippy::type_complexity)]
fn candidate<L: Layout>(
    start: &L,
    reach: f64,
    tolerance: f64,
) -> Result<Option<Option<Made<L>>>, RegularizeError> {
    let Some(first) = start.step(reach)? else {
        return Ok(Some(None));
    };
    let longer = start.lines().into_iter().flatten().copied();
    let hair = 1e-9 * longer.fold(0.0, f64::max);
    let mut tracks = start.lines().map(|lines| lines.iter().map(|&l| (l, l)).collect::<Vec<_>>());
    let mut made = Made {
        layout: start.clone(),
        largest_move: 0.0,
        squared: 0,
    };
    let mut next = Some(first);
    for _ in 0..MAX_STEPS {
        let Some(step) = next else {
            if std::env::var("DBG").is_ok() { eprintln!("   end reach {reach} moved {} keeps {}", made.largest_move, start.keeps(&made.layout)); }
            return Ok(start.keeps(&made.layout).then_some(Some(made)));
        };
        made.largest_move = (made.largest_move + step.filled).max(0.0);
        for (tracks, moved) in tracks.iter_mut().zip(&step.moved) {
            // A line that is no edge any more has no way to go.
            tracks.retain_mut(|(_, at)| {
                let after = moved.partition_point(|m| m.0 < *at - 100.0 * hair);
                let found = moved.get(after).filter(|m| m.0 <= *at + 100.0 * hair);
                found.inspect(|m| *at = m.1).is_some()
            });
            let way = |sum: f64, (from, at): &(f64, f64)| sum.max((at - from).abs());
            made.largest_move = tracks.iter().fold(made.largest_move, way);
        }
        if made.largest_move > tolerance + hair {
            if std::env::var("DBG").is_ok() { eprintln!("   far reach {reach} moved {}", made.largest_move); }
            return Ok(None);
        }
        made.layout = step.layout;
        made.squared += step.squared;
        next = made.layout.step(reach)?;
    }
    Ok(None)
}

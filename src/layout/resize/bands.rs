//! Another size by whole bands: columns that stand together repeat together, floors at their own rhythm.
//!
//! A *seam* is a line across the facade. A band `[a, b)` may be repeated or taken away when the facade is the same along its two
//! seams: in every strip both cross the background, or one region that reaches from one seam to the other and spans several columns
//! of which some are left (a balcony before several windows) or, doors aside, of whose length enough is left (a shop), or two
//! regions of one label and one place and size across, at the same distance from their edges and with background between them: panes of
//! one window are no windows. All floors get the same columns, and what is in line stays in line. Each band has one count for all
//! floors:
//! ```text
//! W' = W + sum_b m_b (b - a),      k = target / W',      x -> k x
//! ```
//! Counts are chosen one after another: each lowers `|ln k| + ALIGNMENT * loss`, where `loss` is the greatest fall, over the
//! labels, of the share of elements that have their like in line on the next floor, as a part of that share; none loses more than a
//! tenth, or at least no panes (glass, or windows where there is none), unless stretching had to do the rest. Among several the best
//! has the least sum of that, of what it was used before, of its way from the middle and of what is new about it. The scale `k` of
//! what remains is one for all, so that equal parts stay equal.
//!
//! Not every such band is a floor or a column:
//! - New is the share of the facade across where a new seam brings two elements together, with background between, that
//!   are neighbours nowhere, or nowhere as close. Little of it may be new.
//! - Most elements of a band stand elsewhere too, in about their size: an attic is not repeated like a floor.
//!   A column that has all regions of a label is left alone, as is a floor that has all of one that stands lowest (the door).
//! - Floors are as long as elements of one label and about one size follow each other, where a band of that length fits, and not
//!   shorter than the least such pitch: a floor comes with its cornice.
//!
//! Where no such bands bring the scale within [`SCALE`], seams may also cross wide regions of one label and one place across,
//! a shop window, that become longer or shorter by that; their labels are told ([`Banded::cut`]).
//!
//! Where a facade is to become wider and even these leave more than [`STRETCHED`] or lose more alignment, columns that have all regions
//! of a label may be repeated, the door's aside, each a few times, or the whole facade from margin to margin, whichever leaves less: a
//! narrow house at twice its width becomes two. Only then is alignment given up.
//!
//! # Deviations and readings
//! - The paper (Wu et al. 2014, Sec. 5) derives each floor for itself and mends alignment afterwards. Here nothing is to
//!   be mended: the quadratic program of [`align`](super::align) is for grammars that say themselves what gives way.
//! - Removed bands do not overlap; added ones may.

use super::apply::{Band, apply};
use super::bands_error::{BandsError, MOST_TIMES};
use super::in_line::{Shares, loss, loss_of_panes, shares};
use super::view::{AxisView, Columns, Repeat};
use edifice_shape::{Axis, Facade, Rect, Region};

/// `|ln k|` that needs no seams through elements.
const SCALE: f64 = 0.12;

/// Weight of lost alignment against the logarithm of the scale.
const ALIGNMENT: f64 = 1.0;

/// Greatest part of the alignment that may be lost, unless `|ln k|` is more than this then.
const MOST_LOST: f64 = 0.1;
const STRETCHED: f64 = 0.25;

/// The same for whole houses, which come in whole numbers: two at 1.4 times the width of one are three quarters as wide.
const MOST_STRETCHED: f64 = 1.0 / 3.0;

/// So many times a column that has all regions of a label is repeated at most, with those that overlap it.
const MOST_SINGLE: i64 = 3;

/// Weights of an earlier use of a band, and of its distance from the middle as a share of the side.
const USED: f64 = 0.08;
const ASIDE: f64 = 0.1;

/// Weight of what a band brings together that is nowhere together ([`Repeat::new`]).
const NEW: f64 = 0.2;

/// A facade at another size.
#[derive(Debug, Clone, PartialEq)]
pub struct Banded {
    /// The facade.
    pub facade: Facade,
    /// Bands added (or, below zero, taken away) along x and y.
    pub bands: [i64; 2],
    /// Factor along x and y by which everything was scaled beside that.
    pub scale: [f64; 2],
    /// Labels of elements that seams went through: they have other sizes than before.
    pub cut: Vec<String>,
}

/// A tiling at another width and height, by bands.
///
/// # Errors
/// [`BandsError`] when the facade is no tiling, or when it is to become more than [`MOST_TIMES`] times as large along an axis.
///
/// # Complexity
/// O(c^2 r) for c columns and r rows of cuts, O(n^2) for the pitches and for each of the at most O(c^2) bands that pass the other
/// tests (O(n) where most elements have their like nearby), and O(n log n) for each step of each band, for n regions.
pub fn resized(own: &Facade, width: f64, height: f64) -> Result<Banded, BandsError> {
    let mut out = Banded {
        facade: own.clone(),
        bands: [0; 2],
        scale: [1.0; 2],
        cut: Vec::new(),
    };
    for (axis, target) in [(Axis::X, width), (Axis::Y, height)] {
        let k = usize::from(axis == Axis::Y);
        let view = AxisView::new(&out.facade, axis)?;
        if (target - view.side).abs() <= view.noise {
            continue;
        }
        if target > MOST_TIMES * view.side {
            return Err(BandsError::Size {
                times: target / view.side,
                axis,
            });
        }
        let best = view.planned(target);
        let (pieces, cut) = apply(&view.pieces, &best.counts, view.side, view.noise);
        let scale = target / best.side;
        out.bands[k] = best.counts.iter().map(|(_, count)| count).sum();
        out.scale[k] = scale;
        out.cut.extend(cut);
        let ends = |at: f64| match at {
            at if (at - best.side).abs() <= view.noise => target,
            at => at * scale,
        };
        let regions = pieces.iter().map(|piece| {
            let (start, end) = (ends(piece.along.0), ends(piece.along.1));
            let (low, high) = piece.across;
            let rect = match axis {
                Axis::X => Rect::new(start, low, end - start, high - low),
                Axis::Y => Rect::new(low, start, high - low, end - start),
            };
            let label = piece.label.to_owned();
            Region { label, rect }
        });
        out.facade.regions = regions.collect();
        match axis {
            Axis::X => out.facade.width = target,
            Axis::Y => out.facade.height = target,
        }
    }
    out.cut.sort();
    out.cut.dedup();
    Ok(out)
}

/// Counts of bands, and the side that they make.
struct BandCounts {
    counts: Vec<(Band, i64)>,
    side: f64,
}

impl AxisView<'_> {
    /// Counts of bands that keep all elements in line, else the panes, where the stricter leaves too much to stretching; else of
    /// columns of their own or of whole houses, whichever leaves less; else of bands that keep nothing in line.
    fn planned(&self, target: f64) -> BandCounts {
        let left = |plan: &BandCounts| (target / plan.side).ln().abs();
        let more = target > self.side;
        let of = |which| self.bands(which, more);
        let (common, cut) = (of(Columns::Common), of(Columns::Cut));
        let within = |kept: fn(&Shares, &Shares) -> f64| {
            let plan = self.plan(&common, target, kept, i64::MAX);
            if left(&plan) <= SCALE {
                return plan;
            }
            let other = self.plan(&cut, target, kept, i64::MAX);
            if left(&other) < left(&plan) {
                other
            } else {
                plan
            }
        };
        let bounds: [fn(&Shares, &Shares) -> f64; 2] = [loss, loss_of_panes];
        let mut kept = bounds.into_iter().map(within);
        if let Some(plan) = kept.find(|plan| left(plan) <= STRETCHED) {
            return plan;
        }
        // No ground floor twice; what stands once is not taken away.
        let rarer: &[(Columns, i64, f64)] = match (self.axis, more) {
            (Axis::X, true) => &[
                (Columns::Single, MOST_SINGLE, STRETCHED),
                (Columns::House, i64::MAX, MOST_STRETCHED),
            ],
            _ => &[],
        };
        let rarer = rarer.iter().filter_map(|&(which, times, most)| {
            let bands = of(which);
            let mut plans = bounds
                .into_iter()
                .map(|kept| self.plan(&bands, target, kept, times));
            plans.find(|plan| left(plan) <= most)
        });
        let least = rarer.min_by(|p, q| left(p).total_cmp(&left(q)));
        least.unwrap_or_else(|| within(|_, _| 0.0))
    }

    /// Chooses the counts of bands so that at each step `kept` lose at most [`MOST_LOST`] of their alignment. Bands that overlap are
    /// together added at most `times`.
    fn plan(
        &self,
        bands: &[Repeat],
        target: f64,
        kept: fn(&Shares, &Shares) -> f64,
        times: i64,
    ) -> BandCounts {
        let more = target > self.side;
        let before = shares(&self.pieces, self.noise);
        let mut plan = BandCounts {
            counts: bands.iter().map(|way| (way.band, 0)).collect(),
            side: self.side,
        };
        let mut worth = (target / plan.side).ln().abs();
        loop {
            let scale = (target / plan.side).ln().abs();
            let mut ways: Vec<(f64, f64, usize)> = Vec::new();
            for (k, &((a, b), count)) in plan.counts.iter().enumerate() {
                let side = if more {
                    plan.side + b - a
                } else {
                    plan.side - (b - a)
                };
                let overlapping = (plan.counts.iter())
                    .filter(|((from, to), _)| *from < b && a < *to)
                    .map(|&(_, count)| count.abs())
                    .sum::<i64>();
                // Removed bands do not overlap.
                let most = if more { times } else { 1 };
                if side <= 0.0 || overlapping >= most {
                    continue;
                }
                let new_scale = (target / side).ln().abs();
                if new_scale < scale - 1e-9 {
                    let aside = (0.5 * (a + b) - 0.5 * self.side).abs() / self.side;
                    let used = USED * count.unsigned_abs() as f64;
                    let rank = new_scale + used + ASIDE * aside + NEW * bands[k].new;
                    ways.push((rank, new_scale, k));
                }
            }
            ways.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.2.cmp(&q.2)));
            let mut best: Option<(f64, f64, usize)> = None;
            for (rank, new_scale, k) in ways {
                if best.is_some_and(|best| best.0 <= rank) {
                    break;
                }
                let mut counts = plan.counts.clone();
                counts[k].1 += if more { 1 } else { -1 };
                let removed: Vec<Band> = (counts.iter().filter(|(_, count)| *count < 0))
                    .map(|(band, _)| *band)
                    .collect();
                if !self.all_give_way(&removed) {
                    continue;
                }
                let after = shares(
                    &apply(&self.pieces, &counts, self.side, self.noise).0,
                    self.noise,
                );
                // Bands taken away together may have all regions of a label, though none has them alone.
                let is_gone = |label: &&str| !after.contains_key(label);
                if kept(&before, &after) > MOST_LOST || before.keys().any(is_gone) {
                    continue;
                }
                let lost = ALIGNMENT * loss(&before, &after);
                if new_scale + lost < worth && best.is_none_or(|best| rank + lost < best.0) {
                    best = Some((rank + lost, new_scale + lost, k));
                }
            }
            let Some((_, new_worth, k)) = best else {
                return plan;
            };
            worth = new_worth;
            let ((a, b), count) = &mut plan.counts[k];
            *count += if more { 1 } else { -1 };
            plan.side += if more { *b - *a } else { *a - *b };
        }
    }
}

//! Another size by whole bands: columns that stand together repeat together, floors at their own rhythm.
//!
//! A *seam* is a line across the facade. A band `[a, b)` may be repeated or taken away when the facade is the same along its two
//! seams: in every strip both cross the background, or one region that reaches from one seam to the other, or two
//! regions of one label and one place and size across, at the same distance from their edges and with background between them: panes of
//! one window are no windows. Then
//! beside every new seam stands what stands beside an old one already, all floors get the same columns, and what is
//! in line stays in line. Each band has one count for all floors:
//! ```text
//! W' = W + sum_b m_b (b - a),      k = target / W',      x -> k x
//! ```
//! Counts are chosen one after another: each lowers `|ln k| + ALIGNMENT * loss`, where `loss` is the greatest fall, over the
//! labels, of the share of elements that have their like in line on the next floor, as a part of that share; none loses more than a
//! tenth, or at least no panes (glass, or windows where there is none), unless stretching had to do the rest. Among several the best has the least of that, of what it was used before and of its way from the middle. The scale `k` of
//! what remains is one for all, so that equal parts stay equal. A band that has all regions of a label (the door) is left alone.
//!
//! Where no such bands bring the scale within [`SCALE`], seams may also cross wide regions of one label and one place across,
//! a shop window, that become longer or shorter by that; their labels are told ([`Banded::cut`]).
//!
//! # Deviations and readings
//! - The paper (Wu et al. 2014, Sec. 5) derives each floor for itself and mends alignment afterwards. Here nothing is to
//!   be mended: the quadratic program of [`align`](super::align) is for grammars that say themselves what gives way.
//! - Removed bands do not overlap; added ones may.

use std::collections::BTreeMap;

use super::bands_error::{BandsError, MOST_TIMES};
use super::in_line::{Piece, Shares, loss, loss_of_panes, shares};
use edifice_shape::{Axis, Facade, Rect, Region, is_background};

/// Shortest and longest band, as shares of the side.
const BAND: (f64, f64) = (0.04, 0.6);

/// `|ln k|` that needs no seams through elements.
const SCALE: f64 = 0.12;

/// Least length of a region through which a seam may go if it must, as a share of the side.
const WIDE: f64 = 0.07;

/// Weight of lost alignment against the logarithm of the scale.
const ALIGNMENT: f64 = 1.0;

/// Greatest part of the alignment that may be lost, unless `|ln k|` is more than this then.
const MOST_LOST: f64 = 0.1;
const STRETCHED: f64 = 0.25;

/// Weights of an earlier use of a band, and of its distance from the middle as a share of the side.
const USED: f64 = 0.08;
const ASIDE: f64 = 0.1;

/// Coordinates that differ by less, as a share of the side, are one.
const NOISE: f64 = 1e-6;

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
/// O(c^2 r) for c columns and r rows of cuts, and O(n log n) for each band that is tried, for n regions.
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
        let (pieces, cut) = view.applied(&best.counts);
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

/// A band by its seams.
type Band = (f64, f64);

/// Counts of bands, and the side that they make.
struct BandCounts {
    counts: Vec<(Band, i64)>,
    side: f64,
}

/// A facade seen along one axis.
struct AxisView<'a> {
    pieces: Vec<Piece<'a>>,
    cuts: Vec<f64>,
    /// For each column of cuts and each row, the index of its piece.
    cells: Vec<Vec<usize>>,
    side: f64,
    noise: f64,
}

impl<'a> AxisView<'a> {
    fn new(facade: &'a Facade, axis: Axis) -> Result<Self, edifice_shape::LayoutError> {
        let layout = facade.indexed()?;
        let other = axis.other();
        let pieces = facade.regions.iter().map(|region| Piece {
            label: &region.label,
            along: (region.rect.start(axis), region.rect.end(axis)),
            across: (region.rect.start(other), region.rect.end(other)),
        });
        let cuts = match axis {
            Axis::X => layout.xs.values().to_vec(),
            Axis::Y => layout.ys.values().to_vec(),
        };
        let rows = match axis {
            Axis::X => layout.ys.values().len() - 1,
            Axis::Y => layout.xs.values().len() - 1,
        };
        let mut cells = vec![vec![0; rows]; cuts.len() - 1];
        for (index, span) in layout.spans.iter().enumerate() {
            let ((from, to), (low, high)) = (span.along(axis), span.along(other));
            for column in &mut cells[from..to] {
                column[low..high].fill(index);
            }
        }
        let side = cuts[cuts.len() - 1];
        Ok(Self {
            pieces: pieces.collect(),
            cuts,
            cells,
            side,
            noise: NOISE * facade.width.max(facade.height),
        })
    }

    fn same(&self, a: f64, b: f64) -> bool {
        (a - b).abs() <= self.noise
    }

    /// From each line the shortest band, ordered by its first seam.
    fn bands(&self, loose: bool) -> Vec<Band> {
        let columns = self.cells.len();
        let width = |k: usize| self.cuts[k + 1] - self.cuts[k];
        let mut found = Vec::new();
        for from in 0..columns {
            for to in from + 1..columns {
                let half = 0.5 * width(from).min(width(to));
                let band = (self.cuts[from] + half, self.cuts[to] + half);
                let share = (band.1 - band.0) / self.side;
                if share > BAND.1 {
                    break;
                }
                if share >= BAND.0 && self.alike((from, to), band, loose) && self.repeatable(band) {
                    found.push(band);
                    break;
                }
            }
        }
        found
    }

    /// True if the facade is the same along both seams.
    fn alike(&self, (from, to): (usize, usize), (a, b): Band, loose: bool) -> bool {
        (0..self.cells[from].len()).all(|row| {
            let [p, q] = [from, to].map(|column| self.cells[column][row]);
            if p == q {
                return true;
            }
            let (p, q) = (&self.pieces[p], &self.pieces[q]);
            if p.label != q.label {
                return false;
            }
            let level = self.same(p.across.0, q.across.0) && self.same(p.across.1, q.across.1);
            let length = |piece: &Piece| piece.along.1 - piece.along.0;
            let placed = self.same(a - p.along.0, b - q.along.0) && self.same(length(p), length(q));
            // Panes of one window are no window each.
            let apart = || (from + 1..to).any(|k| is_background(self.label(k, row)));
            let wide = length(p).min(length(q)) >= WIDE * self.side;
            is_background(p.label) || (level && ((placed && apart()) || (loose && wide)))
        })
    }

    fn label(&self, column: usize, row: usize) -> &str {
        self.pieces[self.cells[column][row]].label
    }

    /// True if a band has elements, and of no label all.
    fn repeatable(&self, (a, b): Band) -> bool {
        let mut counts: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
        for piece in self
            .pieces
            .iter()
            .filter(|piece| !is_background(piece.label))
        {
            let count = counts.entry(piece.label).or_default();
            count.0 += 1;
            let inside = piece.along.0 >= a - self.noise && piece.along.1 <= b + self.noise;
            count.1 += usize::from(inside);
        }
        let inside = counts.values().map(|count| count.1).sum::<usize>();
        inside > 0 && counts.values().all(|count| count.1 < count.0)
    }

    /// Counts of bands that keep all elements in line, else the panes, else none, where the stricter leaves too much to stretching.
    fn planned(&self, target: f64) -> BandCounts {
        let left = |plan: &BandCounts| (target / plan.side).ln().abs();
        let (strict, loose) = (self.bands(false), self.bands(true));
        let within = |kept: fn(&Shares, &Shares) -> f64| {
            let plan = self.plan(&strict, target, kept);
            if left(&plan) <= SCALE {
                return plan;
            }
            let other = self.plan(&loose, target, kept);
            if left(&other) < left(&plan) {
                other
            } else {
                plan
            }
        };
        let bounds: [fn(&Shares, &Shares) -> f64; 2] = [loss, loss_of_panes];
        let kept = bounds.into_iter().map(within);
        let found = kept.into_iter().find(|plan| left(plan) <= STRETCHED);
        found.unwrap_or_else(|| within(|_, _| 0.0))
    }

    /// Chooses the counts of bands so that at each step `kept` lose at most [`MOST_LOST`] of their alignment.
    fn plan(&self, bands: &[Band], target: f64, kept: fn(&Shares, &Shares) -> f64) -> BandCounts {
        let more = target > self.side;
        let before = shares(&self.pieces, self.noise);
        let mut plan = BandCounts {
            counts: bands.iter().map(|&band| (band, 0)).collect(),
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
                let overlaps = |&((from, to), count): &(Band, i64)| count < 0 && from < b && a < to;
                if side <= 0.0 || (!more && plan.counts.iter().any(overlaps)) {
                    continue;
                }
                let new_scale = (target / side).ln().abs();
                if new_scale < scale - 1e-9 {
                    let aside = (0.5 * (a + b) - 0.5 * self.side).abs() / self.side;
                    let rank = new_scale + USED * count.unsigned_abs() as f64 + ASIDE * aside;
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
                let after = shares(&self.applied(&counts).0, self.noise);
                if kept(&before, &after) > MOST_LOST {
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

    /// The pieces with bands more or less, and the labels of elements that seams changed.
    fn applied(&self, counts: &[(Band, i64)]) -> (Vec<Piece<'a>>, Vec<String>) {
        let mut used: Vec<(Band, i64)> = counts.iter().filter(|way| way.1 != 0).copied().collect();
        used.sort_by(|p, q| p.0.1.total_cmp(&q.0.1).then(p.0.0.total_cmp(&q.0.0)));
        let mut stretches = Vec::new();
        let mut at = 0.0;
        for ((a, b), count) in used {
            if count > 0 {
                stretches.push((at, b));
                stretches.extend((1..count).map(|_| (a, b)));
                at = a;
            } else {
                stretches.push((at, a));
                at = b;
            }
        }
        stretches.push((at, self.side));
        let mut out: Vec<Piece<'a>> = Vec::new();
        let mut cut = Vec::new();
        // Pieces that the last seam cut: where they are in `out`.
        let mut open: Vec<usize> = Vec::new();
        let mut offset = 0.0;
        for (start, end) in stretches {
            let mut next = Vec::new();
            for piece in &self.pieces {
                let (from, to) = (piece.along.0.max(start), piece.along.1.min(end));
                if to - from <= self.noise {
                    continue;
                }
                let place = |at: f64| at - start + offset;
                let begun = piece.along.0 < start - self.noise;
                let goes_on = piece.along.1 > end + self.noise;
                let before = begun.then(|| {
                    open.iter().find(|&&place| {
                        let known: &Piece = &out[place];
                        known.label == piece.label
                            && self.same(known.across.0, piece.across.0)
                            && self.same(known.across.1, piece.across.1)
                    })
                });
                let own = match before.flatten() {
                    Some(&known) => {
                        out[known].along.1 = place(to);
                        known
                    }
                    None => {
                        out.push(Piece {
                            along: (place(from), place(to)),
                            ..*piece
                        });
                        out.len() - 1
                    }
                };
                let length = out[own].along.1 - out[own].along.0;
                let whole = self.same(length, piece.along.1 - piece.along.0);
                if begun && !goes_on && !whole && !is_background(piece.label) {
                    cut.push(piece.label.to_owned());
                }
                if goes_on {
                    next.push(own);
                }
            }
            open = next;
            offset += end - start;
        }
        (out, cut)
    }
}

//! A facade seen along one axis, and its bands.

use std::collections::{BTreeMap, BTreeSet};

use super::apply::Band;
use super::contacts::Contacts;
use super::in_line::{Piece, is_wall};
use super::pitch::{of_one_kind, pitches};
use super::runs::Runs;
use edifice_shape::{Axis, Facade};

/// Shortest and longest band, as shares of the side.
const BAND: (f64, f64) = (0.04, 0.6);

/// Shortest and longest band of [`Columns::House`], as shares of the side.
const HOUSE: (f64, f64) = (0.8, 1.0);

/// Least length of a region through which a seam may go if it must, as a share of the side.
const WIDE: f64 = 0.07;

/// Least share of an element's length that is left when bands within it are taken away, unless it spans several columns.
const LEAST_LEFT: f64 = 0.3;

/// The label of what keeps its length unless it spans several columns.
const DOOR: &str = "door";

/// Regions across more than this share of the facade are cornices and the like.
const MOST_ACROSS: f64 = 0.5;

/// Greatest share of a band's elements that stand nowhere else.
const MOST_OWN: f64 = 0.6;

/// Greatest [`Repeat::new`].
const MOST_NEW: f64 = 0.25;

/// A band of floors is at least so many times as long as the least pitch of what it repeats: a floor comes with its cornice.
const CLOSEST: f64 = 0.95;

/// Coordinates that differ by less, as a share of the side, are one.
const NOISE: f64 = 1e-6;

/// A band that may be repeated or taken away.
pub(super) struct Repeat {
    pub(super) band: Band,
    /// The share of the facade across where that brings together what is nowhere together: 0 to [`MOST_NEW`].
    pub(super) new: f64,
}

/// Which columns (or floors) may be bands, from the strictest on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Columns {
    /// Those with seams between elements that do not have all regions of a label.
    Common,
    /// Also with seams through wide regions.
    Cut,
    /// Along x: also those that have all regions of a label, doors and what else stands lowest aside.
    Single,
    /// Along x: the whole facade from margin to margin, one house more.
    House,
}

/// A facade seen along one axis.
pub(super) struct AxisView<'a> {
    pub(super) pieces: Vec<Piece<'a>>,
    cuts: Vec<f64>,
    /// For each column of cuts and each row, the index of its piece.
    cells: Vec<Vec<usize>>,
    contacts: Contacts<'a>,
    /// The least pitch of floors by label; empty along x, where windows of one floor may well stand closer than those of another.
    pitch: BTreeMap<&'a str, f64>,
    pub(super) axis: Axis,
    /// Labels that stand lowest somewhere, doors and shops.
    lowest: BTreeSet<&'a str>,
    /// The lengths of the rows, across.
    rows: Vec<f64>,
    runs: Runs,
    length_across: f64,
    pub(super) side: f64,
    pub(super) noise: f64,
}

impl<'a> AxisView<'a> {
    pub(super) fn new(facade: &'a Facade, axis: Axis) -> Result<Self, edifice_shape::LayoutError> {
        let layout = facade.indexed()?;
        let other = axis.other();
        let pieces: Vec<Piece> = (facade.regions.iter())
            .map(|region| Piece {
                label: &region.label,
                along: (region.rect.start(axis), region.rect.end(axis)),
                across: (region.rect.start(other), region.rect.end(other)),
            })
            .collect();
        let cuts = match axis {
            Axis::X => layout.xs.values().to_vec(),
            Axis::Y => layout.ys.values().to_vec(),
        };
        let across = match axis {
            Axis::X => layout.ys.values(),
            Axis::Y => layout.xs.values(),
        };
        let rows: Vec<f64> = across.windows(2).map(|ends| ends[1] - ends[0]).collect();
        let mut cells = vec![vec![0; rows.len()]; cuts.len() - 1];
        for (index, span) in layout.spans.iter().enumerate() {
            let ((from, to), (low, high)) = (span.along(axis), span.along(other));
            for column in &mut cells[from..to] {
                column[low..high].fill(index);
            }
        }
        let side = cuts[cuts.len() - 1];
        let noise = NOISE * facade.width.max(facade.height);
        let length_across = rows.iter().sum::<f64>();
        // From the ground up, at each place across the axis that is not y.
        let upwards: Vec<Vec<usize>> = match axis {
            Axis::X => cells.clone(),
            Axis::Y => (0..rows.len())
                .map(|row| cells.iter().map(|column| column[row]).collect())
                .collect(),
        };
        // Plinths and cornices stand on nothing that would tell a column from others.
        let is_narrow = |p: &Piece| match axis {
            Axis::X => p.along.1 - p.along.0 < MOST_ACROSS * side,
            Axis::Y => p.across.1 - p.across.0 < MOST_ACROSS * length_across,
        };
        let first = |indices: &Vec<usize>| {
            let mut pieces = indices.iter().map(|&index| &pieces[index]);
            pieces.find(|p| !is_wall(p.label) && is_narrow(p))
        };
        let lowest = upwards.iter().filter_map(first).map(|p| p.label).collect();
        let pitch = match axis {
            Axis::X => BTreeMap::new(),
            Axis::Y => pitches(&pieces, noise),
        };
        Ok(Self {
            pitch,
            axis,
            lowest,
            contacts: Contacts::new(&pieces, &cells, side),
            runs: Runs::new(&pieces, &cells, noise),
            pieces,
            cuts,
            cells,
            rows,
            length_across,
            side,
            noise,
        })
    }

    fn same(&self, a: f64, b: f64) -> bool {
        (a - b).abs() <= self.noise
    }

    /// From each line the shortest band, and the shortest that brings nothing new together, ordered by the first seam.
    pub(super) fn bands(&self, which: Columns, more: bool) -> Vec<Repeat> {
        let columns = self.cells.len();
        // A house comes beside itself as it comes nowhere else.
        let ((shortest, longest), most_new) = match which {
            Columns::House => (HOUSE, 1.0),
            _ => (BAND, MOST_NEW),
        };
        let mut found: Vec<Repeat> = Vec::new();
        for from in 0..columns {
            let mut any = false;
            for to in from + 1..columns {
                if self.cuts[to] - self.cuts[from + 1] > longest * self.side {
                    break;
                }
                let fits = |&band: &Band| {
                    let share = (band.1 - band.0) / self.side;
                    (shortest..=longest).contains(&share)
                        && self.alike((from, to), band, which >= Columns::Cut, more)
                        && self.repeatable(band, which)
                        && (which >= Columns::Single || self.of_its_own(band) <= MOST_OWN)
                };
                let Some(band) = self.seams(from, to).into_iter().find(fits) else {
                    continue;
                };
                let new = self.new_contacts((from, to), band, more);
                if new <= most_new && (!any || new == 0.0) {
                    found.push(Repeat { band, new });
                }
                any = true;
                if new == 0.0 {
                    break;
                }
            }
        }
        found
    }

    /// Bands from one column of cuts to another: as long as a pitch of floors where there is one, else with both seams equally far
    /// behind their cuts.
    fn seams(&self, from: usize, to: usize) -> Vec<Band> {
        let mut lengths: Vec<f64> = self.pitch.values().copied().collect();
        lengths.sort_by(f64::total_cmp);
        lengths.dedup_by(|a, b| self.same(*a, *b));
        let of_length = |length: f64| {
            let low = self.cuts[from].max(self.cuts[to] - length);
            let high = self.cuts[from + 1].min(self.cuts[to + 1] - length);
            let start = 0.5 * (low + high);
            (high - low > self.noise).then_some((start, start + length))
        };
        let width = |k: usize| self.cuts[k + 1] - self.cuts[k];
        let half = 0.5 * width(from).min(width(to));
        let mut out: Vec<Band> = lengths.into_iter().filter_map(of_length).collect();
        out.push((self.cuts[from] + half, self.cuts[to] + half));
        out
    }

    /// The share of the facade across where a band more (or less) brings together what is nowhere together, or closer than anywhere.
    fn new_contacts(&self, (from, to): (usize, usize), (a, b): Band, more: bool) -> f64 {
        let (first, second) = match more {
            true => ((to, b), (from, a)),
            false => ((from, a), (to, b)),
        };
        let new = self.rows.iter().enumerate().filter(|&(row, _)| {
            let seam = &self.pieces[self.cells[from][row]];
            is_wall(seam.label) && !self.contacts.known(row, first, second)
        });
        new.map(|(_, length)| length).sum::<f64>() / self.length_across
    }

    /// True if the facade is the same along both seams of a band that is repeated (`more`) or taken away.
    fn alike(&self, (from, to): (usize, usize), (a, b): Band, loose: bool, more: bool) -> bool {
        (0..self.cells[from].len()).all(|row| {
            let [p, q] = [from, to].map(|column| self.cells[column][row]);
            if p == q {
                let p = &self.pieces[p];
                return is_wall(p.label) || self.gives_way(p, &[(a, b)], more);
            }
            let (p, q) = (&self.pieces[p], &self.pieces[q]);
            if p.label != q.label {
                return false;
            }
            let level = self.same(p.across.0, q.across.0) && self.same(p.across.1, q.across.1);
            let length = |piece: &Piece| piece.along.1 - piece.along.0;
            let placed = self.same(a - p.along.0, b - q.along.0) && self.same(length(p), length(q));
            // Panes of one window are no window each.
            let apart = || (from + 1..to).any(|k| is_wall(self.label(k, row)));
            let wide = length(p).min(length(q)) >= WIDE * self.side;
            is_wall(p.label) || (level && ((placed && apart()) || (loose && wide)))
        })
    }

    /// True if all regions give way to bands that are taken away together.
    pub(super) fn all_give_way(&self, bands: &[Band]) -> bool {
        let mut elements = self.pieces.iter().filter(|p| !is_wall(p.label));
        elements.all(|p| self.gives_way(p, bands, false))
    }

    /// True if an element may become longer (`more`) or shorter by the bands within it: because it spans several columns of which
    /// some are left, or, doors aside, because enough of its length is.
    fn gives_way(&self, piece: &Piece, bands: &[Band], more: bool) -> bool {
        let (start, end) = piece.along;
        let within = bands.iter().filter(|(a, b)| start < *a && *b < end);
        let change: f64 = within.map(|(a, b)| b - a).sum();
        let is_left = more || change <= (1.0 - LEAST_LEFT) * (end - start);
        let is_door = piece.label.eq_ignore_ascii_case(DOOR);
        change == 0.0 || (is_left && !is_door) || self.runs.remain(piece, bands)
    }

    fn label(&self, column: usize, row: usize) -> &str {
        self.pieces[self.cells[column][row]].label
    }

    fn is_inside(&self, piece: &Piece, (a, b): Band) -> bool {
        piece.along.0 >= a - self.noise && piece.along.1 <= b + self.noise
    }

    /// The share of a band's elements, by their length across, that have none of their label and about their size outside: an attic
    /// is no floor like others.
    fn of_its_own(&self, band: Band) -> f64 {
        let elements = self
            .pieces
            .iter()
            .filter(|p| is_element(p, self.length_across));
        let (within, outside): (Vec<&Piece>, Vec<&Piece>) =
            elements.partition(|p| self.is_inside(p, band));
        let own = (within.iter()).filter(|p| !outside.iter().any(|q| of_one_kind(p, q)));
        let own: f64 = own.map(|p| p.across.1 - p.across.0).sum();
        let all: f64 = within.iter().map(|p| p.across.1 - p.across.0).sum();
        if all > 0.0 { own / all } else { 0.0 }
    }

    /// True if no band of such columns has all regions of the label.
    fn is_fixed(&self, label: &str, which: Columns) -> bool {
        match (self.axis, which) {
            (Axis::X, Columns::Common | Columns::Cut) => true,
            (_, Columns::House) => false,
            (Axis::Y, _) | (_, Columns::Single) => self.lowest.contains(label),
        }
    }

    /// True if a band has elements, not all of a label that [is fixed](Self::is_fixed), and is not shorter than floors are.
    fn repeatable(&self, band: Band, which: Columns) -> bool {
        let mut counts: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
        let mut any = false;
        for piece in self.pieces.iter().filter(|piece| !is_wall(piece.label)) {
            let inside = self.is_inside(piece, band);
            let count = counts.entry(piece.label).or_default();
            count.0 += 1;
            count.1 += usize::from(inside);
            // Not every floor has a cornice.
            if inside && is_element(piece, self.length_across) {
                any = true;
                let pitch = self.pitch.get(piece.label).unwrap_or(&0.0);
                if band.1 - band.0 < CLOSEST * pitch {
                    return false;
                }
            }
        }
        let all = |(label, count): (&&str, &(usize, usize))| {
            count.1 == count.0 && self.is_fixed(label, which)
        };
        any && !counts.iter().any(all)
    }
}

/// True for what is neither wall nor across most of the facade, as cornices are.
fn is_element(piece: &Piece, length_across: f64) -> bool {
    !is_wall(piece.label) && piece.across.1 - piece.across.0 < MOST_ACROSS * length_across
}

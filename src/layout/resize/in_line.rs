//! Elements that have their like in line on the next floor, and how many of them are lost.

use std::collections::BTreeMap;

use edifice_shape::is_background;

/// Labels with fewer elements below a next floor, or a smaller share in line, have no alignment to lose.
const FEWEST: usize = 4;
const LEAST_SHARE: f64 = 0.15;

/// A region, or a part of one between two seams.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece<'a> {
    /// Its label.
    pub label: &'a str,
    /// Start and end along the axis.
    pub along: (f64, f64),
    /// Start and end across it.
    pub across: (f64, f64),
}

/// For each label of elements: the number below a next floor, and the share of them with their like in line there.
pub(super) fn shares<'a>(pieces: &[Piece<'a>], noise: f64) -> BTreeMap<&'a str, (usize, f64)> {
    let mut by_label: BTreeMap<&str, Vec<&Piece>> = BTreeMap::new();
    for piece in pieces.iter().filter(|piece| !is_background(piece.label)) {
        by_label.entry(piece.label).or_default().push(piece);
    }
    let share = |(label, mut own): (&'a str, Vec<&Piece>)| {
        own.sort_by(|p, q| p.across.0.total_cmp(&q.across.0));
        let (mut count, mut in_line) = (0, 0);
        for piece in &own {
            let next = own.partition_point(|other| other.across.0 < piece.across.1 - noise);
            let Some(lowest) = own.get(next) else {
                continue;
            };
            let floor = &own[next..];
            let top = floor
                .iter()
                .take_while(|other| other.across.0 <= lowest.across.0 + noise)
                .map(|other| other.across.1)
                .fold(f64::INFINITY, f64::min);
            count += 1;
            in_line += usize::from(floor.iter().take_while(|other| other.across.0 < top).any(
                |other| {
                    (other.along.0 - piece.along.0).abs() <= noise
                        && (other.along.1 - piece.along.1).abs() <= noise
                },
            ));
        }
        (label, (count, in_line as f64 / count.max(1) as f64))
    };
    by_label.into_iter().map(share).collect()
}

/// The greatest fall of a share.
pub(super) fn loss(
    before: &BTreeMap<&str, (usize, f64)>,
    after: &BTreeMap<&str, (usize, f64)>,
) -> f64 {
    before
        .iter()
        .filter(|(_, (count, share))| *count >= FEWEST && *share >= LEAST_SHARE)
        .map(|(label, (_, share))| share - after.get(label).map_or(0.0, |after| after.1))
        .fold(0.0, f64::max)
}

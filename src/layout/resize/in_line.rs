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

/// True for background, also of a numbered kind, as `Wall2` of the grammars of Wu et al.
pub(super) fn is_wall(label: &str) -> bool {
    is_background(label.trim_end_matches(|c: char| c.is_ascii_digit()))
}

/// For each label of elements: the number below a next floor, and the share of them with their like in line there.
pub(super) fn shares<'a>(pieces: &[Piece<'a>], noise: f64) -> Shares<'a> {
    let mut by_label: BTreeMap<&str, Vec<&Piece>> = BTreeMap::new();
    for piece in pieces.iter().filter(|piece| !is_wall(piece.label)) {
        by_label.entry(piece.label).or_default().push(piece);
    }
    let share = |(label, mut own): (&'a str, Vec<&Piece>)| {
        own.sort_by(|p, q| p.across.0.total_cmp(&q.across.0));
        // A floor is what begins below the top of its first piece.
        let mut floors: Vec<Vec<&Piece>> = Vec::new();
        for piece in own {
            match floors.last_mut() {
                Some(floor) if piece.across.0 < floor[0].across.1 - noise => floor.push(piece),
                _ => floors.push(vec![piece]),
            }
        }
        let (mut count, mut in_line) = (0, 0);
        for pair in floors.windows(2) {
            for piece in &pair[0] {
                let like = |other: &&Piece| {
                    (other.along.0 - piece.along.0).abs() <= noise
                        && (other.along.1 - piece.along.1).abs() <= noise
                };
                count += 1;
                in_line += usize::from(pair[1].iter().any(like));
            }
        }
        (label, (count, in_line as f64 / count.max(1) as f64))
    };
    by_label.into_iter().map(share).collect()
}

/// Shares of elements in line by label, as [`shares`] gives them.
pub(super) type Shares<'a> = BTreeMap<&'a str, (usize, f64)>;

/// The greatest fall of a share, as a part of it.
pub(super) fn loss(before: &Shares, after: &Shares) -> f64 {
    let labels = before.keys().map(|label| fall(label, before, after));
    labels.fold(0.0, f64::max)
}

/// The fall of the share of the panes: glass, or windows where there is none.
pub(super) fn loss_of_panes(before: &Shares, after: &Shares) -> f64 {
    let label = ["glass", "window"]
        .into_iter()
        .find(|l| before.contains_key(l));
    label.map_or(0.0, |label| fall(label, before, after))
}

/// The fall of the share of a label, as a part of it; 0 where it has no alignment to lose.
fn fall(label: &str, before: &Shares, after: &Shares) -> f64 {
    match before.get(label) {
        Some(&(count, share)) if count >= FEWEST && share >= LEAST_SHARE => {
            1.0 - after.get(label).map_or(0.0, |after| after.1) / share
        }
        _ => 0.0,
    }
}

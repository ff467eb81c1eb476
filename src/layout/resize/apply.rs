//! A facade with bands repeated or taken away.

use super::in_line::{Piece, is_wall};

/// A band by its seams.
pub(super) type Band = (f64, f64);

/// The pieces of a facade of length `side` with each band so many times more (or, below zero, taken away), and the labels of
/// elements that seams changed. Lengths that differ by at most `noise` are equal.
pub(super) fn apply<'a>(
    pieces: &[Piece<'a>],
    counts: &[(Band, i64)],
    side: f64,
    noise: f64,
) -> (Vec<Piece<'a>>, Vec<String>) {
    let same = |a: f64, b: f64| (a - b).abs() <= noise;
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
    stretches.push((at, side));
    let mut out: Vec<Piece<'a>> = Vec::new();
    let mut cut = Vec::new();
    // Pieces that the last seam cut: where they are in `out`.
    let mut open: Vec<usize> = Vec::new();
    let mut offset = 0.0;
    for (start, end) in stretches {
        let mut next = Vec::new();
        for piece in pieces {
            let (from, to) = (piece.along.0.max(start), piece.along.1.min(end));
            if to - from <= noise {
                continue;
            }
            let place = |at: f64| at - start + offset;
            let begun = piece.along.0 < start - noise;
            let goes_on = piece.along.1 > end + noise;
            let before = begun.then(|| {
                open.iter().find(|&&place| {
                    let known: &Piece = &out[place];
                    known.label == piece.label
                        && same(known.across.0, piece.across.0)
                        && same(known.across.1, piece.across.1)
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
            let whole = same(length, piece.along.1 - piece.along.0);
            if begun && !goes_on && !whole && !is_wall(piece.label) {
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

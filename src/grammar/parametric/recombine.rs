//! Two facades of a library become one: the strips of the first up to a strip that both have, then those of the second.
//!
//! A facade is a sequence of strips (its floors, or its bays), each a symbol with counts. Where a strip `i` of one
//! and a strip `j` of another agree in both, `a_1 ... a_i b_{j+1} ... b_m` is a sequence in which every strip
//! stands beside a strip that it stands beside already. The sequence is neither that of the first nor that of the second; the number
//! of strips stays between theirs. The second facade is drawn among those of the library. Across the strips the second facade is stretched so that the cuts of strip `j` fall on those of strip `i`,
//! piecewise linearly: what is in line with them in the second facade is so in the result. Along them it is scaled so
//! that both strips have one size. Elements must not stand less in line than in the first facade.

use rand::{Rng, RngExt};

use super::bands::out_of_line;
use super::error::LibraryError;
use super::library::{Library, Member};
use super::rules::{Rules, Symbol};
use super::tree::{Parse, slots};
use edifice_shape::{Axis, Facade, Rect, Region};

/// Facades that are tried as the second one.
const TRIES: usize = 40;

/// Greatest scale along the strips, and the inverse of the least.
const SCALE: f64 = 1.6;

/// A part of the root.
struct Strip {
    symbol: Symbol,
    /// Counts of all repeats in it.
    counts: Vec<u32>,
    /// Its terminals in the order of the derivation: the first, and one past the last.
    terminals: (usize, usize),
}

/// The direction of the root and its parts; none for a facade of one terminal.
fn strips(parse: &Parse, rules: &Rules) -> Option<(Axis, Vec<Strip>)> {
    let Symbol::Rule(root) = parse.root else {
        return None;
    };
    let rule = rules.rule(root);
    let repeats = rule.items.iter().filter(|item| item.is_repeat()).count();
    let (own, mut rest) = parse.counts.split_at_checked(repeats)?;
    let mut found = Vec::new();
    let mut from = 0;
    for slot in slots(rule, own) {
        let before = rest;
        let count = terminals(slot.symbol, rules, &mut rest)?;
        found.push(Strip {
            symbol: slot.symbol,
            counts: before[..before.len() - rest.len()].to_vec(),
            terminals: (from, from + count),
        });
        from += count;
    }
    Some((rule.axis, found))
}

/// True if the strips of the first up to `i` and those of the second from after `j` are not those of either.
fn is_new((own, i): (&[Strip], usize), (other, j): (&[Strip], usize)) -> bool {
    let joined = || own[..=i].iter().chain(&other[j + 1..]).map(|s| s.symbol);
    !joined().eq(own.iter().map(|s| s.symbol)) && !joined().eq(other.iter().map(|s| s.symbol))
}

/// The number of terminals of a symbol, whose counts are taken from the front.
fn terminals(symbol: Symbol, rules: &Rules, counts: &mut &[u32]) -> Option<usize> {
    let Symbol::Rule(rule) = symbol else {
        return Some(1);
    };
    let rule = rules.rule(rule);
    let repeats = rule.items.iter().filter(|item| item.is_repeat()).count();
    let (own, rest) = counts.split_at_checked(repeats)?;
    *counts = rest;
    let parts = slots(rule, own).into_iter();
    parts
        .map(|slot| terminals(slot.symbol, rules, counts))
        .sum()
}

impl Library {
    /// `facade`, which has the rules and counts of `first`, with the upper or right strips of another facade; none where no
    /// other facade was found that has a strip in common.
    pub(super) fn recombined<R: Rng>(
        &self,
        (first, facade): (&Member, &Facade),
        rng: &mut R,
    ) -> Result<Option<Facade>, LibraryError> {
        let Some((axis, own)) = strips(&first.parse, self.rules()) else {
            return Ok(None);
        };
        let members = self.members();
        for _ in 0..TRIES {
            let second = &members[rng.random_range(0..members.len())];
            let Some((other_axis, other)) = strips(&second.parse, self.rules()) else {
                continue;
            };
            if other_axis != axis {
                continue;
            }
            let range = own.len().min(other.len())..=own.len().max(other.len());
            let mut joints = Vec::new();
            for (i, a) in own.iter().enumerate() {
                for (j, b) in other.iter().enumerate() {
                    let same = a.symbol == b.symbol && a.counts == b.counts;
                    let whole = matches!(a.symbol, Symbol::Rule(_));
                    if same
                        && whole
                        && range.contains(&(i + other.len() - j))
                        && is_new((&own[..], i), (&other[..], j))
                    {
                        joints.push((i, j));
                    }
                }
            }
            if joints.is_empty() {
                continue;
            }
            let (i, j) = joints[rng.random_range(0..joints.len())];
            let upper = self.between(second, second, 0.0, &facade.name)?;
            let parts = [(facade, own[i].terminals), (&upper, other[j].terminals)];
            // Elements that stand in line in the first facade do so in the result.
            let in_line = |joined: &Facade| {
                let across = axis.other();
                out_of_line(joined, across) <= out_of_line(facade, across)
            };
            if let Some(joined) = joined(parts, axis, self.step()).filter(in_line) {
                return Ok(Some(joined));
            }
        }
        Ok(None)
    }
}

/// The regions of the first facade up to a strip, then those of the second from the end of one on. Strips are given by
/// their regions, which are as many in both. None where one of the second's regions would vanish, or the
/// scale is beyond [`SCALE`].
fn joined(
    [(first, (from, to)), (second, (start, end))]: [(&Facade, (usize, usize)); 2],
    axis: Axis,
    step: f64,
) -> Option<Facade> {
    let across = axis.other();
    let (strip, other) = (&first.regions[from..to], &second.regions[start..end]);
    let ends = |strip: &[Region]| {
        let edges = strip.iter().map(|r| (r.rect.start(axis), r.rect.end(axis)));
        edges.fold((f64::INFINITY, 0.0_f64), |all, own| {
            (all.0.min(own.0), all.1.max(own.1))
        })
    };
    let ((low, top), (other_low, seam)) = (ends(strip), ends(other));
    let scale = (top - low) / (seam - other_low);
    if !(SCALE.recip()..=SCALE).contains(&scale) {
        return None;
    }
    let mut cuts: Vec<(f64, f64)> = strip
        .iter()
        .zip(other)
        .flat_map(|(a, b)| {
            let ends = |r: &Region| [r.rect.start(across), r.rect.end(across)];
            ends(b).into_iter().zip(ends(a))
        })
        .collect();
    cuts.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.total_cmp(&q.1)));
    let rounded = |value: f64| (value / step).round() * step;
    let place_across = |at: f64| {
        let after = cuts.partition_point(|cut| cut.0 < at);
        let (right, left) = (
            cuts[after.min(cuts.len() - 1)],
            cuts[after.saturating_sub(1)],
        );
        match right.0 - left.0 {
            gap if gap > 0.0 => rounded(left.1 + (at - left.0) / gap * (right.1 - left.1)),
            _ => right.1,
        }
    };
    let place_along = |at: f64| top + rounded((at - seam) * scale);
    let mut regions = first.regions[..to].to_vec();
    for region in &second.regions[end..] {
        let places = [
            (
                axis,
                place_along(region.rect.start(axis)),
                place_along(region.rect.end(axis)),
            ),
            (
                across,
                place_across(region.rect.start(across)),
                place_across(region.rect.end(across)),
            ),
        ];
        if places
            .iter()
            .any(|(_, start, end)| end - start < 0.5 * step)
        {
            return None;
        }
        let of = |axis: Axis| {
            if places[0].0 == axis {
                places[0]
            } else {
                places[1]
            }
        };
        let ((_, x, right), (_, y, upper)) = (of(Axis::X), of(Axis::Y));
        let rect = Rect::new(x, y, right - x, upper - y);
        let label = region.label.clone();
        regions.push(Region { label, rect });
    }
    let end = regions.iter().map(|r| r.rect.end(axis)).fold(0.0, f64::max);
    let (width, height) = match axis {
        Axis::X => (end, first.height),
        Axis::Y => (first.width, end),
    };
    let made = Facade::new(
        first.name.clone(),
        first.unit.clone(),
        width,
        height,
        regions,
    )
    .ok()?;
    made.check_tiling().is_ok().then_some(made)
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;

    /// Floors from the ground up, `w` with windows and `b` with balconies below them, all of three columns, `unit` wide.
    fn house(name: &str, floors: &str, unit: f64) -> Facade {
        let mut regions = Vec::new();
        let width = 7.0 * unit;
        let mut at = 0.0;
        let mut put = |label: &str, x: f64, y: f64, w: f64, h: f64| {
            let label = label.to_owned();
            let rect = Rect::new(x, y, w, h);
            regions.push(Region { label, rect });
        };
        for floor in floors.chars() {
            put("wall", 0.0, at, width, 3.0);
            for k in 0..7 {
                let x = f64::from(k) * unit;
                match (k % 2, floor) {
                    (0, _) => put("wall", x, at + 3.0, unit, 9.0),
                    (_, 'b') => {
                        put("balcony", x, at + 3.0, unit, 3.0);
                        put("window", x, at + 6.0, unit, 6.0);
                    }
                    _ => put("window", x, at + 3.0, unit, 9.0),
                }
            }
            at += 12.0;
        }
        put("roof", 0.0, at, width, 5.0);
        Facade::new(name, "px", width, at + 5.0, regions).unwrap()
    }

    #[test]
    fn floors_of_two_facades_come_together_with_their_columns_in_line() {
        let all = [
            house("a", "wbw", 4.0),
            house("b", "bbww", 6.0),
            house("c", "wwwb", 5.0),
        ];
        let library = Library::learn(&all).unwrap();
        let mut new = 0;
        for k in 0..40 {
            let mut rng = stream(3, "recombine", k);
            let first = &library.members()[0];
            let own = library.between(first, first, 0.0, "own").unwrap();
            let Some(made) = library.recombined((first, &own), &mut rng).unwrap() else {
                continue;
            };
            made.check_tiling().unwrap();
            assert!(library.is_new(&made).unwrap());
            assert_eq!(made.width, 28.0);
            let windows = made.regions.iter().filter(|r| r.label == "window");
            let mut places: Vec<i64> = windows.map(|r| r.rect.x as i64).collect();
            places.sort_unstable();
            places.dedup();
            assert_eq!(places, [4, 12, 20]);
            new += 1;
        }
        assert!(new > 30, "{new} of 40");
    }
}

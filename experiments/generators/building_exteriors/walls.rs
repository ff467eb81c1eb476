//! Walls with windows and doors that have the drawn window-to-wall ratio, symmetry and alignment.
//!
//! Each side is cut into vertical strips ([`super::strips`]); the wall of one floor in one strip is a facade piece. A
//! strip is symmetric or not on all its floors; one strip of a side is cut in two so that the symmetric share comes
//! out as drawn.

use rand::seq::SliceRandom;
use rand::{Rng, RngExt};

use super::draw::Numbers;
use super::glaze::glaze;
use super::plan::FloorPlan;
use super::strips::{NARROWEST_FREE, Strip, Use, make_symmetric, strips};
use super::styles::Kinds;
use edifice_shape::{ElementStyle, FacadePiece, Side};

/// The facade pieces, or `None` when the numbers cannot be met.
pub(super) fn build(
    plan: &FloorPlan,
    numbers: &Numbers,
    kinds: &Kinds,
    rng: &mut impl Rng,
) -> Option<Vec<FacadePiece>> {
    let mut all = Vec::new();
    let made = strips(plan, numbers.floors)?;
    for (strips, symmetry) in made.into_iter().zip(numbers.symmetry) {
        all.extend(make_symmetric(strips, symmetry)?);
    }
    give_door(&mut all)?;
    choose_styles(&mut all, &kinds.windows, rng)?;

    let mut pieces = Vec::new();
    for (side, ratio) in Side::ALL.into_iter().zip(numbers.wwr) {
        let aligned = match kinds.alignment {
            0 => true,
            1 => matches!(side, Side::Front | Side::Back),
            _ => false,
        };
        let strips: Vec<&Strip> = all.iter().filter(|s| s.side == side).collect();
        pieces.extend(glaze(&strips, aligned, ratio, plan.floor_height)?);
    }
    Some(pieces)
}

/// A house without a porch in front has its door in the narrowest strip there.
fn give_door(strips: &mut [Strip]) -> Option<()> {
    let mut front: Vec<&mut Strip> = strips
        .iter_mut()
        .filter(|s| s.side == Side::Front)
        .collect();
    if front.iter().any(|s| s.has_door()) {
        return Some(());
    }
    let wide = front
        .iter_mut()
        .filter(|s| s.width() >= NARROWEST_FREE)
        .flat_map(|s| {
            let width = s.width();
            s.walls.iter_mut().map(move |w| (width, w))
        });
    let open = wide.filter(|(_, w)| w.floor == 0 && w.usage == Use::Windows);
    let (_, wall) = open.min_by(|a, b| a.0.total_cmp(&b.0))?;
    wall.usage = Use::Door;
    Some(())
}

/// Gives every strip with windows a window style, every present style at least one strip.
fn choose_styles(strips: &mut [Strip], styles: &[ElementStyle], rng: &mut impl Rng) -> Option<()> {
    let mut glazed: Vec<&mut Strip> = strips.iter_mut().filter(|s| s.is_glazed()).collect();
    if glazed.len() < styles.len() {
        return None;
    }
    glazed.shuffle(rng);
    for (i, strip) in glazed.into_iter().enumerate() {
        strip.style = match styles.get(i) {
            Some(style) => *style,
            None => styles[rng.random_range(0..styles.len())],
        };
    }
    for strip in strips.iter_mut().filter(|s| s.has_door()) {
        strip.style = styles[0];
    }
    Some(())
}

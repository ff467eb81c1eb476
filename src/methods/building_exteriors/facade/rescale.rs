//! Smaller windows on a side on which a door was hung when its windows stood already.

use super::glaze::{SLIMMEST, millimetres};
use super::room::FixedPiece;
use edifice_shape::{ElementStyle, FacadeElement, FacadePiece, Side};

/// Least scale: what is smaller is no window any more.
const LEAST: f64 = 0.5;

/// Scales the windows of a side around their middles, all alike, so that windows and doors cover no more than `ratio` of it; none below half
/// its size or 0.35 m. Pieces that are fixed stay as they are.
pub(super) fn shrink(pieces: &mut [FacadePiece], side: Side, ratio: f64, fixed: &[FixedPiece]) {
    let (mut wall, mut covered) = (0.0, 0.0);
    let mut windows: Vec<&mut FacadeElement> = Vec::new();
    for piece in pieces.iter_mut().filter(|p| p.side == side) {
        wall += piece.area();
        let is_free = fixed.iter().all(|f| f.piece != *piece);
        for e in &mut piece.elements {
            match is_free && e.style != ElementStyle::Door {
                true => windows.push(e),
                false => covered += e.width * e.height,
            }
        }
    }
    let size = |e: &FacadeElement, scale: f64| {
        [e.width, e.height].map(|extent| (scale * extent).max(extent.min(SLIMMEST)))
    };
    let fits = |scale: f64| {
        let areas = windows.iter().map(|e| size(e, scale)).map(|[w, h]| w * h);
        covered + areas.sum::<f64>() <= ratio * wall
    };
    if fits(1.0) {
        return;
    }
    let (mut low, mut high) = (LEAST, 1.0);
    for _ in 0..40 {
        let middle = (low + high) / 2.0;
        match fits(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    for e in windows {
        let [width, height] = size(e, low).map(millimetres);
        e.x = millimetres(e.x + (e.width - width) / 2.0);
        e.y = millimetres(e.y + (e.height - height) / 2.0);
        (e.width, e.height) = (width, height);
    }
}

#[cfg(test)]
mod tests {
    use super::super::glaze::DOOR;
    use super::*;

    fn piece(start: f64, elements: &[(ElementStyle, f64, [f64; 2])]) -> FacadePiece {
        let element =
            |&(style, x, [width, height]): &(ElementStyle, f64, [f64; 2])| FacadeElement {
                style,
                x,
                y: 0.5,
                width,
                height,
            };
        FacadePiece {
            side: Side::Back,
            start,
            base: 0.0,
            width: 5.0,
            height: 3.0,
            elements: elements.iter().map(element).collect(),
        }
    }

    #[test]
    fn windows_give_way_to_a_door_and_nothing_else_changes() {
        use ElementStyle::{Door, Sash};
        let free = [
            piece(0.0, &[(Door, 0.5, DOOR)]),
            piece(5.0, &[(Sash, 1.0, [2.0, 1.0]), (Sash, 4.0, [0.8, 1.0])]),
        ];
        let ratio = |pieces: &[FacadePiece]| {
            let elements = pieces.iter().flat_map(|p| &p.elements);
            elements.map(|e| e.width * e.height).sum::<f64>() / 30.0
        };
        // 4.9 square metres of 30, of which 2.8 are windows.
        let mut pieces = free.clone();
        shrink(&mut pieces, Side::Back, 0.12, &[]);
        assert!((ratio(&pieces) - 0.12).abs() < 1e-4);
        assert_eq!(pieces[0], free[0]);
        for (new, old) in pieces[1].elements.iter().zip(&free[1].elements) {
            let middle = |e: &FacadeElement| [e.x + e.width / 2.0, e.y + e.height / 2.0];
            assert!((0..2).all(|k| (middle(new)[k] - middle(old)[k]).abs() < 2e-3));
        }
        // Never below half the size, never larger, not on other sides, and not what is fixed.
        let mut least = free.clone();
        shrink(&mut least, Side::Back, 0.0, &[]);
        assert_eq!(least[1].elements[0].width, 1.0);
        let fixed = [FixedPiece {
            piece: free[1].clone(),
            at: 0.0,
        }];
        for (side, wanted, fixed) in [
            (Side::Back, 0.2, &[][..]),
            (Side::Left, 0.1, &[]),
            (Side::Back, 0.1, &fixed),
        ] {
            let mut same = free.clone();
            shrink(&mut same, side, wanted, fixed);
            assert_eq!(same, free);
        }
    }
}

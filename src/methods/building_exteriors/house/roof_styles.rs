//! Roof styles on boxes, as the style attributes want them.

use edifice_shape::{BoxStyle, MassBox, Ridge, RoofStyle};

/// Gives every box a roof so that the flagged styles (flat, gable, hip), and no others, occur: the one that most of
/// the area has already is the main one, the others go to porches, the garage and small boxes. Ridges run along the
/// longer side. Without any flag all roofs are sheds, which no attribute tells. Frozen boxes keep their roofs.
pub(super) fn roof(boxes: &mut [MassBox], flags: [bool; 3], frozen: &[MassBox]) {
    let is_free: Vec<bool> = boxes.iter().map(|b| !frozen.contains(b)).collect();
    let styles = [RoofStyle::Flat, RoofStyle::Gable, RoofStyle::Hip];
    let flagged: Vec<RoofStyle> = styles
        .into_iter()
        .zip(flags)
        .filter(|(_, f)| *f)
        .map(|(s, _)| s)
        .collect();
    let area = |b: &MassBox| b.width * b.depth;
    let shown = |s: RoofStyle| {
        let own = boxes
            .iter()
            .filter(|b| b.roof.style == s && b.style == BoxStyle::Main);
        own.map(area).sum::<f64>()
    };
    let main = flagged
        .iter()
        .copied()
        .max_by(|a, b| shown(*a).total_cmp(&shown(*b)))
        .unwrap_or(RoofStyle::Shed);
    let free = |boxes: &mut [MassBox], change: &dyn Fn(&mut MassBox)| {
        let free = boxes.iter_mut().zip(&is_free).filter(|(_, f)| **f);
        free.for_each(|(b, _)| change(b));
    };
    free(boxes, &|b| {
        b.roof.style = main;
        b.roof.ridge = if b.width >= b.depth {
            Ridge::X
        } else {
            Ridge::Y
        };
    });
    let mut order: Vec<usize> = (0..boxes.len()).filter(|&i| is_free[i]).collect();
    let rank = |b: &MassBox| match b.style {
        BoxStyle::Porch => 0,
        BoxStyle::Garage => 1,
        BoxStyle::Main => 2,
    };
    order.sort_by(|&i, &j| {
        let (a, b) = (&boxes[i], &boxes[j]);
        rank(a).cmp(&rank(b)).then(area(a).total_cmp(&area(b)))
    });
    let others: Vec<RoofStyle> = flagged
        .into_iter()
        .filter(|s| *s != main && frozen.iter().all(|b| b.roof.style != *s))
        .collect();
    for (style, i) in others.into_iter().zip(order) {
        boxes[i].roof.style = style;
    }
    free(boxes, &|b| {
        b.roof.pitch = match b.roof.style {
            RoofStyle::Flat => 0.0,
            RoofStyle::Shed => 12.0,
            _ if b.roof.pitch > 5.0 => b.roof.pitch,
            _ => 30.0,
        };
    });
}

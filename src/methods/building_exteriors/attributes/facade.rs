//! Facade attributes `F_c` (Appendix A.2): window-to-wall ratio, symmetry and alignment, each of
//! the front, back, left and right side.

use edifice_shape::{Building, FacadeElement, FacadePiece, Side};

/// Offsets up to this share of a floor height count as none.
const TOLERANCE: f64 = 0.02;

/// The twelve facade attributes; those of a side without pieces are missing.
pub(super) fn attributes(building: &Building) -> Vec<Option<f64>> {
    let tolerance = TOLERANCE * building.floor_height;
    let sides = Side::ALL.map(|side| {
        let on_side = building.facades.iter().filter(|f| f.side == side);
        on_side.collect::<Vec<&FacadePiece>>()
    });
    let each = |measure: &dyn Fn(&[&FacadePiece]) -> f64| {
        let values = sides.iter().map(|pieces| match pieces.as_slice() {
            [] => None,
            pieces => Some(measure(pieces)),
        });
        values.collect::<Vec<_>>()
    };
    let mut out = each(&window_to_wall);
    out.extend(each(&|pieces| symmetry(pieces, tolerance)));
    out.extend(each(&|pieces| alignment(pieces, tolerance)));
    out
}

fn total_area(pieces: &[&FacadePiece]) -> f64 {
    pieces.iter().map(|f| f.area()).sum()
}

fn window_to_wall(pieces: &[&FacadePiece]) -> f64 {
    let elements = pieces.iter().flat_map(|f| &f.elements);
    elements.map(|e| e.rect().area()).sum::<f64>() / total_area(pieces)
}

fn symmetry(pieces: &[&FacadePiece], tolerance: f64) -> f64 {
    let symmetric = pieces.iter().filter(|f| is_symmetric(f, tolerance));
    symmetric.map(|f| f.area()).sum::<f64>() / total_area(pieces)
}

/// True if the mirror image of every element meets an element of the same style.
fn is_symmetric(piece: &FacadePiece, tolerance: f64) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= tolerance;
    piece.elements.iter().all(|e| {
        let mirrored = piece.width - e.x - e.width;
        piece.elements.iter().any(|o| {
            o.style == e.style
                && near(o.x, mirrored)
                && near(o.y, e.y)
                && near(o.width, e.width)
                && near(o.height, e.height)
        })
    })
}

/// `N_align / N_candi`; 0 without candidates.
fn alignment(pieces: &[&FacadePiece], tolerance: f64) -> f64 {
    let (mut candidates, mut aligned) = (0_u32, 0_u32);
    for lower in pieces {
        for upper in pieces {
            if upper.base < lower.base + lower.height - tolerance {
                continue;
            }
            if let Some(is_aligned) = aligned_pair(lower, upper, tolerance) {
                candidates += 1;
                aligned += u32::from(is_aligned);
            }
        }
    }
    if candidates == 0 {
        return 0.0;
    }
    f64::from(aligned) / f64::from(candidates)
}

/// True if two stacked pieces are aligned; `None` when they cannot be.
fn aligned_pair(a: &FacadePiece, b: &FacadePiece, tolerance: f64) -> Option<bool> {
    let start = a.start.max(b.start);
    let end = (a.start + a.width).min(b.start + b.width);
    if end - start <= tolerance {
        return None;
    }
    let (a, b) = (marks(a, start, end), marks(b, start, end));
    if a.is_empty() || b.is_empty() {
        return None;
    }
    let (few, many) = if a.len() <= b.len() { (a, b) } else { (b, a) };
    let meets = |p: &[f64; 3], q: &[f64; 3]| (0..3).any(|k| (p[k] - q[k]).abs() <= tolerance);
    Some(few.iter().all(|p| many.iter().any(|q| meets(p, q))))
}

/// Left edge, centre and right edge of the elements centred between `start` and `end`.
fn marks(piece: &FacadePiece, start: f64, end: f64) -> Vec<[f64; 3]> {
    let marks = piece.elements.iter().map(|e: &FacadeElement| {
        let left = piece.start + e.x;
        [left, left + e.width / 2.0, left + e.width]
    });
    marks.filter(|m| (start..=end).contains(&m[1])).collect()
}

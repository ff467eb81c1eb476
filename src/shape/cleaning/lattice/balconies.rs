//! Balconies of the floors of a facade.

use super::boxes::{Box4, filled, median};

/// A balcony this wide, as a share of the facade, runs from side to side.
const RUNNING: f64 = 0.8;

/// The balconies of one floor.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Balconies {
    /// One from side to side.
    Running(Box4),
    /// Some before columns, none among them.
    Single(Vec<Box4>),
}

impl Balconies {
    /// Their boxes.
    pub(super) fn boxes(&self) -> &[Box4] {
        match self {
            Self::Running(one) => std::slice::from_ref(one),
            Self::Single(some) => some,
        }
    }
}

/// The balconies of all floors, whose windows have the lower and upper sides `rows`, before columns of the sides
/// `columns` on a facade of the given width.
pub(super) fn balconies(
    found: &[Box4],
    rows: &[[f64; 2]],
    columns: &[[f64; 2]],
    width: f64,
) -> Vec<Balconies> {
    let mut of_floor: Vec<Vec<Box4>> = vec![Vec::new(); rows.len()];
    for b in found {
        // The floor whose windows begin nearest to where the balcony ends, within a window's height.
        let distance = |row: &[f64; 2]| (row[0] - b.y[1]).abs().min((row[0] - b.y[0]).abs());
        let nearest =
            (0..rows.len()).min_by(|&i, &j| distance(&rows[i]).total_cmp(&distance(&rows[j])));
        if let Some(floor) = nearest
            && distance(&rows[floor]) <= rows[floor][1] - rows[floor][0]
        {
            of_floor[floor].push(*b);
        }
    }
    of_floor
        .into_iter()
        .map(|own| on_floor(own, columns, width))
        .collect()
}

fn on_floor(own: Vec<Box4>, columns: &[[f64; 2]], width: f64) -> Balconies {
    let (running, single): (Vec<Box4>, Vec<Box4>) = own
        .into_iter()
        .partition(|b| b.x[1] - b.x[0] >= RUNNING * width);
    let y = |boxes: &[Box4]| [0, 1].map(|end| median(boxes.iter().map(|b| b.y[end]).collect()));
    if !running.is_empty() {
        let x = [0.0, width];
        return Balconies::Running(Box4 { x, y: y(&running) });
    }
    let covers = |b: &Box4, column: &[f64; 2]| {
        let shared = b.x[1].min(column[1]) - b.x[0].max(column[0]);
        shared >= 0.5 * (column[1] - column[0])
    };
    // Those over several columns reach from the first to the last of them.
    let mut has = vec![false; columns.len()];
    let mut out = Vec::new();
    for b in &single {
        let before = (0..columns.len()).filter(|&c| covers(b, &columns[c]));
        match before.collect::<Vec<_>>()[..] {
            [first, .., last] => out.push(Box4 {
                x: [columns[first][0], columns[last][1]],
                y: y(&single),
            }),
            [only] => has[only] = true,
            [] => {}
        }
    }
    let narrow = columns.iter().zip(filled(has)).filter(|(_, has)| *has);
    out.extend(narrow.map(|(&x, _)| Box4 { x, y: y(&single) }));
    Balconies::Single(out)
}

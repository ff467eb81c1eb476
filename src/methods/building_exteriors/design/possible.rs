//! Rows of attributes drawn from a model given that a house can have them.
//!
//! The groups of the model are Gaussian, and independent but for their edges: a part of its rows has a porch outside
//! the bounding box, a share of the windows below zero, two storeys in the height of one. The paper repairs them
//! (Sec. 7: the attributes of a sample conflict). Here the model is truncated to rows that need next to no repair, by
//! rejection, and with storeys of 2.3 to 4.5 m; its density is otherwise as it was learned.

use super::observed::wanted_rows;
use crate::mass::max_z;
use crate::mass::repair::repair;
use crate::mass::target::floors;
use edifice_model::Table;

/// Most that a repair moves a number of a possible row, in standard deviations.
pub const MOVED: f64 = 0.25;
/// Highest storey of a dwelling (m): a sample of two storeys' height whose shares of the floors say one has none such.
const MOST_STOREY: f64 = 4.5;
/// Lowest storey in which a door stands (m).
const LEAST_STOREY: f64 = 2.3;
/// The 39 numbers.
const NUMBERS: usize = 39;
/// Batches of as many rows as are wanted before the search for possible rows ends.
const BATCHES: usize = 20;

/// Rows that a house can have.
#[derive(Debug, Clone, PartialEq)]
pub struct Possible {
    /// The 49 columns of each row, in the order drawn.
    pub rows: Vec<[f64; 49]>,
    /// Rows drawn in all.
    pub drawn: usize,
    /// Those of `rows` that are not possible, the last ones: nothing better was drawn.
    pub impossible: usize,
}

/// `count` rows that a house can have, from batches of `count` rows that `draw` makes; `given` columns are not
/// repaired. `reach` is a further distance in standard deviations, of a row from what can be built on a footprint, 0
/// without one. Where 20 batches have too few of them, the rows nearest to possible ones fill the rest.
///
/// # Errors
/// Those of `draw`.
pub fn possible_rows<E>(
    count: usize,
    given: &[bool; 49],
    deviations: &[f64; 49],
    reach: impl Fn(&[f64; 49]) -> f64,
    mut draw: impl FnMut() -> Result<Table, E>,
) -> Result<Possible, E> {
    let (mut rows, mut others) = (Vec::with_capacity(count), Vec::new());
    let mut drawn = 0;
    for _ in 0..BATCHES {
        for row in wanted_rows(&draw()?) {
            if rows.len() == count {
                break;
            }
            drawn += 1;
            let mut repaired = row;
            repair(&mut repaired, given, deviations);
            let moved = max_z(&repaired[..NUMBERS], &row[..NUMBERS], deviations);
            let moved = moved.max(reach(&row));
            let storey = row[2] / floors(&row) as f64;
            let usual = (LEAST_STOREY..=MOST_STOREY).contains(&storey);
            match moved <= MOVED && usual {
                true => rows.push(row),
                false => others.push((moved, row)),
            }
        }
        if rows.len() == count {
            break;
        }
    }
    let impossible = (count - rows.len()).min(others.len());
    others.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.extend(others.into_iter().take(impossible).map(|(_, row)| row));
    Ok(Possible {
        rows,
        drawn,
        impossible,
    })
}

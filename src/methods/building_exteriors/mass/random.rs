//! Random arrangements of general boxes around given parts.

use rand::{Rng, RngExt};

use super::scheme::{Block, PLAIN};
use super::target::MassTarget;
use crate::shape::Roof;

/// Smallest box (m).
const SMALLEST: f64 = 1.5;

/// One to six overlapping boxes that span the bounding box of the target where its parts do not, in metres from
/// its corner. Each box meets one before it; the first has all floors.
pub fn blocks(target: &MassTarget, roof: Option<Roof>, rng: &mut impl Rng) -> Vec<Block> {
    let (w, d) = (target.extent(0), target.extent(1));
    let count = rng.random_range(1..=6);
    let mut blocks: Vec<Block> = Vec::with_capacity(count);
    for i in 0..count {
        let extents = [w, d].map(|e| {
            let least = SMALLEST.min(e);
            let share: f64 = rng.random_range(0.15..1.0);
            (share * e).clamp(least, e)
        });
        let edges = [0, 1].map(|axis| {
            let room = [w, d][axis] - extents[axis];
            // Corners are where boxes of houses like to be.
            let low = match rng.random_range(0..4) {
                0 => 0.0,
                1 => room,
                _ => room * rng.random::<f64>(),
            };
            [low, low + extents[axis]]
        });
        let floors = match i {
            0 => target.floors,
            _ => rng.random_range(1..=target.floors),
        };
        let block = Block {
            edges,
            floors,
            roof: roof.unwrap_or(PLAIN),
            frozen: false,
        };
        if i == 0 || blocks.iter().any(|b| meet(b, &block)) {
            blocks.push(block);
        }
    }
    stretch(&mut blocks, target);
    blocks
}

fn meet(a: &Block, b: &Block) -> bool {
    (0..2).all(|axis| {
        a.edges[axis][1].min(b.edges[axis][1]) - a.edges[axis][0].max(b.edges[axis][0]) > 0.5
    })
}

/// Moves the outermost edges to the bounding box.
fn stretch(blocks: &mut [Block], target: &MassTarget) {
    for axis in [0, 1] {
        let extent = target.extent(axis);
        let lowest = blocks.iter().map(|b| b.edges[axis][0]).fold(extent, f64::min);
        let highest = blocks.iter().map(|b| b.edges[axis][1]).fold(0.0, f64::max);
        for block in blocks.iter_mut() {
            let [low, high] = &mut block.edges[axis];
            if *low == lowest && lowest < 0.35 * extent {
                *low = 0.0;
            }
            if *high == highest && highest > 0.65 * extent {
                *high = extent;
            }
        }
    }
}

//! Random arrangements of general boxes around given parts.

use rand::{Rng, RngExt};

use super::scheme::{Block, PLAIN};
use super::target::MassTarget;
use edifice_shape::Roof;

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
    stretch(&mut blocks, target, rng);
    blocks
}

/// The blocks with one of them moved, resized, removed or added, or with other floors.
pub fn changed(blocks: &[Block], target: &MassTarget, rng: &mut impl Rng) -> Vec<Block> {
    let mut out = blocks.to_vec();
    let free: Vec<usize> = (0..out.len()).filter(|&i| !out[i].frozen).collect();
    let Some(&i) = free.get(rng.random_range(0..free.len().max(1))) else {
        return out;
    };
    match rng.random_range(0..6) {
        0 if out.len() > 1 => {
            out.remove(i);
        }
        1 => out[i].floors = rng.random_range(1..=target.floors),
        2 => {
            let added = random_block(target, rng);
            out.push(added);
        }
        3 => out[i] = random_block(target, rng),
        _ => {
            for axis in 0..2 {
                let reach = 0.3 * target.extent(axis);
                for end in 0..2 {
                    if rng.random() {
                        out[i].edges[axis][end] += rng.random_range(-reach..reach);
                    }
                }
                let [a, b] = out[i].edges[axis].map(|v| v.clamp(0.0, target.extent(axis)));
                out[i].edges[axis] = [a.min(b), a.max(b)];
            }
        }
    }
    if out.iter().all(|b| b.floors < target.floors) {
        let k = rng.random_range(0..out.len());
        out[k].floors = target.floors;
    }
    stretch(&mut out, target, rng);
    out
}

fn random_block(target: &MassTarget, rng: &mut impl Rng) -> Block {
    let edges = [0, 1].map(|axis| {
        let extent = target.extent(axis);
        let size = extent * rng.random_range(0.15..0.9);
        let low = (extent - size) * rng.random::<f64>();
        [low, low + size]
    });
    Block {
        edges,
        floors: rng.random_range(1..=target.floors),
        roof: PLAIN,
        frozen: false,
    }
}

fn meet(a: &Block, b: &Block) -> bool {
    (0..2).all(|axis| {
        a.edges[axis][1].min(b.edges[axis][1]) - a.edges[axis][0].max(b.edges[axis][0]) > 0.5
    })
}

/// Moves the outermost edges to the bounding box, where a part touches it in half of the cases only.
fn stretch(blocks: &mut [Block], target: &MassTarget, rng: &mut impl Rng) {
    for axis in [0, 1] {
        let extent = target.extent(axis);
        let parts = target.parts.iter().flatten();
        let ends: Vec<f64> = parts.flat_map(|p| [p.x, p.y][axis]).collect();
        let [low_free, high_free] = [0.0, extent].map(|end| ends.contains(&end) && rng.random());
        let lowest = blocks
            .iter()
            .map(|b| b.edges[axis][0])
            .fold(extent, f64::min);
        let highest = blocks.iter().map(|b| b.edges[axis][1]).fold(0.0, f64::max);
        for block in blocks.iter_mut().filter(|b| !b.frozen) {
            let [low, high] = &mut block.edges[axis];
            if *low == lowest {
                *low = if low_free {
                    lowest.max(0.1 * extent)
                } else {
                    0.0
                };
            }
            if *high == highest {
                *high = if high_free {
                    highest.min(0.9 * extent)
                } else {
                    extent
                };
            }
            if *high - *low < 0.5 {
                (*low, *high) = ((*low - 0.5).max(0.0), (*high + 0.5).min(extent));
            }
        }
    }
}

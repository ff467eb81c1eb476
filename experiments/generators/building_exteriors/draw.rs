//! The numbers of a house given the kinds of its attributes. Here are the nine dependencies: every
//! mean that mentions another attribute is linear in it.

use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

use super::styles::{GARAGES, GaragePlace, Kinds};

/// The wanted numbers of the plan and the walls; lengths in metres, positions as shares of the bounding box of the
/// ground floor, before a mirrored house is mirrored.
#[derive(Debug, Clone)]
pub(super) struct Numbers {
    pub width: f64,
    pub depth: f64,
    pub floors: usize,
    pub floor_height: f64,
    pub bcr: f64,
    pub bdry: f64,
    /// Shares of the floors in the total floor area.
    pub arf: [f64; 3],
    /// Length by which the front rooms stand out.
    pub front_step: f64,
    /// Length by which the wall beside a garage steps in, if the garage is beside the house.
    pub side_step: f64,
    /// Length by which the wall behind a garage steps in, if the garage is behind the house.
    pub yard: f64,
    pub garage: Option<Part>,
    pub place: Option<GaragePlace>,
    pub front_porch: Option<Part>,
    pub back_porch: Option<Part>,
    /// Length by which the back wall steps in beside a back porch.
    pub back_step: f64,
    /// Front, back, left, right.
    pub wwr: [f64; 4],
    pub symmetry: [f64; 4],
}

/// A garage or porch: its centre as shares of the bounding box, its size in metres.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub depth: f64,
    pub height: f64,
}

/// Mean width, depth (m) and floors of the kinds of `bbox`.
const BBOX: [(f64, f64, usize); 5] = [
    (13.0, 11.5, 1),
    (18.0, 11.5, 1),
    (13.0, 12.0, 2),
    (17.0, 13.5, 2),
    (13.5, 12.5, 3),
];
const BCR: [f64; 3] = [0.86, 0.80, 0.74];
const BDRY: [f64; 2] = [5.06, 5.36];
/// Mean of [`Numbers::front_step`] (m).
const FRONT_STEP: f64 = 1.6;
const WWR: [[f64; 4]; 3] = [
    [0.13, 0.12, 0.07, 0.08],
    [0.18, 0.19, 0.10, 0.12],
    [0.23, 0.25, 0.14, 0.15],
];
const SYMMETRY: [[f64; 4]; 3] = [
    [0.72, 0.74, 0.70, 0.71],
    [0.55, 0.68, 0.70, 0.68],
    [0.38, 0.36, 0.45, 0.43],
];

pub(super) fn numbers(kinds: &Kinds, rng: &mut impl Rng) -> Numbers {
    let mut noise = |sd: f64| sd * truncated(rng);

    let (w, d, floors) = BBOX[kinds.bbox];
    let common = noise(1.0);
    let width = w + 0.6 * common + noise(0.9);
    let depth = d + 0.3 * common + noise(0.6);
    let floor_height = 2.9 + noise(0.06);
    let height = floor_height * floors as f64;

    // Wide houses cover less of their bounding box; longer and barer outlines have more boundary.
    let bcr = BCR[kinds.bcr] - 0.009 * (width - 14.0) + noise(0.005);
    let bdry = BDRY[kinds.bdry] + 0.03 * (width - 14.0) - 3.0 * (bcr - 0.8) + noise(0.02);
    // Where the ground floor covers more, the floors above have a smaller share.
    let lean = 0.5 * (bcr - 0.8);
    let arf = match kinds.arf {
        0 => [1.0, 0.0, 0.0],
        1 => two_floors(0.665 + lean + noise(0.004)),
        2 => two_floors(0.73 + lean + noise(0.004)),
        _ => {
            let ground = 0.56 + lean + noise(0.004);
            let first = 0.62 * (1.0 - ground) + noise(0.003);
            [ground, first, 1.0 - ground - first]
        }
    };

    let place = GARAGES[kinds.garage].map(|(_, place)| place);
    let garage = GARAGES[kinds.garage].map(|(cars, place)| {
        // Large houses have large garages.
        let w = [3.5, 5.7][cars - 1] + 0.14 * (width - 14.0) + noise(0.07);
        let d = 5.7 + 0.12 * (depth - 12.0) + noise(0.07);
        let in_left = 0.5 + noise(0.12) + w / 2.0;
        let in_front = noise(0.09) + d / 2.0;
        let y = match place {
            GaragePlace::Front => 0.45 + in_front,
            GaragePlace::Beside => FRONT_STEP + 0.7 + in_front,
            GaragePlace::Behind => depth - 0.45 - in_front,
        };
        Part {
            x: in_left / width,
            y: y / depth,
            width: w,
            depth: d,
            height: 2.45 + 0.04 * (height - 3.0) + noise(0.03),
        }
    });
    // The front porch follows the garage, which stands on its left, and grows with the house. Where a house is
    // mirrored, the distance is linear in the garage's place from the other side; its height tells that there is one.
    let beside = garage.map_or([0.0; 4], |g| [g.x, g.y, g.width, g.height]);
    let from_right = match garage {
        Some(g) if kinds.mirrored => 0.42 * g.height - 1.0,
        _ => 0.0,
    };
    let front_porch = matches!(kinds.porch, 1 | 2).then(|| Part {
        x: 0.12 + beside[0] + 0.04 * beside[2] + from_right + noise(0.004),
        y: 0.10 + 0.05 * beside[1] + noise(0.002),
        width: 2.3 + 0.15 * (width - 14.0) + noise(0.06),
        depth: 1.8 + noise(0.06),
        height: 2.45 + 0.05 * beside[3] + noise(0.02),
    });
    let back_porch = matches!(kinds.porch, 2 | 3).then(|| {
        let d = 1.9 + 0.1 * (depth - 12.0) + noise(0.05);
        Part {
            x: 0.90 + noise(0.004),
            y: 1.0 - (0.4 + noise(0.05) + d / 2.0) / depth,
            width: 2.2 + 0.1 * (width - 14.0) + noise(0.06),
            depth: d,
            height: 2.4 + noise(0.03),
        }
    });
    let front_step = FRONT_STEP + noise(0.05);
    let side_step = 3.2 + noise(0.05);
    let yard = 3.0 + noise(0.05);
    let back_step = 1.4 + noise(0.06);
    let wwr = WWR[kinds.wwr].map(|mean| mean + noise(0.008));
    let symmetry = SYMMETRY[kinds.symmetry].map(|mean| mean + noise(0.025));

    Numbers {
        width,
        depth,
        floors,
        floor_height,
        bcr,
        bdry,
        arf,
        front_step,
        side_step,
        yard,
        garage,
        place,
        front_porch,
        back_porch,
        back_step,
        wwr,
        symmetry,
    }
}

fn two_floors(ground: f64) -> [f64; 3] {
    [ground, 1.0 - ground, 0.0]
}

/// A standard normal draw within 2.5 standard deviations: builders avoid extremes.
fn truncated(rng: &mut impl Rng) -> f64 {
    loop {
        let z: f64 = StandardNormal.sample(rng);
        if z.abs() < 2.5 {
            return z;
        }
    }
}

//! A city from a known grammar: 48 types of buildings, 8 motifs of 6 types each, and for each building the
//! truth: its type, its motif and the heights where its storeys change.
//!
//! A type is a stack of one to three blocks: rectangle, L, U, T or octagon, of its own proportions. A motif is six types
//! at fixed offsets. Motifs stand on a street grid, turned by quarters of the grid's angle. Noise, a share, moves
//! buildings and changes their sizes.

use rand::{Rng, RngExt};
use rand_distr::{Distribution, StandardNormal};

use edifice_base::rng::stream;
use edifice_shape::triangles::{City, CityBuilding, TriangleMesh, polygon_triangles};

/// Types of buildings.
pub const TYPES: usize = 48;
/// Motifs.
pub const MOTIFS: usize = 8;
/// Types in a motif.
const MEMBERS: usize = TYPES / MOTIFS;
/// Side of a motif's plot, in metres.
const PLOT: f64 = 150.0;

/// The known truth about a building.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// Its type.
    pub kind: usize,
    /// Heights where its blocks meet.
    pub cuts: Vec<f64>,
}

/// A block of a type: outline in the unit square, share of the type's plan, height in metres.
#[derive(Debug, Clone)]
struct Block {
    outline: Vec<[f64; 2]>,
    size: [f64; 2],
    height: f64,
}

/// A city of `motifs` motif instances, six buildings each, with noise `noise` (0.03: 3 %).
pub fn city(motifs: usize, noise: f64, seed: u64) -> (City, Vec<Truth>) {
    let mut rng = stream(seed, "synthetic city", 0);
    let kinds: Vec<Vec<Block>> = (0..TYPES).map(|k| kind(k, &mut rng)).collect();
    let places: Vec<[[f64; 3]; MEMBERS]> = (0..MOTIFS).map(|_| motif(&mut rng)).collect();
    let side = (motifs as f64).sqrt().ceil() as usize;
    let mut city = City {
        name: "synthetic".to_owned(),
        ..City::default()
    };
    let mut truths = Vec::new();
    for m in 0..motifs {
        let number = rng.random_range(0..MOTIFS);
        let middle = [(m % side) as f64 * PLOT, (m / side) as f64 * PLOT];
        let quarter = f64::from(rng.random_range(0..4u8)) * std::f64::consts::FRAC_PI_2;
        for (slot, &[x, y, turn]) in places[number].iter().enumerate() {
            let kind = number * MEMBERS + slot;
            let mut wobble = |scale: f64| {
                let z: f64 = StandardNormal.sample(&mut rng);
                noise * scale * z
            };
            let shift = [wobble(20.0), wobble(20.0)];
            let scale = [1.0 + wobble(1.0), 1.0 + wobble(1.0), 1.0 + wobble(1.0)];
            let (sin, cos) = quarter.sin_cos();
            let at = [
                middle[0] + x * cos - y * sin + shift[0],
                middle[1] + x * sin + y * cos + shift[1],
            ];
            let (mesh, cuts) = building(&kinds[kind], at, quarter + turn, scale);
            city.buildings.push(CityBuilding {
                id: format!("{m}-{slot}"),
                attributes: serde_json::Map::new(),
                mesh,
                ..CityBuilding::default()
            });
            truths.push(Truth { kind, cuts });
        }
    }
    (city, truths)
}

/// Outlines in the square from -1/2 to 1/2, counterclockwise, cut by `t` and `u` between 0 and 1.
fn outline(shape: usize, t: f64, u: f64) -> Vec<[f64; 2]> {
    let (a, b) = (t - 0.5, u - 0.5);
    match shape {
        0 => vec![[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]],
        1 => vec![
            [-0.5, -0.5],
            [0.5, -0.5],
            [0.5, b],
            [a, b],
            [a, 0.5],
            [-0.5, 0.5],
        ],
        2 => vec![
            [-0.5, -0.5],
            [0.5, -0.5],
            [0.5, 0.5],
            [t / 2.0, 0.5],
            [t / 2.0, b],
            [-t / 2.0, b],
            [-t / 2.0, 0.5],
            [-0.5, 0.5],
        ],
        3 => vec![
            [-t / 2.0, -0.5],
            [t / 2.0, -0.5],
            [t / 2.0, b],
            [0.5, b],
            [0.5, 0.5],
            [-0.5, 0.5],
            [-0.5, b],
            [-t / 2.0, b],
        ],
        _ => {
            let c = 0.15 + 0.2 * t;
            vec![
                [-0.5 + c, -0.5],
                [0.5 - c, -0.5],
                [0.5, -0.5 + c],
                [0.5, 0.5 - c],
                [0.5 - c, 0.5],
                [-0.5 + c, 0.5],
                [-0.5, 0.5 - c],
                [-0.5, -0.5 + c],
            ]
        }
    }
}

/// A type: no two have the same sequence of outlines and cuts.
fn kind(k: usize, rng: &mut impl Rng) -> Vec<Block> {
    let mut size = [rng.random_range(18.0..28.0), rng.random_range(12.0..17.0)];
    let blocks = 1 + k % 3;
    (0..blocks)
        .map(|b| {
            if b > 0 {
                size = size.map(|s| s * rng.random_range(0.55..0.75));
            }
            let t = 0.25 + 0.1 * ((k / 15) as f64) + rng.random_range(0.0..0.05);
            let u = 0.3 + 0.12 * ((k / 5 % 3) as f64) + rng.random_range(0.0..0.05);
            Block {
                outline: outline((k + b) % 5, t, u),
                size,
                height: rng.random_range(6.0..24.0f64).round(),
            }
        })
        .collect()
}

/// Places of a motif's members: a ring of six, within the reach of the type graph, each turned.
fn motif(rng: &mut impl Rng) -> [[f64; 3]; MEMBERS] {
    std::array::from_fn(|i| {
        let angle = i as f64 * std::f64::consts::TAU / MEMBERS as f64;
        let radius = rng.random_range(24.0..27.0);
        [
            radius * angle.cos(),
            radius * angle.sin(),
            angle + rng.random_range(0.0..0.3),
        ]
    })
}

/// The closed surface of a stack of blocks, and the heights where they meet.
fn building(
    blocks: &[Block],
    at: [f64; 2],
    turn: f64,
    scale: [f64; 3],
) -> (TriangleMesh, Vec<f64>) {
    let (sin, cos) = turn.sin_cos();
    let mut mesh = TriangleMesh::default();
    let (mut z, mut cuts) = (0.0, Vec::new());
    for block in blocks {
        let place = |p: &[f64; 2]| {
            let (x, y) = (
                p[0] * block.size[0] * scale[0],
                p[1] * block.size[1] * scale[1],
            );
            [at[0] + x * cos - y * sin, at[1] + x * sin + y * cos]
        };
        let ring: Vec<[f64; 2]> = block.outline.iter().map(place).collect();
        let top = z + block.height * scale[2];
        for (i, p) in ring.iter().enumerate() {
            let q = ring[(i + 1) % ring.len()];
            let (a, b) = ([p[0], p[1], z], [q[0], q[1], z]);
            let (c, d) = ([q[0], q[1], top], [p[0], p[1], top]);
            mesh.push([a, b, c]);
            mesh.push([a, c, d]);
        }
        let level = |z: f64| vec![ring.iter().map(|p| [p[0], p[1], z]).collect::<Vec<_>>()];
        polygon_triangles(&level(top))
            .into_iter()
            .for_each(|t| mesh.push(t));
        for t in polygon_triangles(&level(z)) {
            mesh.push([t[0], t[2], t[1]]);
        }
        cuts.push(top);
        z = top;
    }
    cuts.pop();
    (mesh, cuts)
}

//! Streets, blocks, lots, roofs and trees.

use rand::RngExt;

use super::Type;
use edifice_base::rng::Stream;
use edifice_scene::{Group, Instance, Material, Mesh, Scene};

/// Length of a block along x, without its pavement, in metres.
const BLOCK: f32 = 104.0;
/// Depth of the yards between the two rows of a block.
const YARD: f32 = 9.0;
/// Deepest building that a row takes.
const ROW: f32 = 16.0;
/// Width of a street between pavements.
const STREET: f32 = 11.0;
/// Width of a pavement.
const PAVEMENT: f32 = 3.5;
/// Open country around the town, from one side to the other without the town.
const COUNTRY: f32 = 12_000.0;
/// One block in this many is a park.
const PARK: u32 = 24;

/// Meshes that every town needs.
pub(super) struct Kit {
    cube: usize,
    pavement: usize,
    asphalt: usize,
    lawn: usize,
    flat: usize,
    gable: usize,
    tree: usize,
}

impl Kit {
    /// Adds the meshes and materials to an empty scene.
    pub(super) fn new(scene: &mut Scene, materials: &mut Vec<Material>) -> Self {
        let mut material = |name: &str, color: [u8; 3]| {
            let name = name.to_owned();
            let roughness = 0.95;
            materials.push(Material {
                name,
                color,
                roughness,
            });
            materials.len() - 1
        };
        let chimney = material("chimney", [0x8b, 0x5a, 0x4a]);
        let pavement = material("pavement", [0xb4, 0xb0, 0xa9]);
        let asphalt = material("asphalt", [0x58, 0x5a, 0x5e]);
        let lawn = material("lawn", [0x7c, 0x9a, 0x5d]);
        let flat = material("flat roof", [0x8d, 0x8a, 0x86]);
        let tiles = material("roof tiles", [0x9a, 0x55, 0x43]);
        let leaves = material("leaves", [0x5a, 0x82, 0x48]);
        let trunk = material("trunk", [0x6b, 0x4d, 0x38]);
        let mut add = |name: &str, positions: Vec<[f32; 3]>, parts: Vec<(usize, Vec<u32>)>| {
            let name = name.to_owned();
            scene.meshes.push(Mesh {
                name,
                positions,
                parts,
            });
            scene.meshes.len() - 1
        };
        let (corners, faces) = cube();
        let mut boxed =
            |name: &str, material| add(name, corners.clone(), vec![(material, faces.clone())]);
        let cube = boxed("chimney", chimney);
        let pavement = boxed("pavement", pavement);
        let asphalt = boxed("asphalt", asphalt);
        let lawn = boxed("lawn", lawn);
        let flat = boxed("flat roof", flat);
        // A prism over the unit square, ridge along x, 1 high.
        let prism = vec![
            [-0.5, 0.0, -0.5],
            [0.5, 0.0, -0.5],
            [0.5, 0.0, 0.5],
            [-0.5, 0.0, 0.5],
            [-0.5, 1.0, 0.0],
            [0.5, 1.0, 0.0],
        ];
        let sides = vec![
            3, 2, 5, 3, 5, 4, 1, 0, 4, 1, 4, 5, 2, 1, 5, 0, 3, 4, 0, 1, 2, 0, 2, 3,
        ];
        let gable = add("pitched roof", prism, vec![(tiles, sides)]);
        let (positions, crown, stem) = tree();
        let tree = add("tree", positions, vec![(leaves, crown), (trunk, stem)]);
        Self {
            cube,
            pavement,
            asphalt,
            lawn,
            flat,
            gable,
            tree,
        }
    }
}

/// Corners and triangles of a cube that stands on the origin's plane, 1 wide and high.
fn cube() -> (Vec<[f32; 3]>, Vec<u32>) {
    let square = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let corners = [0.0, 1.0]
        .into_iter()
        .flat_map(|y| square.map(|(x, z)| [x, y, z]));
    let mut faces = vec![0, 1, 2, 0, 2, 3, 4, 7, 6, 4, 6, 5];
    for i in 0..4 {
        let j = (i + 1) % 4;
        faces.extend([i, i + 4, j + 4, i, j + 4, j]);
    }
    (corners.collect(), faces)
}

/// A tree 1 high: a ball of few faces on a stem.
fn tree() -> (Vec<[f32; 3]>, Vec<u32>, Vec<u32>) {
    const AROUND: u32 = 7;
    let rings = [(0.28, 0.16), (0.45, 0.3), (0.68, 0.32), (0.9, 0.18)];
    let mut positions: Vec<[f32; 3]> = Vec::new();
    for (height, radius) in rings {
        for k in 0..AROUND {
            let (sin, cos) = (std::f32::consts::TAU * k as f32 / AROUND as f32).sin_cos();
            positions.push([radius * cos, height, radius * sin]);
        }
    }
    let (top, bottom) = (positions.len() as u32, positions.len() as u32 + 1);
    positions.extend([[0.0, 1.0, 0.0], [0.0, 0.22, 0.0]]);
    let mut crown = Vec::new();
    let last = (rings.len() as u32 - 1) * AROUND;
    for k in 0..AROUND {
        let next = (k + 1) % AROUND;
        crown.extend([bottom, k, next, last + k, top, last + next]);
        for ring in 0..rings.len() as u32 - 1 {
            let (low, high) = (ring * AROUND, (ring + 1) * AROUND);
            crown.extend([
                low + k,
                high + k,
                high + next,
                low + k,
                high + next,
                low + next,
            ]);
        }
    }
    let base = positions.len() as u32;
    let (corners, faces) = cube();
    positions.extend(
        corners
            .iter()
            .map(|[x, y, z]| [x * 0.06, y * 0.3, z * 0.06]),
    );
    let stem = faces.iter().map(|i| base + i).collect();
    (positions, crown, stem)
}

/// From the middle of a block to that of the next, along both sides.
const PITCH: [f32; 2] = [
    BLOCK + 2.0 * PAVEMENT + STREET,
    2.0 * ROW + YARD + 2.0 * PAVEMENT + STREET,
];

/// Place on the z axis of the middle of the street beside the block at the origin.
pub(super) fn middle_of_street() -> f32 {
    PITCH[1] / 2.0
}

/// Builds blocks around the origin, the nearest first, until enough buildings stand.
pub(super) fn town(kit: &Kit, types: &[Type], buildings: usize, rng: &mut Stream) -> Vec<Group> {
    let pitch = PITCH;
    // A block takes at least four buildings: this many blocks are surely enough.
    let reach = (buildings as f64 / 4.0).sqrt().ceil() as i32 + 2;
    let mut blocks: Vec<(i32, i32)> = (-reach..=reach)
        .flat_map(|i| (-reach..=reach).map(move |j| (i, j)))
        .collect();
    let distance = |&(i, j): &(i32, i32)| (i as f32 * pitch[0]).hypot(j as f32 * pitch[1]);
    blocks.sort_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
    let mut ground = Group {
        name: "ground".into(),
        yaw: 0.0,
        translation: [0.0; 3],
        instances: Vec::new(),
    };
    let mut groups = Vec::with_capacity(buildings + 1);
    let mut radius = 0.0f32;
    for block in blocks {
        if groups.len() >= buildings {
            break;
        }
        radius = radius.max(distance(&block));
        let middle = [block.0 as f32 * pitch[0], block.1 as f32 * pitch[1]];
        let size = [
            BLOCK + 2.0 * PAVEMENT,
            0.16,
            2.0 * ROW + YARD + 2.0 * PAVEMENT,
        ];
        let slab = |mesh, size, y| Instance {
            scale: size,
            ..Instance::at(mesh, [middle[0], y, middle[1]])
        };
        ground.instances.push(slab(kit.pavement, size, 0.0));
        if rng.random_range(0..PARK) == 0 {
            ground
                .instances
                .push(slab(kit.lawn, [BLOCK, 0.1, 2.0 * ROW + YARD], 0.16));
            for _ in 0..45 {
                let x = middle[0] + rng.random_range(-0.48..0.48) * BLOCK;
                let z = middle[1] + rng.random_range(-0.46..0.46) * (2.0 * ROW + YARD);
                ground.instances.push(tree_at(kit, x, z, rng));
            }
            continue;
        }
        ground
            .instances
            .push(slab(kit.lawn, [BLOCK - 1.0, 0.08, YARD + ROW], 0.16));
        for side in [1.0, -1.0f32] {
            row(kit, types, middle, side, buildings, &mut groups, rng);
        }
        let mut x = middle[0] - BLOCK / 2.0;
        while x < middle[0] + BLOCK / 2.0 {
            for side in [1.0, -1.0] {
                if rng.random_range(0..3) == 0 {
                    let z = middle[1] + side * (ROW + YARD / 2.0 + PAVEMENT * 0.7);
                    ground.instances.push(tree_at(kit, x, z, rng));
                }
            }
            x += 12.0;
        }
    }
    let span = 2.0 * (radius + pitch[0]);
    ground.instances.push(Instance {
        scale: [span, 0.1, span],
        ..Instance::at(kit.asphalt, [0.0, -0.1, 0.0])
    });
    ground.instances.push(Instance {
        scale: [span + COUNTRY, 0.1, span + COUNTRY],
        ..Instance::at(kit.lawn, [0.0, -0.25, 0.0])
    });
    groups.push(ground);
    groups
}

fn tree_at(kit: &Kit, x: f32, z: f32, rng: &mut Stream) -> Instance {
    let size = rng.random_range(4.5..9.0f32);
    Instance {
        mesh: kit.tree,
        scale: [size * rng.random_range(0.8..1.1), size, size],
        yaw: rng.random_range(0.0..6.0),
        translation: [x, 0.16, z],
    }
}

/// A row of buildings along one long side of a block, facing the street.
fn row(
    kit: &Kit,
    types: &[Type],
    middle: [f32; 2],
    side: f32,
    buildings: usize,
    groups: &mut Vec<Group>,
    rng: &mut Stream,
) {
    let mut at = 0.0;
    loop {
        let kind = &types[rng.random_range(0..types.len())];
        let gap = rng.random_range(1.5..5.0f32);
        if at + kind.width > BLOCK || groups.len() >= buildings {
            return;
        }
        let along = at + kind.width / 2.0 - BLOCK / 2.0;
        let back = ROW + YARD / 2.0 - kind.depth / 2.0 - rng.random_range(0.2..1.2f32);
        groups.push(Group {
            name: format!("building {}", groups.len() + 1),
            yaw: if side > 0.0 {
                0.0
            } else {
                std::f32::consts::PI
            },
            translation: [middle[0] + side * along, 0.16, middle[1] + side * back],
            instances: building(kit, kind, rng),
        });
        at += kind.width + gap;
    }
}

/// Facades, roof and chimneys around the origin.
fn building(kit: &Kit, kind: &Type, rng: &mut Stream) -> Vec<Instance> {
    let mut instances = kind.walls().to_vec();
    let (over, rise) = match kind.pitched {
        true => (0.8, 0.32 * kind.depth),
        false => (0.5, 0.4),
    };
    let mesh = if kind.pitched { kit.gable } else { kit.flat };
    instances.push(Instance {
        scale: [kind.width + over, rise, kind.depth + over],
        ..Instance::at(mesh, [0.0, kind.height, 0.0])
    });
    for _ in 0..rng.random_range(1..4) {
        let x = kind.width * rng.random_range(-0.42..0.42);
        let z = kind.depth * rng.random_range(-0.15..0.15);
        instances.push(Instance {
            scale: [rng.random_range(0.6..1.4), rise + 1.1, 0.7],
            ..Instance::at(kit.cube, [x, kind.height, z])
        });
    }
    instances
}

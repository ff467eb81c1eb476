//! Flat ways, hedges and trees around houses, as instances of a few meshes.

use edifice_base::rng::Stream;
use edifice_scene::{Group, Instance, Material, Mesh, Scene};
use rand::RngExt;

/// Segments around a crown, and rings from its foot to its top.
const AROUND: usize = 9;
const RINGS: usize = 6;
/// Different crowns.
const CROWNS: usize = 4;

/// Kinds of slabs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Road,
    Pavement,
    Path,
    Drive,
    Hedge,
    Trunk,
}

/// Each kind with its name and colour.
const KINDS: [(Kind, &str, [u8; 3]); 6] = [
    (Kind::Road, "road", [92, 94, 98]),
    (Kind::Pavement, "pavement", [168, 165, 158]),
    (Kind::Path, "path", [190, 178, 156]),
    (Kind::Drive, "drive", [150, 147, 142]),
    (Kind::Hedge, "hedge", [70, 96, 54]),
    (Kind::Trunk, "trunk", [98, 78, 60]),
];
/// Colours of crowns.
const LEAVES: [[u8; 3]; CROWNS] = [[84, 116, 58], [98, 126, 66], [74, 104, 62], [112, 128, 64]];

/// Instances of kinds of slabs, and of crowns.
#[derive(Default)]
pub(super) struct Garden {
    slabs: Vec<(Kind, Instance)>,
    crowns: Vec<(usize, Instance)>,
}

impl Garden {
    /// A slab on the ground, `x` to the right and `y` away from the street, `high` metres high.
    pub(super) fn slab(&mut self, kind: Kind, x: [f64; 2], y: [f64; 2], high: f64) {
        let instance = Instance {
            scale: [x[1] - x[0], high, y[1] - y[0]].map(|v| v as f32),
            ..Instance::at(0, [x[0] as f32, 0.0, -y[1] as f32])
        };
        self.slabs.push((kind, instance));
    }

    /// A tree of a height.
    pub(super) fn tree(&mut self, [x, y]: [f64; 2], high: f64, rng: &mut Stream) {
        let trunk = 0.03 * high;
        self.slab(
            Kind::Trunk,
            [x - trunk, x + trunk],
            [y - trunk, y + trunk],
            0.5 * high,
        );
        let radius = high * rng.random_range(0.24..0.3);
        let crown = Instance {
            scale: [radius, 0.38 * high, radius].map(|v| v as f32),
            yaw: rng.random_range(0.0..std::f32::consts::TAU),
            ..Instance::at(0, [x, 0.62 * high, -y].map(|v| v as f32))
        };
        self.crowns.push((rng.random_range(0..CROWNS), crown));
    }

    /// Adds all of it to a scene as one group.
    pub(super) fn add_to(self, scene: &mut Scene) {
        let mut instances = Vec::new();
        let mut add = |scene: &mut Scene, name: &str, color, mesh: Mesh, own: Vec<Instance>| {
            if own.is_empty() {
                return;
            }
            let (material, number) = (scene.materials.len(), scene.meshes.len());
            scene.materials.push(Material {
                name: name.into(),
                color,
                roughness: 0.95,
            });
            let parts = mesh.parts.into_iter().map(|(_, t)| (material, t));
            scene.meshes.push(Mesh {
                parts: parts.collect(),
                ..mesh
            });
            instances.extend(own.into_iter().map(|i| Instance { mesh: number, ..i }));
        };
        for (kind, name, color) in KINDS {
            let own = self.slabs.iter().filter(|s| s.0 == kind).map(|s| s.1);
            add(scene, name, color, cube(name), own.collect());
        }
        for (k, color) in LEAVES.into_iter().enumerate() {
            let name = format!("crown_{}", k + 1);
            let own = self.crowns.iter().filter(|c| c.0 == k).map(|c| c.1);
            add(scene, &name, color, crown(&name, k), own.collect());
        }
        if !instances.is_empty() {
            scene.groups.push(Group {
                name: "garden".into(),
                yaw: 0.0,
                translation: [0.0; 3],
                instances,
            });
        }
    }
}

/// The unit cube without its foot.
fn cube(name: &str) -> Mesh {
    let corner = |k: usize| [k & 1, k >> 1 & 1, k >> 2 & 1].map(|v| v as f32);
    let faces: [[u32; 4]; 5] = [
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = faces
        .iter()
        .flat_map(|f| [f[0], f[1], f[2], f[0], f[2], f[3]]);
    Mesh {
        name: name.into(),
        positions: (0..8).map(corner).collect(),
        parts: vec![(0, triangles.collect())],
    }
}

/// A rough ball of radius 1, the rougher the larger the wave of its kind.
fn crown(name: &str, kind: usize) -> Mesh {
    let mut positions = vec![[0.0, -1.0, 0.0]];
    for ring in 1..RINGS {
        let polar = std::f32::consts::PI * ring as f32 / RINGS as f32;
        for k in 0..AROUND {
            // Rings are turned against each other, so that edges do not line up.
            let turn = (k as f32 + 0.5 * ring as f32) / AROUND as f32;
            let (sin, cos) = (std::f32::consts::TAU * turn).sin_cos();
            let wave = ((k * 7 + ring * 5 + kind * 3) % 11) as f32 / 11.0;
            let radius = 0.86 + 0.28 * wave;
            let [across, up] = [radius * polar.sin(), -radius * polar.cos()];
            positions.push([across * cos, up, across * sin]);
        }
    }
    positions.push([0.0, 1.0, 0.0]);
    let (last, at) = (positions.len() as u32 - 1, |ring: usize, k: usize| {
        (1 + (ring - 1) * AROUND + k % AROUND) as u32
    });
    let mut triangles: Vec<u32> = Vec::new();
    for k in 0..AROUND {
        triangles.extend([0, at(1, k), at(1, k + 1)]);
        for ring in 1..RINGS - 1 {
            let (a, b) = (at(ring, k), at(ring, k + 1));
            let (c, d) = (at(ring + 1, k), at(ring + 1, k + 1));
            triangles.extend([a, c, b, b, c, d]);
        }
        triangles.extend([at(RINGS - 1, k), last, at(RINGS - 1, k + 1)]);
    }
    Mesh {
        name: name.into(),
        positions,
        parts: vec![(0, triangles)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume by the divergence theorem: positive where triangles are counterclockwise seen from outside.
    fn volume(mesh: &Mesh) -> f32 {
        let six = mesh.parts[0].1.chunks_exact(3).map(|t| {
            let [a, b, c] = [0, 1, 2].map(|k| mesh.positions[t[k] as usize]);
            a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        });
        six.sum::<f32>() / 6.0
    }

    #[test]
    fn surfaces_look_outward() {
        // The missing foot lies in the plane through the origin and adds nothing.
        assert!((volume(&cube("cube")) - 1.0).abs() < 1e-6);
        for kind in 0..CROWNS {
            let own = volume(&crown("crown", kind));
            assert!((2.0..5.0).contains(&own), "{own}");
        }
    }
}

//! A scene of instanced triangle meshes, in metres, y up, right-handed (the frame of glTF).

pub mod palette;
pub mod relief;
pub mod render;
pub mod textures;
pub mod trace;
mod vectors;

/// A surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name, for example the label that it shows.
    pub name: String,
    /// Colour, sRGB.
    pub color: [u8; 3],
    /// From 0, a mirror, to 1, chalk.
    pub roughness: f32,
}

/// Triangles, stored once and shown by any number of instances.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// Name.
    pub name: String,
    /// Corners.
    pub positions: Vec<[f32; 3]>,
    /// Triangles by material: index of the material, three indices of corners a triangle,
    /// counterclockwise seen from outside.
    pub parts: Vec<(usize, Vec<u32>)>,
}

impl Mesh {
    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.parts
            .iter()
            .map(|(_, indices)| indices.len() / 3)
            .sum()
    }
}

/// A mesh in its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instance {
    /// Index of the mesh.
    pub mesh: usize,
    /// Factors along the mesh's axes, applied first.
    pub scale: [f32; 3],
    /// Turn about the y axis in radians, z towards x, applied second.
    pub yaw: f32,
    /// Shift, applied last.
    pub translation: [f32; 3],
}

impl Instance {
    /// An instance that only shifts.
    pub fn at(mesh: usize, translation: [f32; 3]) -> Self {
        Self {
            mesh,
            scale: [1.0; 3],
            yaw: 0.0,
            translation,
        }
    }

    /// The place of a point of the mesh in the frame of the group.
    pub fn place(&self, p: [f32; 3]) -> [f32; 3] {
        let [x, y, z] = [0, 1, 2].map(|i| p[i] * self.scale[i]);
        let (sin, cos) = self.yaw.sin_cos();
        let turned = [x * cos + z * sin, y, z * cos - x * sin];
        [0, 1, 2].map(|i| turned[i] + self.translation[i])
    }
}

/// Instances that stand and move together, such as a building.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Name.
    pub name: String,
    /// Turn about the y axis in radians, applied to the instances first.
    pub yaw: f32,
    /// Shift, applied last.
    pub translation: [f32; 3],
    /// The instances, in the group's own frame.
    pub instances: Vec<Instance>,
}

impl Group {
    /// The place of a point of the group's frame in the scene.
    pub fn place(&self, p: [f32; 3]) -> [f32; 3] {
        let frame = Instance {
            yaw: self.yaw,
            ..Instance::at(0, self.translation)
        };
        frame.place(p)
    }
}

/// All that a picture shows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    /// Surfaces.
    pub materials: Vec<Material>,
    /// Meshes.
    pub meshes: Vec<Mesh>,
    /// The groups of instances.
    pub groups: Vec<Group>,
}

impl Scene {
    /// Triangles shown: those of each mesh times its instances.
    pub fn triangles(&self) -> u64 {
        let counts: Vec<u64> = self.meshes.iter().map(|m| m.triangles() as u64).collect();
        let instances = self.groups.iter().flat_map(|g| &g.instances);
        instances.map(|i| counts[i.mesh]).sum()
    }

    /// Triangles stored.
    pub fn stored_triangles(&self) -> u64 {
        self.meshes.iter().map(|m| m.triangles() as u64).sum()
    }
}

//! Houses as scenes: colours by pre-designed templates (Sec. 6), one mesh a house.

use super::model::FINISHES;
use edifice_scene::palette::{Look, Palette};
use edifice_scene::textures::Texture;
use edifice_scene::{Group, Instance, Material, Mesh, Scene};
use edifice_shape::solid::{Finish, Surface};

/// Colours of wall, roof, trim, door; the rest is the same for all.
const TEMPLATES: [[[u8; 3]; 4]; 8] = [
    [
        [226, 214, 190],
        [96, 72, 62],
        [244, 241, 234],
        [120, 52, 40],
    ],
    [[186, 198, 204], [72, 76, 84], [246, 246, 244], [44, 66, 92]],
    [
        [214, 186, 152],
        [112, 60, 46],
        [238, 230, 214],
        [70, 88, 64],
    ],
    [
        [240, 236, 226],
        [84, 88, 92],
        [250, 250, 248],
        [150, 60, 44],
    ],
    [
        [164, 176, 150],
        [88, 78, 66],
        [240, 238, 228],
        [104, 70, 42],
    ],
    [[198, 140, 112], [74, 64, 60], [236, 228, 216], [58, 70, 84]],
    [
        [222, 206, 160],
        [120, 82, 62],
        [248, 244, 234],
        [60, 92, 88],
    ],
    [
        [150, 162, 176],
        [62, 62, 68],
        [242, 242, 240],
        [166, 120, 60],
    ],
];

/// Textures of wall and sloped roof that go with the colours of the templates.
const TEXTURES: [[Texture; 2]; COLOURS] = [
    [Texture::Plaster, Texture::Shingles],
    [Texture::Cladding, Texture::Shingles],
    [Texture::Brick, Texture::Tiles],
    [Texture::Plaster, Texture::Shingles],
    [Texture::Cladding, Texture::Shingles],
    [Texture::Brick, Texture::Tiles],
    [Texture::Plaster, Texture::Tiles],
    [Texture::Cladding, Texture::Shingles],
];

/// Number of colour templates.
pub const COLOURS: usize = TEMPLATES.len();

/// The colour of a finish (sRGB) by the colour template of that index, counted on from 0 after the last.
pub fn colour(finish: Finish, template: usize) -> [u8; 3] {
    let [wall, roof, trim, door] = TEMPLATES[template % TEMPLATES.len()];
    match finish {
        Finish::Wall => wall,
        Finish::Roof => roof,
        Finish::Trim | Finish::Frame => trim,
        Finish::Door => door,
        Finish::Chimney => [142, 84, 68],
        Finish::Deck => [150, 132, 112],
        Finish::Pane => [58, 74, 88],
        Finish::GarageDoor => trim.map(|c| (f32::from(c) * 0.92) as u8),
    }
}

/// The looks of a template: its colours, the textures that go with them, glass that lets light through.
pub fn palette(template: usize) -> Palette {
    let [wall, roof] = TEXTURES[template % COLOURS];
    let own = |finish| colour(finish, template);
    let textured = |finish, texture| Look::textured(own(finish), texture);
    let painted = |finish| Look {
        roughness: 0.55,
        ..textured(finish, Texture::Paint)
    };
    Palette {
        // Bricks of one house are of one kind.
        chimney: match wall {
            Texture::Brick => textured(Finish::Wall, Texture::Brick),
            _ => textured(Finish::Chimney, Texture::Brick),
        },
        wall: textured(Finish::Wall, wall),
        roof: textured(Finish::Roof, roof),
        flat_roof: textured(Finish::Roof, Texture::Plaster),
        trim: painted(Finish::Trim),
        deck: textured(Finish::Deck, Texture::Boards),
        frame: painted(Finish::Frame),
        pane: Look {
            colour: own(Finish::Pane),
            texture: None,
            roughness: 0.06,
            transmission: 0.4,
        },
        door: painted(Finish::Door),
        garage_door: painted(Finish::GarageDoor),
    }
}

/// A house with the place of its corner (x, y) and its colours.
#[derive(Debug, Clone)]
pub struct Placed<'a> {
    /// Name of the node.
    pub name: &'a str,
    /// Its surface.
    pub surface: &'a Surface,
    /// Position of the origin of its coordinates, x to the right, y away from the street (m).
    pub at: [f64; 2],
    /// Index of the colour template.
    pub colours: usize,
}

/// The scene of houses, y up. Same surfaces are stored once for each house that is given.
pub fn scene(houses: &[Placed]) -> Scene {
    let mut scene = Scene::default();
    for (k, house) in houses.iter().enumerate() {
        let first = scene.materials.len();
        for finish in FINISHES {
            scene.materials.push(Material {
                name: format!("{finish:?}").to_lowercase(),
                color: colour(finish, house.colours),
                roughness: if finish == Finish::Pane { 0.15 } else { 0.85 },
            });
        }
        let mut parts: Vec<(usize, Vec<u32>)> = Vec::new();
        for (i, finish) in FINISHES.into_iter().enumerate() {
            let own = house.surface.triangles.iter().filter(|(_, f)| *f == finish);
            let indices: Vec<u32> = own.flat_map(|(t, _)| *t).collect();
            if !indices.is_empty() {
                parts.push((first + i, indices));
            }
        }
        // Turned from z up to y up: the back of the house lies at negative z.
        let place = |p: &[f64; 3]| [p[0] as f32, p[2] as f32, -p[1] as f32];
        scene.meshes.push(Mesh {
            name: house.name.into(),
            positions: house.surface.positions.iter().map(place).collect(),
            parts,
        });
        scene.groups.push(Group {
            name: house.name.into(),
            yaw: 0.0,
            translation: [house.at[0] as f32, 0.0, -house.at[1] as f32],
            instances: vec![Instance::at(k, [0.0; 3])],
        });
    }
    scene
}

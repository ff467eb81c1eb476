//! A facade in relief: each region lies before or behind the wall, by its label.

use std::collections::BTreeMap;

use crate::{Material, Mesh};
use edifice_shape::{Facade, Rect};

/// The look of a label: its name without number, colour, roughness, distance from the wall in metres (outwards
/// positive).
const LOOKS: [(&str, [u8; 3], f32, f32); 25] = [
    ("wall", [0xe9, 0xdf, 0xcd], 0.95, 0.0),
    ("window", [0x3f, 0x56, 0x6b], 0.15, -0.18),
    ("glass", [0x3f, 0x56, 0x6b], 0.12, -0.18),
    ("frame", [0xf4, 0xf2, 0xec], 0.6, -0.12),
    ("trim", [0xe8, 0xe2, 0xd6], 0.8, 0.06),
    ("blind", [0xb9, 0xb3, 0xa6], 0.8, -0.1),
    ("shutter", [0x5f, 0x7f, 0x6a], 0.7, 0.05),
    ("sill", [0xd5, 0xcc, 0xba], 0.9, 0.14),
    ("lintel", [0xd5, 0xcc, 0xba], 0.9, 0.1),
    ("molding", [0xd5, 0xcc, 0xba], 0.9, 0.1),
    ("cornice", [0xd5, 0xcc, 0xba], 0.9, 0.22),
    ("balcony", [0x3a, 0x3e, 0x45], 0.5, 0.7),
    ("door", [0x6a, 0x40, 0x2b], 0.7, -0.25),
    ("shop", [0x4a, 0x66, 0x70], 0.15, -0.25),
    ("sign", [0xb5, 0x3f, 0x35], 0.7, 0.12),
    ("awning", [0xd9, 0x8a, 0x3d], 0.9, 0.8),
    ("base", [0xa8, 0x9f, 0x8f], 0.95, 0.08),
    ("plinth", [0x98, 0x90, 0x84], 0.95, 0.1),
    ("capital", [0xf3, 0xec, 0xdf], 0.9, 0.18),
    ("deco", [0xf3, 0xec, 0xdf], 0.9, 0.1),
    ("pilaster", [0xf3, 0xec, 0xdf], 0.9, 0.12),
    ("pillar", [0xf3, 0xec, 0xdf], 0.9, 0.12),
    ("roof", [0x5d, 0x60, 0x6b], 0.9, -0.05),
    ("dormer", [0xa7, 0xa9, 0xb4], 0.9, 0.15),
    ("chimney", [0x8b, 0x5a, 0x4a], 0.95, 0.1),
];

/// Walls differ from style to style.
const TINTS: [[u8; 3]; 10] = [
    [0xe9, 0xdf, 0xcd],
    [0xc9, 0x8d, 0x6f],
    [0xdc, 0xc6, 0x9a],
    [0xb8, 0x6b, 0x55],
    [0xd3, 0xd0, 0xc8],
    [0xe3, 0xd2, 0xb2],
    [0xa9, 0xb0, 0xae],
    [0xd9, 0xb5, 0x96],
    [0xc4, 0xb6, 0x9f],
    [0xef, 0xe8, 0xdb],
];

/// Looks of a label; what is unknown lies in the wall, in a colour of its own.
fn look(label: &str) -> ([u8; 3], f32, f32) {
    let lower = label.to_lowercase();
    let kind = lower.trim_end_matches(|c: char| c.is_numeric() || c == '_' || c == ' ');
    match LOOKS.iter().find(|(name, ..)| *name == kind) {
        Some(&(_, color, roughness, depth)) => (color, roughness, depth),
        None => {
            let sum: usize = kind.bytes().map(usize::from).sum();
            (TINTS[sum % TINTS.len()], 0.9, 0.0)
        }
    }
}

/// The material of a label on a facade of a style; walls take the style's tint.
pub fn material(label: &str, style: usize) -> Material {
    let (color, roughness, _) = look(label);
    let is_wall = label.to_lowercase().starts_with("wall");
    match is_wall {
        true => Material {
            name: format!("{label} (style {})", style + 1),
            color: TINTS[style % TINTS.len()],
            roughness,
        },
        false => Material {
            name: label.to_owned(),
            color,
            roughness,
        },
    }
}

/// A facade as a mesh: x to the right, y up, z outwards from the wall, lower-left corner at the
/// origin. `material` gives the number of a label's material.
pub fn relief(name: String, facade: &Facade, material: impl Fn(&str) -> usize) -> Mesh {
    let mut mesh = Mesh {
        name,
        positions: Vec::new(),
        parts: Vec::new(),
    };
    let mut parts: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for region in &facade.regions {
        let (_, _, depth) = look(&region.label);
        let indices = parts.entry(material(&region.label)).or_default();
        slab(&mut mesh.positions, indices, region.rect, depth);
    }
    mesh.parts = parts.into_iter().collect();
    mesh
}

/// A rectangle at `depth` with sides back to the wall: a box before it, or a niche behind it.
fn slab(positions: &mut Vec<[f32; 3]>, indices: &mut Vec<u32>, rect: Rect, depth: f32) {
    let first = positions.len() as u32;
    let (left, right) = (rect.x as f32, rect.right() as f32);
    let (bottom, top) = (rect.y as f32, rect.top() as f32);
    let corners = [(left, bottom), (right, bottom), (right, top), (left, top)];
    positions.extend(corners.map(|(x, y)| [x, y, depth]));
    indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
    if depth == 0.0 {
        return;
    }
    positions.extend(corners.map(|(x, y)| [x, y, 0.0]));
    for i in 0..4 {
        let j = (i + 1) % 4;
        let (front, back) = ([first + i, first + j], [first + 4 + i, first + 4 + j]);
        // The sides of a box face away from its middle, those of a niche towards it; the same
        // order of corners gives both, since the front lies on the other side of the wall.
        indices.extend([back[0], back[1], front[1], back[0], front[1], front[0]]);
    }
}

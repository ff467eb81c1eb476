//! The faults of a shell: what validators of solids look for, in exact arithmetic on the numbers of the file.
//!
//! Boundaries are triangles and so plane. The names in brackets are those of ISO 19107 as val3dity prints them.

use std::collections::HashMap;

use edifice_shape::solid::crossings::{Contact, crossings};

use super::read::{Described, Shell};

/// Farthest that a window or a door may lie from its wall (m).
const REACH: f64 = 0.6;
/// Faults of one kind that are listed by name; the rest is counted.
const LISTED: usize = 3;

/// The faults of a shell; none for a sound one. A set of surfaces need not be closed.
pub fn faults(shell: &Shell) -> Vec<String> {
    let mut found = Vec::new();
    let triangles: Vec<[u32; 3]> = shell.triangles.iter().map(|(t, _)| *t).collect();
    if triangles.is_empty() {
        return vec!["no surfaces".into()];
    }
    let point = |v: u32| shell.positions[v as usize];
    let twice_area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(point).map(|p| p.map(i128::from));
        let d = |p: [i128; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
        let (u, v) = (d(b), d(c));
        [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ]
    };
    let flat = triangles.iter().filter(|t| twice_area(t) == [0; 3]).count();
    if flat > 0 {
        found.push(format!("{flat} triangles without area"));
    }
    if shell.is_solid {
        found.extend(open(&triangles, shell));
        let parts = components(&triangles);
        if parts > 1 {
            found.push(format!(
                "{parts} separate parts (305 MULTIPLE_CONNECTED_COMPONENTS)"
            ));
        }
        let six = |t: &[u32; 3]| {
            let (n, p) = (twice_area(t), point(t[0]));
            (0..3)
                .map(|i| n[i] as f64 * (p[i] - shell.positions[0][i]) as f64)
                .sum::<f64>()
        };
        if triangles.iter().map(six).sum::<f64>() <= 0.0 {
            found.push("its faces look inwards (307 POLYGON_WRONG_ORIENTATION)".into());
        }
    }
    match crossings(&shell.positions, &triangles) {
        Err(far) => found.push(format!("coordinate {far} is too large to check")),
        Ok(all) => {
            let of = |contact| all.iter().filter(move |c| c.contact == contact);
            for (contact, word) in [
                (Contact::Cross, "pass through each other"),
                (Contact::Touch, "touch"),
            ] {
                let named = of(contact).take(LISTED).map(|c| {
                    let [a, b] = c
                        .triangles
                        .map(|k| shell.surfaces[shell.triangles[k].1].name.as_str());
                    format!("{a} and {b}")
                });
                let named: Vec<String> = named.collect();
                if !named.is_empty() {
                    let count = of(contact).count();
                    let list = named.join(", ");
                    found.push(format!(
                        "{count} pairs of triangles {word} (306 SHELL_SELF_INTERSECTION): {list}"
                    ));
                }
            }
        }
    }
    found.extend(openings(shell));
    found
}

/// The number of parts that hang together at corners.
pub(super) fn components(triangles: &[[u32; 3]]) -> usize {
    fn root(parent: &mut HashMap<u32, u32>, mut v: u32) -> u32 {
        while let Some(&up) = parent.get(&v).filter(|up| **up != v) {
            v = up;
        }
        parent.insert(v, v);
        v
    }
    let mut parent = HashMap::new();
    for t in triangles {
        for w in &t[1..] {
            let (a, b) = (root(&mut parent, t[0]), root(&mut parent, *w));
            parent.insert(a.max(b), a.min(b));
        }
    }
    parent.iter().filter(|(v, up)| v == up).count()
}

/// Edges that are not passed once in either direction.
fn open(triangles: &[[u32; 3]], shell: &Shell) -> Option<String> {
    let mut edges: HashMap<[u32; 2], i64> = HashMap::new();
    for t in triangles {
        for i in 0..3 {
            *edges.entry([t[i], t[(i + 1) % 3]]).or_default() += 1;
        }
    }
    let bad = |(e, n): &(&[u32; 2], &i64)| **n != 1 || edges.get(&[e[1], e[0]]) != Some(&1);
    let mut bad: Vec<[u32; 2]> = edges.iter().filter(bad).map(|(e, _)| *e).collect();
    bad.sort_unstable();
    let first = bad.first()?;
    let [x, y, z] = shell.positions[first[0] as usize];
    Some(format!(
        "{} edges are not passed once in either direction (302 SHELL_NOT_CLOSED), the first at {x}, {y}, {z}",
        bad.len()
    ))
}

/// Windows and doors without a wall, away from it, or unknown to it.
fn openings(shell: &Shell) -> Vec<String> {
    let mut found = Vec::new();
    let corners = |surface: usize| {
        let own = shell.triangles.iter().filter(move |(_, s)| *s == surface);
        own.flat_map(|(t, _)| *t).map(|v| {
            let p = shell.positions[v as usize];
            [0, 1, 2].map(|i| p[i] as f64 * shell.scale[i])
        })
    };
    for (k, own) in shell.surfaces.iter().enumerate() {
        if !matches!(own.class.as_str(), "Window" | "Door") {
            continue;
        }
        let wall: Option<(usize, &Described)> =
            own.parent.and_then(|w| Some((w, shell.surfaces.get(w)?)));
        let Some((w, wall)) = wall.filter(|(_, w)| w.class == "WallSurface") else {
            found.push(format!("{}: its parent is no wall", own.name));
            continue;
        };
        if !wall.children.contains(&k) {
            found.push(format!("{}: {} does not name it", own.name, wall.name));
        }
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in corners(w) {
            low = [0, 1, 2].map(|i| low[i].min(p[i] - REACH));
            high = [0, 1, 2].map(|i| high[i].max(p[i] + REACH));
        }
        let mut own_corners = corners(k).peekable();
        let near = own_corners.peek().is_some()
            && own_corners.all(|p| (0..3).all(|i| (low[i]..=high[i]).contains(&p[i])));
        if !near {
            found.push(format!("{}: away from {}", own.name, wall.name));
        }
    }
    found
}

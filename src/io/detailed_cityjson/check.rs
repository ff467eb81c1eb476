//! The faults of a shell: what validators of solids look for, in exact arithmetic on the numbers of the file.
//!
//! Boundaries are triangles and so plane. The names in brackets are those of ISO 19107 as val3dity prints them.

use edifice_shape::solid::crossings::{Contact, crossings, has_area};

use super::read::{Described, Shell};
use super::surface_of;

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
    // Determinants of larger numbers do not fit.
    let crossings = match crossings(&shell.positions, &triangles) {
        Ok(crossings) => crossings,
        Err(far) => return vec![format!("coordinate {far} is too large to check")],
    };
    let corners = || {
        triangles
            .iter()
            .map(|t| t.map(|v| shell.positions[v as usize]))
    };
    let flat = corners().filter(|t| !has_area(*t)).count();
    if flat > 0 {
        found.push(format!("{flat} triangles without area"));
    }
    if shell.is_solid {
        match surface_of(corners()).check() {
            Err(e) => found.push(format!("{e} (302 SHELL_NOT_CLOSED)")),
            Ok(report) => {
                if report.shells > 1 {
                    found.push(format!(
                        "{} separate parts (305 MULTIPLE_CONNECTED_COMPONENTS)",
                        report.shells
                    ));
                }
                if report.volume <= 0.0 {
                    found.push("its faces look inwards (307 POLYGON_WRONG_ORIENTATION)".into());
                }
            }
        }
    }
    for (contact, word) in [
        (Contact::Cross, "pass through each other"),
        (Contact::Touch, "touch"),
    ] {
        let own = crossings.iter().filter(|c| c.contact == contact);
        let named = own.clone().take(LISTED).map(|c| {
            let name = |k: usize| shell.surfaces[shell.triangles[k].1].name.as_str();
            let [a, b] = c.triangles.map(name);
            format!("{a} and {b}")
        });
        let list = named.collect::<Vec<String>>().join(", ");
        if !list.is_empty() {
            let count = own.count();
            found.push(format!(
                "{count} pairs of triangles {word} (306 SHELL_SELF_INTERSECTION): {list}"
            ));
        }
    }
    found.extend(openings(shell));
    found
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

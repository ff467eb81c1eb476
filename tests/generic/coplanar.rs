//! Merging of coplanar triangles: the same surface, and closed where it was.

use std::collections::HashMap;

use edifice::rng::stream;
use edifice::shape::triangles::{TriangleMesh, clip_to_slabs, merge_coplanar};
use rand::RngExt;

use crate::shape_triangles::tower;

#[test]
fn merging_coplanar_triangles_keeps_the_solid() {
    for seed in 0..100 {
        let mut rng = stream(seed, "merge", 0);
        let mesh = tower(&mut rng);
        // Cut into many slabs and put together again: walls in pieces.
        let cuts: Vec<f64> = (1..12).map(|i| 1.5 * f64::from(i)).collect();
        let mut pieces = TriangleMesh::default();
        clip_to_slabs(&mesh, &cuts)
            .iter()
            .for_each(|p| pieces.append(p));
        let pieces = pieces.welded(1e-7);
        let merged = merge_coplanar(&pieces, 1e-4);
        assert!(
            merged.triangles.len() <= mesh.triangles.len() + 2,
            "seed {seed}"
        );
        assert!(
            (merged.area() - mesh.area()).abs() < 1e-4 * mesh.area(),
            "seed {seed}"
        );
        let (a, b) = (merged.volume_above(0.0), mesh.volume_above(0.0));
        assert!((a - b).abs() < 1e-4 * b, "seed {seed}: {a} {b}");
    }
}

/// Edges that are met by more triangles from one side than from the other.
fn open_edges(mesh: &TriangleMesh) -> usize {
    let mut excess: HashMap<(u32, u32), i32> = Default::default();
    for t in &mesh.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            *excess.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
        }
    }
    excess.values().filter(|&&n| n != 0).count()
}

/// Random heights over the cells of a grid, each face a square of two triangles: closed before, closed after, the same solid, whether the
/// corners lie on a grid, a little beside it, or were rounded to a coarser one.
#[test]
fn merging_keeps_closed_solids_closed() {
    const SIDE: usize = 5;
    let (mut before, mut after) = (0, 0);
    for seed in 0..2000 {
        let mut rng = stream(seed, "solids", 0);
        let most = rng.random_range(1..4);
        let heights: Vec<usize> = (0..SIDE * SIDE)
            .map(|_| rng.random_range(0..=most))
            .collect();
        let filled = |p: [i64; 3]| {
            let is_in = (0..2).all(|k| (0..SIDE as i64).contains(&p[k]));
            is_in && p[2] >= 0 && p[2] < heights[(p[1] * SIDE as i64 + p[0]) as usize] as i64
        };
        let mut mesh = TriangleMesh::default();
        for cell in 0..SIDE * SIDE * 3 {
            let p = [cell % SIDE, cell / SIDE % SIDE, cell / (SIDE * SIDE)].map(|v| v as i64);
            for (axis, ahead) in (0..3).flat_map(|a| [(a, true), (a, false)]) {
                let mut beside = p;
                beside[axis] += if ahead { 1 } else { -1 };
                if !filled(p) || filled(beside) {
                    continue;
                }
                let corner = |u: i64, v: i64| {
                    let mut q = p;
                    q[axis] += i64::from(ahead);
                    q[(axis + 1) % 3] += u;
                    q[(axis + 2) % 3] += v;
                    q.map(|v| v as f64)
                };
                let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                match ahead {
                    true => [[a, b, c], [a, c, d]]
                        .into_iter()
                        .for_each(|t| mesh.push(t)),
                    false => [[a, c, b], [a, d, c]]
                        .into_iter()
                        .for_each(|t| mesh.push(t)),
                }
            }
        }
        let mut mesh = mesh.welded(1e-6);
        let tolerance = [1e-9, 1e-3, 1e-9][seed as usize % 3];
        for p in &mut mesh.positions {
            match seed % 3 {
                0 => {}
                1 => *p = p.map(|v| v + rng.random_range(-2e-4..2e-4)),
                // Cells of a coarse grid: triangles collapse, turn over and lie on each other.
                _ => *p = p.map(|v| (v / 1.6).round()),
            }
        }
        let mesh = mesh.welded(1e-6);
        assert_eq!(open_edges(&mesh), 0, "seed {seed}");
        let merged = merge_coplanar(&mesh, tolerance);
        assert_eq!(open_edges(&merged), 0, "seed {seed}");
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 + 4.0 * tolerance * b.max(1.0);
        assert!(near(merged.area(), mesh.area()), "seed {seed}");
        let volumes = [&merged, &mesh].map(|m| m.volume_above(0.0));
        assert!(near(volumes[0], volumes[1]), "seed {seed}: {volumes:?}");
        before += mesh.triangles.len();
        after += merged.triangles.len();
    }
    println!("{after} of {before}");
    assert!(3 * after < 2 * before, "{after} of {before}");
}

/// Random cells of a grid, many of which touch at a corner only and have holes that touch: merged, they cover the same places once, also
/// where triangles are there twice.
#[test]
fn merging_covers_random_cells_once() {
    const SIDE: usize = 6;
    let covers = |mesh: &TriangleMesh, x: f64, y: f64| -> usize {
        let left = |a: [f64; 3], b: [f64; 3]| {
            (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0.0
        };
        let inside = |t: &[[f64; 3]; 3]| (0..3).all(|k| left(t[k], t[(k + 1) % 3]));
        mesh.corners().filter(inside).count()
    };
    let (mut before, mut after) = (0, 0);
    for seed in 0..3000 {
        let mut rng = stream(seed, "cells", 0);
        let share = rng.random_range(0.2..0.95);
        let is_in: Vec<bool> = (0..SIDE * SIDE).map(|_| rng.random_bool(share)).collect();
        let twice = rng.random_bool(0.3);
        let mut mesh = TriangleMesh::default();
        for cell in (0..SIDE * SIDE).filter(|&c| is_in[c]) {
            let corner =
                |dx: usize, dy: usize| [(cell % SIDE + dx) as f64, (cell / SIDE + dy) as f64, 2.0];
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            let mut triangles = match rng.random_bool(0.5) {
                true => vec![[a, b, c], [a, c, d]],
                false => vec![[a, b, d], [b, c, d]],
            };
            if twice && rng.random_bool(0.5) {
                triangles.push(triangles[0]);
            }
            triangles.into_iter().for_each(|t| mesh.push(t));
        }
        let mesh = mesh.welded(1e-6);
        let merged = merge_coplanar(&mesh, 1e-9);
        let cells = is_in.iter().filter(|&&i| i).count();
        assert!((merged.area() - cells as f64).abs() < 1e-9, "seed {seed}");
        for (cell, &is_in) in is_in.iter().enumerate() {
            let [dx, dy] = [0, 1].map(|_| rng.random_range(0.01..0.99));
            let (x, y) = ((cell % SIDE) as f64 + dx, (cell / SIDE) as f64 + dy);
            assert_eq!(covers(&merged, x, y), usize::from(is_in), "seed {seed}");
        }
        before += 2 * cells;
        after += merged.triangles.len();
        assert!(merged.triangles.len() <= 2 * cells, "seed {seed}");
    }
    // The triangles become fewer by more than a half.
    assert!(2 * after < before, "{after} of {before}");
}

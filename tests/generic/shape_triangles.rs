//! Triangles of buildings against analytic solids.

use edifice::rng::{Stream, stream};
use edifice::shape::triangles::{
    OrientedBox, SectionProfile, SurfaceDistance, TriangleMesh, VolumeRaster, clip_to_slabs,
    closing_lid, merge_coplanar, point_triangle_distance, polygon_triangles, repair, section_lid,
};
use rand::RngExt;

/// A closed box, turned about the vertical through the origin.
fn solid_box(low: [f64; 3], high: [f64; 3], turn: f64) -> TriangleMesh {
    let (sin, cos) = turn.sin_cos();
    let corner = |i: usize| {
        let p = [0, 1, 2].map(|k| if i >> k & 1 == 1 { high[k] } else { low[k] });
        [p[0] * cos - p[1] * sin, p[0] * sin + p[1] * cos, p[2]]
    };
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    TriangleMesh {
        positions: (0..8).map(corner).collect(),
        triangles: quads
            .iter()
            .flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]])
            .collect(),
    }
}

/// A prism over a star-shaped outline, with a roof that rises to one point.
fn tower(rng: &mut Stream) -> TriangleMesh {
    let n = rng.random_range(4..9);
    let ring: Vec<[f64; 2]> = (0..n)
        .map(|i| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            let radius = rng.random_range(4.0..12.0);
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect();
    let (eave, top) = (rng.random_range(5.0..20.0), rng.random_range(20.0..30.0));
    let mut mesh = TriangleMesh::default();
    for i in 0..n {
        let (p, q) = (ring[i], ring[(i + 1) % n]);
        let at = |p: [f64; 2], z: f64| [p[0], p[1], z];
        mesh.push([at(p, 0.0), at(q, 0.0), at(q, eave)]);
        mesh.push([at(p, 0.0), at(q, eave), at(p, eave)]);
        mesh.push([at(p, eave), at(q, eave), [0.0, 0.0, top]]);
    }
    for t in polygon_triangles(&[ring.iter().map(|p| [p[0], p[1], 0.0]).collect()]) {
        mesh.push([t[0], t[2], t[1]]);
    }
    mesh.welded(1e-9)
}

#[test]
fn clipping_keeps_area_and_with_lids_volume() {
    for seed in 0..300 {
        let mut rng = stream(seed, "clip", 0);
        let mesh = tower(&mut rng);
        let mut cuts: Vec<f64> = (0..3).map(|_| rng.random_range(1.0..19.0)).collect();
        cuts.sort_by(f64::total_cmp);
        let parts = clip_to_slabs(&mesh, &cuts);
        let area: f64 = parts.iter().map(TriangleMesh::area).sum();
        assert!(
            (area - mesh.area()).abs() < 1e-6 * mesh.area(),
            "seed {seed}"
        );
        let mut volume = 0.0;
        for (i, part) in parts.iter().enumerate() {
            let mut part = part.clone();
            if let Some(&z) = cuts.get(i) {
                part.append(&section_lid(&mesh, z));
            }
            let floor = if i == 0 { 0.0 } else { cuts[i - 1] };
            volume += part.volume_above(floor);
        }
        let whole = mesh.volume_above(0.0);
        assert!(
            (volume - whole).abs() < 1e-5 * whole,
            "seed {seed}: {volume} {whole}"
        );
    }
}

#[test]
fn cuts_at_faces_are_closed_once() {
    let volume = |mesh: &TriangleMesh, z: f64| {
        let mut parts = clip_to_slabs(mesh, &[z]);
        let mut lid = closing_lid(mesh, z);
        parts[0].append(&lid);
        lid.flip();
        parts[1].append(&lid);
        // With every face the volume does not depend on the floor.
        [0, 1].map(|i| [0.0, -7.0].map(|floor| parts[i].volume_above(floor)))
    };
    let close = |found: [[f64; 2]; 2], low: f64, high: f64| {
        found[0].iter().all(|v| (v - low).abs() < 1e-6)
            && found[1].iter().all(|v| (v - high).abs() < 1e-6)
    };
    // Two closed boxes, one on the other: nothing to close. Also where the upper one is wider.
    for wide in [1.0, 3.0] {
        let mut stacked = solid_box([-2.0, -2.0, 0.0], [2.0, 2.0, 5.0], 0.2);
        stacked.append(&solid_box([-wide, -wide, 5.0], [wide, wide, 9.0], 0.2));
        assert!(
            close(volume(&stacked.welded(1e-9), 5.0), 80.0, 16.0 * wide * wide),
            "{wide}"
        );
    }
    // One box cut through.
    let tall = solid_box([0.0; 3], [3.0, 2.0, 9.0], 0.0);
    assert!(close(volume(&tall, 5.0), 30.0, 24.0));
}

#[test]
fn sections_have_the_area_of_their_lids() {
    for seed in 0..100 {
        let mesh = tower(&mut stream(seed, "section", 0));
        let profile = SectionProfile::new(&mesh, 0.25, 1000).unwrap();
        for (i, area) in profile.areas.iter().enumerate().step_by(7) {
            let lid = section_lid(&mesh, 0.25 * i as f64 + 1e-9);
            assert!(
                (lid.area() - area).abs() < 1e-3 * (1.0 + area),
                "seed {seed}, {i}: {area}"
            );
        }
    }
}

#[test]
fn an_open_mesh_has_the_same_sections_without_its_bottom_and_inside_out() {
    let whole = solid_box([0.0; 3], [8.0, 6.0, 10.0], 0.3);
    let mut open = whole.clone();
    open.triangles.drain(0..2);
    let (closed, faults) = repair(&whole);
    assert!(!faults.any(), "{faults:?}");
    let areas = |m: &TriangleMesh| SectionProfile::new(m, 0.25, 100).unwrap().areas;
    let same = |a: Vec<f64>| {
        a.iter()
            .zip(areas(&closed))
            .all(|(x, y)| (x - y).abs() < 1e-9)
    };
    assert!(same(areas(&open)));
    open.flip();
    let (turned, faults) = repair(&open);
    assert!(faults.inverted && faults.open_edges == 4);
    assert!(same(areas(&turned)));
    let mut twice = whole.clone();
    twice.append(&whole);
    let (once, faults) = repair(&twice);
    assert_eq!((once.triangles.len(), faults.duplicated), (12, 12));
    // A tube without a roof still has its lid: the walls are chained.
    let mut tube = whole;
    tube.triangles.drain(0..4);
    assert!((section_lid(&tube, 5.0).area() - 48.0).abs() < 1e-9);
}

#[test]
fn volumetric_overlap_of_boxes_is_analytic() {
    for seed in 0..60 {
        let mut rng = stream(seed, "iou", 0);
        // Whole metres on a half-metre raster are exact.
        let mut side = |low: i32, high: i32| f64::from(rng.random_range(low..high));
        let a = ([0.0, 0.0, 0.0], [side(2, 9), side(2, 9), side(2, 9)]);
        let shift = [side(-4, 5), side(-4, 5), side(0, 5)];
        let b = (
            shift,
            [
                shift[0] + side(1, 9),
                shift[1] + side(1, 9),
                shift[2] + side(1, 9),
            ],
        );
        let raster = VolumeRaster { size: 0.5 };
        let (first, second) = (solid_box(a.0, a.1, 0.0), solid_box(b.0, b.1, 0.0));
        let found = raster.compare(&[&first], &[&second]);
        let common = |k: usize| (a.1[k].min(b.1[k]) - a.0[k].max(b.0[k])).max(0.0);
        let volume = |(l, h): ([f64; 3], [f64; 3])| (0..3).map(|k| h[k] - l[k]).product::<f64>();
        let both: f64 = (0..3).map(common).product();
        let iou = both / (volume(a) + volume(b) - both);
        assert!(
            (found.iou() - iou).abs() < 1e-6,
            "seed {seed}: {} {iou}",
            found.iou()
        );
        // The same solid twice in a set counts once.
        let doubled = raster.compare(&[&first, &first], &[&first]);
        assert!((doubled.iou() - 1.0).abs() < 1e-9);
    }
    assert_eq!(VolumeRaster { size: 1.0 }.compare(&[], &[]).iou(), 1.0);
}

/// A few enormous triangles, as a damaged file has them, are compared in large cells; a town as large in the cells that were asked for.
#[test]
fn cells_are_coarsened_for_few_enormous_triangles_only() {
    let slab = |x: f64, y: f64, side: f64| solid_box([x, y, 0.0], [x + side, y + side, 9.0], 0.0);
    let raster = VolumeRaster { size: 0.5 };
    let size = |set: &[&TriangleMesh]| raster.fitted(set, set).size;
    let hall = slab(0.0, 0.0, 1000.0);
    assert_eq!(size(&[&hall]), 0.5);
    let enormous = slab(0.0, 0.0, 30_000.0);
    assert_eq!(size(&[&enormous]), 16.0);
    let found = raster.compare(&[&enormous], &[&enormous]);
    assert_eq!(found.iou(), 1.0);
    assert!((found.first / 8.1e9 - 1.0).abs() < 1e-9, "{}", found.first);
    let place = |k: usize| [k % 60, k / 60].map(|v| 50.0 * v as f64);
    let town: Vec<TriangleMesh> = (0..3600)
        .map(|k| slab(place(k)[0], place(k)[1], 49.0))
        .collect();
    let town: Vec<&TriangleMesh> = town.iter().collect();
    assert_eq!(size(&town), 0.5);
}

#[test]
fn the_box_of_a_turned_box_is_itself() {
    for seed in 0..200 {
        let mut rng = stream(seed, "box", 0);
        let (w, d) = (rng.random_range(5.0..20.0), rng.random_range(1.0..5.0));
        let turn = rng.random_range(0.0..3.1);
        let mesh = solid_box([-w / 2.0, -d / 2.0, 2.0], [w / 2.0, d / 2.0, 9.0], turn);
        let found = OrientedBox::around(&mesh).unwrap();
        for (x, y) in found.size.iter().zip([w, d, 7.0]) {
            assert!((x - y).abs() < 1e-9);
        }
        assert!((found.angle - turn).abs() < 1e-9, "{} {turn}", found.angle);
        for &p in &mesh.positions {
            let u = found.to_unit(p);
            assert!(u[0].abs() < 0.5 + 1e-9 && u[1].abs() < 0.5 + 1e-9);
            let back = found.from_unit(u);
            assert!((0..3).all(|k| (back[k] - p[k]).abs() < 1e-9));
        }
    }
}

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
    let mut excess: std::collections::HashMap<(u32, u32), i32> = Default::default();
    for t in &mesh.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            *excess.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
        }
    }
    excess.values().filter(|&&n| n != 0).count()
}

/// Random heights over the cells of a grid, each face a square of two triangles: closed before, closed after, the same solid, whether the
/// corners lie on a grid or a little beside it.
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
        let mut tolerance = 1e-9;
        if rng.random_bool(0.5) {
            tolerance = 1e-3;
            for p in &mut mesh.positions {
                *p = p.map(|v| v + rng.random_range(-2e-4..2e-4));
            }
        }
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

#[test]
fn distances_to_triangles_are_those_of_all_points() {
    let mut rng = stream(5, "distance", 0);
    let mut point = |scale: f64| [0, 1, 2].map(|_| scale * (rng.random::<f64>() - 0.5));
    let triangles: Vec<_> = (0..60)
        .map(|_| [point(4.0), point(4.0), point(4.0)])
        .collect();
    let tree = SurfaceDistance::new(triangles.iter().copied());
    for _ in 0..300 {
        let p = point(6.0);
        let all = triangles
            .iter()
            .map(|t| point_triangle_distance(p, t))
            .fold(f64::INFINITY, f64::min);
        assert_eq!(tree.distance(p), all);
        // A fine sample of a triangle is never nearer, and comes close.
        let [a, b, c] = triangles[0];
        let mut sampled = f64::INFINITY;
        for i in 0..=60 {
            for j in 0..=60 - i {
                let (u, v) = (f64::from(i) / 60.0, f64::from(j) / 60.0);
                let q = [0, 1, 2].map(|k| a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]));
                let d = (0..3)
                    .map(|k| (p[k] - q[k]) * (p[k] - q[k]))
                    .sum::<f64>()
                    .sqrt();
                sampled = sampled.min(d);
            }
        }
        let exact = point_triangle_distance(p, &triangles[0]);
        assert!(exact <= sampled + 1e-9 && sampled - exact < 0.15);
    }
}

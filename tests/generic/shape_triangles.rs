//! Triangles of buildings against analytic solids.

use edifice::rng::{Stream, stream};
use edifice::shape::triangles::{
    OrientedBox, SectionProfile, SurfaceDistance, TriangleMesh, VolumeRaster, clip_to_slabs,
    closing_lid, point_triangle_distance, polygon_triangles, repair, section_lid,
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
pub(crate) fn tower(rng: &mut Stream) -> TriangleMesh {
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

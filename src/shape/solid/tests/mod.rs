//! Surfaces of unions against counts of cubes, integrals on another way, and points drawn at random.

mod crossings;
mod exact;
mod finishes;
mod openings;

use std::collections::BTreeSet;

use rand::RngExt;

use crate::solid::exact::{Line, Plane, SLOPES, units};
use crate::solid::integral::volume;
use crate::solid::{Finish, Prism, Surface, faces};
use edifice_base::rng::{Stream, stream};

/// The region between two corners, in whole units.
fn region([x0, y0, x1, y1]: [i128; 4]) -> Vec<Line> {
    vec![
        Line::new(1, 0, -x0),
        Line::new(-1, 0, x1),
        Line::new(0, 1, -y0),
        Line::new(0, -1, y1),
    ]
}

fn prism(plan: [i128; 4], lower: Plane, upper: Plane) -> Prism {
    Prism {
        region: region(plan),
        lower,
        upper,
        sides: Finish::Wall,
        top: Finish::Roof,
    }
}

/// A box of whole half metres.
fn cuboid(low: [i128; 3], high: [i128; 3]) -> Prism {
    let half = units(0.5);
    let plan = [low[0], low[1], high[0], high[1]].map(|v| v * half);
    prism(
        plan,
        Plane::level(low[2] * half),
        Plane::level(high[2] * half),
    )
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Volume by the divergence theorem, and area.
fn measured(surface: &Surface) -> (f64, f64) {
    let (mut volume, mut area) = (0.0, 0.0);
    for (t, _) in &surface.triangles {
        let [a, b, c] = t.map(|v| surface.positions[v as usize]);
        let (u, v) = (minus(b, a), minus(c, a));
        let normal = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        volume += (0..3).map(|i| a[i] * normal[i]).sum::<f64>() / 6.0;
        area += normal.iter().map(|n| n * n).sum::<f64>().sqrt() / 2.0;
    }
    (volume, area)
}

type Cube = [i128; 3];

/// Half-metre cubes of a union of boxes.
fn cubes(boxes: &[(Cube, Cube)]) -> BTreeSet<Cube> {
    let mut all = BTreeSet::new();
    for (low, high) in boxes {
        for x in low[0]..high[0] {
            for y in low[1]..high[1] {
                all.extend((low[2]..high[2]).map(|z| [x, y, z]));
            }
        }
    }
    all
}

/// True if two cubes meet in an edge or a corner only, of which no surface with two faces an edge is the boundary.
fn touch_in_a_line(cubes: &BTreeSet<Cube>) -> bool {
    let solid = |c: Cube| cubes.contains(&c);
    cubes.iter().any(|c| {
        [(0, 1), (0, 2), (1, 2)].into_iter().any(|(i, j)| {
            [-1, 1].into_iter().any(|s| {
                let (mut both, mut one, mut other) = (*c, *c, *c);
                (both[i], both[j], one[i], other[j]) = (c[i] + 1, c[j] + s, c[i] + 1, c[j] + s);
                // Both diagonals of a square of four cubes are one case each.
                let (empty, full) = (!solid(one) && !solid(other), solid(both));
                full && empty
            })
        })
    })
}

fn exposed(cubes: &BTreeSet<Cube>) -> usize {
    let sides = cubes.iter().flat_map(|c| {
        (0..6).map(move |k| {
            let mut next = *c;
            next[k / 2] += if k % 2 == 0 { 1 } else { -1 };
            next
        })
    });
    sides.filter(|next| !cubes.contains(next)).count()
}

fn random_boxes(rng: &mut Stream) -> Vec<(Cube, Cube)> {
    let count = rng.random_range(1..=6);
    let mut boxes: Vec<(Cube, Cube)> = Vec::new();
    for _ in 0..count {
        let low = [0; 3].map(|_| rng.random_range(-4..=5));
        let high = low.map(|v| v + rng.random_range(1..=5));
        boxes.push((low, high));
        // Now and then the same box again.
        if rng.random::<f64>() < 0.1 {
            boxes.push((low, high));
        }
    }
    boxes
}

#[test]
fn unions_of_boxes_have_the_volume_and_area_of_their_cubes() {
    let mut rng = stream(1, "boxes", 0);
    let mut closed = 0;
    for case in 0..400 {
        let boxes = random_boxes(&mut rng);
        let cubes = cubes(&boxes);
        let prisms: Vec<Prism> = boxes
            .iter()
            .map(|(low, high)| cuboid(*low, *high))
            .collect();
        let expected = cubes.len() as f64 / 8.0;
        let integral = volume(&prisms);
        assert!(
            (integral - expected).abs() < 1e-9,
            "{case}: {integral} is not {expected}"
        );
        if touch_in_a_line(&cubes) {
            continue;
        }
        let surface = faces(&prisms).triangulated().unwrap();
        let report = surface.check().unwrap();
        let (volume, area) = measured(&surface);
        for found in [volume, report.volume] {
            assert!(
                (found - expected).abs() < 1e-9,
                "{case}: {found} is not {expected}"
            );
        }
        assert!(
            (area - exposed(&cubes) as f64 / 4.0).abs() < 1e-9,
            "{case}: {area}"
        );
        assert_eq!(report.triangles, surface.triangles.len());
        closed += 1;
    }
    assert!(closed > 150, "{closed}");
}

#[test]
fn faces_are_merged_and_corners_that_bend_nothing_go() {
    // Three boxes in a row are one.
    let row = [0, 2, 4].map(|x| cuboid([x, 0, 0], [x + 2, 2, 2]));
    let merged = faces(&row);
    assert_eq!((merged.faces.len(), merged.positions.len()), (6, 8));
    let report = merged.triangulated().unwrap().check().unwrap();
    assert_eq!(
        (report.vertices, report.triangles, report.shells),
        (8, 12, 1)
    );
    // A step keeps its edge, a box apart is a shell of its own.
    let step = [
        cuboid([0, 0, 0], [2, 2, 2]),
        cuboid([2, 0, 0], [4, 2, 4]),
        cuboid([9, 9, 0], [10, 10, 1]),
    ];
    let report = faces(&step).triangulated().unwrap().check().unwrap();
    assert_eq!((report.vertices, report.shells), (12 + 8, 2));
    // A hollow is a shell, and is filled.
    let mut shell = Vec::new();
    for x in 0..3 {
        for y in 0..3 {
            for z in (0..3).filter(|z| [x, y, *z] != [1, 1, 1]) {
                shell.push(cuboid([x, y, z], [x + 1, y + 1, z + 1]));
            }
        }
    }
    let surface = faces(&shell).triangulated().unwrap();
    assert_eq!(surface.check().unwrap().shells, 2);
    assert!((surface.check().unwrap().volume - 26.0 / 8.0).abs() < 1e-9);
    let (filled, hollow) = surface.filled();
    assert!((hollow - 1.0 / 8.0).abs() < 1e-9, "{hollow}");
    assert_eq!(filled.check().unwrap().shells, 1);
    assert!((filled.check().unwrap().volume - 27.0 / 8.0).abs() < 1e-9);
}

/// A house with a gable or a roof of one slope, at random.
fn roofed(rng: &mut Stream) -> Vec<Prism> {
    let metre = units(1.0);
    let mut at = |low: i128, high: i128| rng.random_range(low * metre..=high * metre);
    let (x0, y0) = (at(-6, 6), at(-6, 6));
    let (x1, y1) = (x0 + at(1, 8), y0 + at(1, 8));
    let eaves = at(2, 5);
    let slope = rng.random_range(100..=1500);
    let side = |direction: [i128; 2], from: [i128; 2], plan| {
        prism(
            plan,
            Plane::level(0),
            Plane::rising(slope, direction, from, eaves),
        )
    };
    let middle = (x0 + x1) / 2;
    match rng.random_range(0..3) {
        0 => vec![side([0, 1], [x0, y0], [x0, y0, x1, y1])],
        1 => vec![side([-1, 0], [x1, y0], [x0, y0, x1, y1])],
        _ => vec![
            side([1, 0], [x0, y0], [x0, y0, middle, y1]),
            side(
                [-1, 0],
                [2 * middle - x0, y0],
                [middle, y0, x1.min(2 * middle - x0), y1],
            ),
        ],
    }
}

fn inside(prism: &Prism, [x, y, z]: [f64; 3]) -> bool {
    let [x, y, z] = [x, y, z].map(|v| v / crate::solid::exact::UNIT);
    let height = |p: &Plane| (p.a as f64 * x + p.b as f64 * y + p.c as f64) / SLOPES as f64;
    let left = |l: &Line| l.a as f64 * x + l.b as f64 * y + l.c as f64 >= 0.0;
    prism.region.iter().all(left) && height(&prism.lower) <= z && z <= height(&prism.upper)
}

#[test]
fn sloped_unions_agree_with_the_integral_and_with_drawn_points() {
    let mut rng = stream(2, "roofs", 0);
    for case in 0..60 {
        let count = rng.random_range(1..=3);
        let prisms: Vec<Prism> = (0..count).flat_map(|_| roofed(&mut rng)).collect();
        let integral = volume(&prisms);
        let surface = faces(&prisms).triangulated().unwrap();
        let report = surface.check().unwrap();
        let (volume, _) = measured(&surface);
        // Vertices are rounded once to a tenth of a millimetre.
        for found in [volume, report.volume] {
            assert!(
                (found - integral).abs() < 1e-3 * integral,
                "{case}: {found} is not {integral}"
            );
        }
        let (low, high, draws) = ([-6.0, -6.0, 0.0], [14.0, 14.0, 18.0], 20_000);
        let hits = (0..draws).filter(|_| {
            let point = [0, 1, 2].map(|i: usize| rng.random_range(low[i]..high[i]));
            prisms.iter().any(|p| inside(p, point))
        });
        let share = hits.count() as f64 / f64::from(draws);
        let room = 20.0 * 20.0 * 18.0;
        let error = room * (share * (1.0 - share) / f64::from(draws)).sqrt();
        assert!(
            (room * share - integral).abs() < 5.0 * error + 1.0,
            "{case}: {integral}"
        );
    }
}

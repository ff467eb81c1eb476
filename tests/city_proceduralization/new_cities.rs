//! New cities beside those that they are made from, and the measures by which they are judged.

use edifice::methods::city_proceduralization::morphology::{
    CityPlan, Morphology, Square, under_larger,
};
use edifice::methods::city_proceduralization::synthesis::{Shape, synthesize};
use edifice::methods::city_proceduralization::{Budget, Mode, proceduralize};
use edifice::shape::triangles::{City, CityBuilding, TriangleMesh};
use edifice::{Progress, unwatched};

use super::grammar::settings;

/// A box: width along its direction, depth, height, turned about its middle by degrees.
fn house(at: [f64; 2], size: [f64; 3], degrees: f64) -> TriangleMesh {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let corner = |i: usize| {
        let sign = |bit: usize| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
        let [x, y] = [sign(0) * size[0], sign(1) * size[1]];
        let z = if i >> 2 & 1 == 1 { size[2] } else { 0.0 };
        [at[0] + x * cos - y * sin, at[1] + x * sin + y * cos, z]
    };
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [1, 3, 7, 5],
        [3, 2, 6, 7],
        [2, 0, 4, 6],
    ];
    let triangles = quads
        .iter()
        .flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
    TriangleMesh {
        positions: (0..8).map(corner).collect(),
        triangles: triangles.collect(),
    }
}

fn city(houses: Vec<TriangleMesh>) -> City {
    let building = |(i, mesh)| CityBuilding {
        id: format!("b{i}"),
        mesh,
        ..CityBuilding::default()
    };
    City {
        buildings: houses.into_iter().enumerate().map(building).collect(),
        ..City::default()
    }
}

fn measured(houses: Vec<TriangleMesh>, square: Square) -> Morphology {
    CityPlan::new(&city(houses))
        .measure(&[square])
        .expect("buildings")
}

const SQUARE: Square = Square {
    low: [0.0, 0.0],
    side: 100.0,
};

#[test]
fn measures_of_rows_are_those_by_hand() {
    // A row of four, wall to wall, and 7 m behind it one alone, turned by 45 degrees, whose corner is 20 - 5 √2 m up.
    let mut houses: Vec<TriangleMesh> = (0..4)
        .map(|i| house([10.0 + 5.0 * f64::from(i), 10.0], [5.0, 8.0, 9.0], 0.0))
        .collect();
    houses.push(house([17.5, 30.0], [10.0, 10.0, 3.0], 45.0));
    let m = measured(houses, SQUARE);
    assert_eq!(m.buildings, 5);
    assert!((m.buildings_per_block - 2.5).abs() < 1e-12);
    assert!((m.attached - 0.8).abs() < 1e-12);
    // Twelve pairs in the row are parallel; the house alone has four neighbours and is one of each of theirs.
    assert!((m.parallel - 12.0 / 20.0).abs() < 1e-12, "{m:?}");
    let corner = [17.5, 30.0 - 50f64.sqrt()];
    let to_row = |x: f64| (corner[0] - x).abs().max(0.0);
    let gaps = [12.5, 17.5, 17.5, 22.5].map(|x| to_row(x).hypot(corner[1] - 14.0));
    let mean = (gaps.iter().sum::<f64>() + corner[1] - 14.0) / 5.0;
    assert!((m.gap - mean).abs() < 1e-9, "{} {mean}", m.gap);
    // Cells of a metre: 20 x 8, and 100 within the error of cells along a slanting edge.
    assert!((m.covered * 1e4 - 260.0).abs() < 12.0, "{}", m.covered);
    assert_eq!(m.overlap, 0.0);
    assert_eq!(m.sizes[0], 5.0);
}

#[test]
fn walls_half_a_metre_apart_attach_and_overlap_is_seen() {
    let pair = |gap: f64| {
        let second = house([10.0 + 6.0 + gap, 10.0], [6.0, 6.0, 6.0], 0.0);
        measured(
            vec![house([10.0, 10.0], [6.0, 6.0, 6.0], 0.0), second],
            SQUARE,
        )
    };
    assert_eq!(pair(0.4).attached, 1.0);
    assert_eq!(pair(0.4).buildings_per_block, 2.0);
    assert_eq!(pair(0.6).attached, 0.0);
    assert!((pair(0.6).gap - 0.6).abs() < 1e-9);
    assert!(pair(0.0).overlap == 0.0);
    assert!((pair(-3.0).overlap - 0.25).abs() < 1e-9);
    // Directions do not matter where a city has none: turned as a whole, all but the cells stays.
    let row = |degrees: f64| {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let place = |i: i32| {
            let x = 5.0 * f64::from(i) - 10.0;
            [50.0 + x * cos, 50.0 + x * sin]
        };
        measured(
            (0..5)
                .map(|i| house(place(i), [5.0, 8.0, 9.0], degrees))
                .collect(),
            SQUARE,
        )
    };
    for degrees in [0.0, 17.0, 45.0, 90.0, 133.3] {
        let m = row(degrees);
        assert_eq!(
            (m.attached, m.parallel, m.buildings_per_block),
            (1.0, 1.0, 5.0),
            "{degrees}"
        );
        assert!(
            (m.covered * 1e4 - 200.0).abs() < 16.0,
            "{degrees}: {}",
            m.covered
        );
    }
}

/// Terraces of six to nine houses along streets 12 m wide, gardens of 16 m between their backs.
fn terraces() -> City {
    let mut houses = Vec::new();
    for street in 0..12 {
        for side in [0.0, 8.0 + 12.0] {
            let y = f64::from(street) * (12.0 + 2.0 * 8.0 + 16.0) + side;
            for terrace in 0..6 {
                let count = 6 + (street + terrace) % 4;
                for i in 0..count {
                    let x = f64::from(terrace) * 62.0 + f64::from(i) * 5.5;
                    let height = 6.0 + f64::from((street * 7 + terrace) % 3);
                    houses.push(house([x, y], [5.5, 8.0, height], 0.0));
                }
            }
        }
    }
    city(houses)
}

#[test]
fn terraces_stay_terraces() {
    let old = terraces();
    let made = proceduralize(&old, &settings(Mode::Best, Budget::All), &unwatched).unwrap();
    let shape = Shape {
        rings: vec![vec![[0.0, 0.0], [360.0, 0.0], [360.0, 360.0], [0.0, 360.0]]],
    };
    let square = Square {
        low: [60.0, 60.0],
        side: 240.0,
    };
    let plan = CityPlan::new(&old);
    let was = plan.measure(&plan.squares(240.0)).unwrap();
    let mut first = Vec::new();
    for seed in 1..=2 {
        let new = synthesize(&made.grammar, &shape, seed, &unwatched).unwrap();
        let m = CityPlan::new(&new.derive().unwrap().city(&new))
            .measure(&[square])
            .unwrap();
        assert!((m.attached - was.attached).abs() < 0.02, "{m:?} {was:?}");
        assert!(m.parallel > 0.98, "{m:?}");
        assert!(
            (m.buildings_per_block / was.buildings_per_block - 1.0).abs() < 0.15,
            "{m:?} {was:?}"
        );
        assert!(
            (m.covered / was.covered - 1.0).abs() < 0.25,
            "{m:?} {was:?}"
        );
        assert!((m.gap / was.gap - 1.0).abs() < 0.3, "{m:?} {was:?}");
        assert!(m.overlap < 0.01, "{m:?}");
        first.push(new);
    }
    assert_ne!(first[0], first[1]);
    // The same for any number of threads.
    let alone = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    let again = alone.install(|| synthesize(&made.grammar, &shape, 1, &unwatched).unwrap());
    assert_eq!(first[0], again);
}

#[test]
fn the_plan_under_larger_buildings_by_hand() {
    let hall = house([50.0, 50.0], [40.0, 20.0, 9.0], 0.0);
    // 3 of 10 metres of it are under the hall, which ends at 70.
    let beside = house([72.0, 50.0], [10.0, 10.0, 6.0], 0.0);
    let tower = house([50.0, 50.0], [6.0, 6.0, 60.0], 0.0);
    let alone = house([150.0, 50.0], [10.0, 10.0, 6.0], 30.0);
    let shares = |houses: Vec<TriangleMesh>| under_larger(&city(houses));
    let empty = TriangleMesh::default();
    let houses = vec![beside, hall.clone(), tower, alone.clone(), empty];
    assert_eq!(shares(houses), [0.3, 0.0, 1.0, 0.0, 0.0]);
    // Of two that are equal, the first is taken as the larger.
    assert_eq!(shares(vec![alone.clone(), alone]), [0.0, 1.0]);
    assert_eq!(shares(vec![hall]), [0.0]);
    assert!(shares(Vec::new()).is_empty());
}

/// Rows of houses, each with a shed of which a third stands in it, which is 6 % of the plan, and with a tower within its walls.
#[test]
fn few_buildings_are_copied_that_overlap_with_larger_ones_but_towers_are() {
    let mut houses = Vec::new();
    for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))) {
        let [x, y] = [30.0 * f64::from(i), 30.0 * f64::from(j)];
        houses.push(house([x, y], [12.0, 10.0, 6.0], 0.0));
        houses.push(house([x + 7.0, y], [6.0, 5.0, 3.0], 0.0));
        houses.push(house([x - 2.0, y], [3.0, 3.0, 25.0], 0.0));
    }
    let old = city(houses);
    let made = proceduralize(&old, &settings(Mode::Best, Budget::Level(4)), &unwatched).unwrap();
    let side = 300.0;
    let shape = Shape {
        rings: vec![vec![[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]]],
    };
    let new = synthesize(&made.grammar, &shape, 1, &unwatched).unwrap();
    let new = new.derive().unwrap().city(&new);
    let high = |least: f64, most: f64| {
        let height = |b: &CityBuilding| b.mesh.bounds().map_or(0.0, |(low, high)| high[2] - low[2]);
        let all = new.buildings.iter().map(height);
        all.filter(|h| (least..most).contains(h)).count()
    };
    let [sheds, houses, towers] = [high(0.0, 4.0), high(5.0, 7.0), high(20.0, 30.0)];
    assert!(
        houses > 50 && towers > 50,
        "{houses} houses, {towers} towers"
    );
    // Of the old city's houses, each has a shed.
    assert!(8 * sheds <= houses, "{sheds} sheds, {houses} houses");
}

#[test]
fn a_new_city_that_is_stopped_is_what_was_laid() {
    let made = proceduralize(&terraces(), &settings(Mode::Best, Budget::All), &unwatched).unwrap();
    let shape = Shape {
        rings: vec![vec![[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0]]],
    };
    let count = |stop: u64| {
        let watch = |progress: Progress| match progress.done >= stop {
            true => std::ops::ControlFlow::Break(()),
            false => std::ops::ControlFlow::Continue(()),
        };
        let new = synthesize(&made.grammar, &shape, 1, &watch).unwrap();
        new.derive().unwrap().buildings.len()
    };
    let (none, some, all) = (count(0), count(3), count(u64::MAX));
    assert_eq!(none, 0);
    assert!(0 < some && some < all, "{some} {all}");
}

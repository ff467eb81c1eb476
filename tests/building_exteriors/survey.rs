//! Houses measured from city models: a village of known boxes, any orientation, broken meshes.

use std::path::Path;

use edifice::io::city;
use edifice::methods::building_exteriors::attributes::attributes;
use edifice::methods::building_exteriors::house::{Joining, inspect};
use edifice::methods::building_exteriors::survey::{
    Candidate, Limits, Refused, Surveyed, survey_all,
};
use edifice::shape::triangles::{City, TriangleMesh};
use edifice::shape::{BoxStyle, Hidden, RoofStyle};

fn village() -> City {
    let shipped = "datasets/building_exteriors/village.city.json";
    city::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(shipped)).unwrap()
}

fn surveyed(city: &City) -> Vec<Result<Surveyed, Refused>> {
    let all: Vec<Candidate> = city
        .buildings
        .iter()
        .map(|b| Candidate {
            name: &b.id,
            mesh: &b.mesh,
            attributes: &b.attributes,
        })
        .collect();
    survey_all(&all, &Limits::default())
}

fn house<'a>(city: &City, found: &'a [Result<Surveyed, Refused>], name: &str) -> &'a Surveyed {
    let k = city.buildings.iter().position(|b| b.id == name).unwrap();
    found[k].as_ref().unwrap()
}

#[test]
fn a_village_of_known_boxes_is_measured_exactly() {
    let city = village();
    let found = surveyed(&city);
    // Name, kind of the main roof, its width, depth, eave and pitch, number of boxes, storeys.
    let truth = [
        ("gable", RoofStyle::Gable, [11.0, 8.0, 5.6, 40.0], 1, 2),
        ("hip", RoofStyle::Hip, [12.0, 9.0, 2.8, 30.0], 1, 1),
        ("flat", RoofStyle::Flat, [12.0, 10.0, 6.0, 0.0], 1, 2),
        ("shed", RoofStyle::Shed, [10.0, 7.0, 3.0, 15.0], 1, 1),
        ("annex", RoofStyle::Gable, [10.0, 8.0, 5.4, 35.0], 2, 2),
        ("wings", RoofStyle::Gable, [12.0, 7.0, 5.6, 45.0], 2, 2),
    ];
    for (name, style, [width, depth, eave, pitch], boxes, storeys) in truth {
        let own = house(&city, &found, name);
        let main = own
            .building
            .boxes
            .iter()
            .max_by(|a, b| a.height.total_cmp(&b.height))
            .unwrap();
        assert_eq!(own.building.boxes.len(), boxes, "{name}");
        assert_eq!(own.building.floors(), storeys, "{name}");
        assert_eq!(main.roof.style, style, "{name}");
        let near = |a: f64, b: f64, by: f64| assert!((a - b).abs() <= by, "{name}: {a} for {b}");
        near(main.width.max(main.depth), width, 0.03);
        near(main.width.min(main.depth), depth, 0.03);
        near(main.height, eave, 0.1);
        near(main.roof.pitch, pitch, 1.0);
        assert!(
            own.fit.iou > 0.99 && (own.fit.volume - 1.0).abs() < 0.01,
            "{name}: {:?}",
            own.fit
        );
        assert!(own.building.is_unobserved(Hidden::Facades));
        assert!(own.year.is_some_and(|y| (1950..1960).contains(&y)));
        let row = attributes(&own.building).unwrap();
        assert!(row[..9].iter().all(Option::is_some) && row[15..39].iter().all(Option::is_none));
        let faults = inspect::faults(&own.building, Joining::Boxes);
        assert!(faults.is_empty(), "{name}: {faults:?}");
    }
    let annex = &house(&city, &found, "annex").building;
    assert!(annex.boxes.iter().any(|b| b.style == BoxStyle::Garage));
    let reason = |name: &str| {
        let k = city.buildings.iter().position(|b| b.id == name).unwrap();
        found[k].as_ref().unwrap_err().reason()
    };
    assert_eq!(reason("hall"), "no dwelling by shape");
    assert_eq!((reason("row_1"), reason("row_2")), ("attached", "attached"));
    assert_eq!(reason("shed_small"), "size");
}

/// Floors inside, as a derived city has between its parts, are under the roof and no volume of their own.
#[test]
fn faces_inside_add_no_volume() {
    let mut city = village();
    let plain = surveyed(&city);
    for b in &mut city.buildings {
        let (low, high) = b.mesh.bounds().unwrap();
        let [x, y] = [0, 1].map(|k| (low[k] + high[k]) / 2.0);
        for z in [low[2] + 1.5, low[2] + 2.5] {
            let first = b.mesh.positions.len() as u32;
            let corners = [[-1.5, -1.5], [1.5, -1.5], [0.0, 1.5]];
            let corners = corners.map(|[dx, dy]| [x + dx, y + dy, z]);
            b.mesh.positions.extend(corners);
            b.mesh.triangles.push([first, first + 1, first + 2]);
            b.mesh.triangles.push([first, first + 2, first + 1]);
        }
    }
    let floored = surveyed(&city);
    for name in ["gable", "hip", "flat", "shed"] {
        let [a, b] = [&plain, &floored].map(|found| house(&city, found, name).fit.volume);
        assert!((a - b).abs() < 1e-9, "{name}: {a} and {b}");
    }
}

/// Turning and moving a city changes no house but for the sides that are called front and left.
#[test]
fn orientation_and_place_do_not_matter() {
    let city = village();
    let first = surveyed(&city);
    for (angle, shift) in [(0.37_f64, 1e5), (1.9, 4e6), (-2.6, -3e5)] {
        let mut other = city.clone();
        let (s, c) = angle.sin_cos();
        for p in other
            .buildings
            .iter_mut()
            .flat_map(|b| &mut b.mesh.positions)
        {
            *p = [
                c * p[0] - s * p[1] + shift,
                s * p[0] + c * p[1] + shift,
                p[2] + 7.0,
            ];
        }
        for (a, b) in first.iter().zip(surveyed(&other)) {
            match (a, b) {
                (Ok(a), Ok(b)) => {
                    assert_eq!(a.building.boxes.len(), b.building.boxes.len());
                    let area = |s: &Surveyed| -> f64 {
                        s.building.boxes.iter().map(|b| b.width * b.depth).sum()
                    };
                    assert!((area(a) - area(&b)).abs() < 0.5, "{} {}", area(a), area(&b));
                    assert!((a.fit.volume - b.fit.volume).abs() < 0.01);
                }
                (Err(a), Err(b)) => assert_eq!(a.reason(), b.reason()),
                (a, b) => panic!("{a:?} became {b:?}"),
            }
        }
    }
}

/// Triangles that are missing, turned over, degenerate or without sense are refused or measured, never a panic.
#[test]
fn broken_meshes_are_refused() {
    let city = village();
    let mut state = 7_u64;
    let mut random = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as usize
    };
    for round in 0..400 {
        let mut broken = city.clone();
        for b in &mut broken.buildings {
            let mesh: &mut TriangleMesh = &mut b.mesh;
            let (n, m) = (mesh.triangles.len(), mesh.positions.len());
            match round % 5 {
                0 => mesh.triangles.truncate(random() % n),
                1 => mesh.triangles[random() % n].swap(0, 1),
                2 => mesh.positions[random() % m] = mesh.positions[random() % m],
                3 => mesh.positions[random() % m][random() % 3] += (random() % 40) as f64 - 20.0,
                _ => mesh
                    .positions
                    .iter_mut()
                    .for_each(|p| p[random() % 3] = 0.0),
            }
        }
        for s in surveyed(&broken).into_iter().flatten() {
            assert!(s.fit.iou.is_finite() && s.fit.volume.is_finite());
        }
    }
}

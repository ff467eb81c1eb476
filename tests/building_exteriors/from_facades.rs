//! Houses from facades with marked windows and doors: each mark stays where it is, or the reason is told.

use std::path::{Path, PathBuf};

use edifice::io::building_json;
use edifice::methods::building_exteriors::design::{
    FacadeHouse, Facades, FacadesError, LeftOut, MarkedFacade, from_facades, in_metres,
};
use edifice::methods::building_exteriors::house::inspect::faults;
use edifice::methods::building_exteriors::house::walls::walls_of_pieces;
use edifice::methods::building_exteriors::house::{Database, Joining, Options};
use edifice::methods::building_exteriors::model_file::ModelFile;
use edifice::shape::{
    BoxStyle, Building, ElementStyle, Facade, MassBox, PlanUnion, Rect, Region, Side,
};

use crate::cases::cases;

fn data(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets");
    folder.join(name)
}

fn shipped() -> (Database, ModelFile) {
    let houses = building_json::read(&data("building_exteriors/houses.buildings.jsonl")).unwrap();
    let text = std::fs::read_to_string(data("building_exteriors/real.houses.json")).unwrap();
    let model = ModelFile::from_json(&text).unwrap();
    (Database::new(houses).unwrap(), model)
}

/// The plan of the walls of a house, from the origin on, and where its corner was.
fn plan(house: &Building) -> (Vec<Rect>, [f64; 2]) {
    let walls = house.boxes.iter().filter(|b| b.style != BoxStyle::Porch);
    let plans: Vec<Rect> = walls.map(MassBox::plan).collect();
    let bounds = PlanUnion::new(&plans).bounding_box().unwrap();
    let moved = |r: &Rect| Rect::new(r.x - bounds.x, r.y - bounds.y, r.width, r.height);
    (plans.iter().map(moved).collect(), [bounds.x, bounds.y])
}

/// A window or door of a house: its place along its side and over the ground.
fn elements(house: &Building, side: Side) -> Vec<(ElementStyle, Rect)> {
    let own = house.facades.iter().filter(|p| p.side == side);
    let placed = own.flat_map(|p| {
        p.elements.iter().map(|e| {
            let r = Rect::new(p.start + e.x, p.base + e.y, e.width, e.height);
            (e.style, r)
        })
    });
    placed.collect()
}

/// The windows and doors that one sees on a side of a house: none behind a wall that stands before it.
fn seen(house: &Building, side: Side) -> Vec<(ElementStyle, Rect)> {
    let walls = walls_of_pieces(house);
    let pieces = || house.facades.iter().zip(&walls);
    let hidden = |start: f64, end: f64, base: f64, at: f64| {
        pieces().any(|(p, w)| {
            let before = w.is_some_and(|w| match side {
                Side::Front | Side::Left => w.at < at - 1e-6,
                Side::Back | Side::Right => w.at > at + 1e-6,
            });
            let over = end.min(p.start + p.width) - start.max(p.start) > 1e-6;
            p.side == side && (p.base - base).abs() < 1e-6 && before && over
        })
    };
    let mut visible = house.clone();
    visible.facades.clear();
    for (piece, wall) in pieces().filter(|(p, _)| p.side == side) {
        let at = wall.map_or(0.0, |w| w.at);
        if !hidden(piece.start, piece.start + piece.width, piece.base, at) {
            visible.facades.push(piece.clone());
        }
    }
    elements(&visible, side)
}

/// A side of a house as a layout, as it is seen from outside.
fn layout(house: &Building, side: Side) -> MarkedFacade {
    let (plan, [x, y]) = plan(house);
    let bounds = PlanUnion::new(&plan).bounding_box().unwrap();
    let (corner, width) = match side {
        Side::Front | Side::Back => (x, bounds.width),
        Side::Left | Side::Right => (y, bounds.height),
    };
    let height = house.boxes.iter().map(|b| b.height).fold(0.0, f64::max);
    let regions = seen(house, side).into_iter().map(|(style, r)| {
        let u = match side {
            Side::Front | Side::Right => r.x - corner,
            Side::Back | Side::Left => width - (r.right() - corner),
        };
        let label = if style == ElementStyle::Door {
            "door"
        } else {
            "window"
        };
        Region {
            label: label.into(),
            rect: Rect::new(u, r.y, r.width, r.height),
        }
    });
    let layout = Facade::new(&house.name, "m", width, height, regions.collect()).unwrap();
    MarkedFacade { side, layout }
}

fn made(
    shipped: &(Database, ModelFile),
    facades: &[MarkedFacade],
    plan: &[Rect],
) -> Result<FacadeHouse, FacadesError> {
    let wanted = Facades {
        name: "h",
        facades,
        plan,
        count: 1,
        seed: 1,
    };
    let houses = from_facades(&wanted, &shipped.1, &shipped.0, &Options::default())?;
    assert_eq!(houses.len(), 1);
    Ok(houses.into_iter().next().unwrap())
}

/// The largest distance between edges of two rectangles.
fn far_apart(a: &Rect, b: &Rect) -> f64 {
    let ends = [
        a.x - b.x,
        a.y - b.y,
        a.right() - b.right(),
        a.top() - b.top(),
    ];
    ends.into_iter().fold(0.0, |m: f64, d| m.max(d.abs()))
}

/// The largest distance of a window or door of the first house from the nearest one of the second, whose corner is the
/// origin; both ways, so that there are no others.
fn distance(before: &Building, after: &Building, side: Side) -> f64 {
    let corner = plan(before).1[usize::from(matches!(side, Side::Left | Side::Right))];
    let door = |s: ElementStyle| s == ElementStyle::Door;
    let old = seen(before, side).into_iter();
    let old: Vec<(bool, Rect)> = old
        .map(|(s, r)| (door(s), Rect::new(r.x - corner, r.y, r.width, r.height)))
        .collect();
    let new: Vec<(bool, Rect)> = seen(after, side)
        .into_iter()
        .map(|(s, r)| (door(s), r))
        .collect();
    let far = |a: &(bool, Rect), all: &[(bool, Rect)]| {
        let own = all.iter().filter(|b| b.0 == a.0);
        let own = own.map(|b| far_apart(&a.1, &b.1));
        own.fold(f64::INFINITY, f64::min)
    };
    let there = old.iter().map(|a| far(a, &new));
    let back = new.iter().map(|a| far(a, &old));
    there.chain(back).fold(0.0, f64::max)
}

#[test]
fn houses_are_made_again_from_one_side_and_from_two() {
    let shipped = shipped();
    let (mut marked, mut placed, mut plausible) = (0, 0, 0);
    let count = cases(20);
    for (n, house) in shipped.0.buildings.iter().step_by(200 / count).enumerate() {
        let sides: &[Side] = match n % 2 {
            0 => &[Side::Front],
            _ => &[
                Side::Front,
                [Side::Back, Side::Left, Side::Right][n / 2 % 3],
            ],
        };
        let facades: Vec<MarkedFacade> = sides.iter().map(|s| layout(house, *s)).collect();
        let (plan, _) = plan(house);
        let again = match made(&shipped, &facades, &plan) {
            // Some side has no window at all.
            Err(FacadesError::NoElements { side }) => {
                assert!(seen(house, side).is_empty());
                continue;
            }
            again => again.unwrap_or_else(|e| panic!("{}: {e}", house.name)),
        };
        let building = &again.house.building;
        assert_eq!(faults(building, Joining::Boxes), [""; 0], "{}", house.name);
        assert_eq!(again.house.report.shells, 1);
        let covered = PlanUnion::new(&building.floor_plan(0));
        let both: Vec<Rect> = building
            .floor_plan(0)
            .into_iter()
            .chain(plan.clone())
            .collect();
        assert!((PlanUnion::new(&both).area() - covered.area()).abs() < 1e-6);
        assert!((PlanUnion::new(&plan).area() - covered.area()).abs() < 1e-6);
        let eaves = facades[0].layout.height;
        assert!(
            building
                .boxes
                .iter()
                .all(|b| (b.height - eaves).abs() < 1e-6)
        );
        for m in &again.marked {
            marked += 1;
            match &m.placed {
                Ok(off) => {
                    placed += 1;
                    assert!(*off < 0.01, "{}: {m:?}", house.name);
                }
                Err(why) => eprintln!("{} {:?} {}: {why}", house.name, m.side, m.region),
            }
        }
        if again.marked.iter().all(|m| m.placed.is_ok()) {
            for side in sides {
                let off = distance(house, building, *side);
                assert!(off < 0.01, "{} {side:?}: {off}", house.name);
            }
        }
        plausible += usize::from(again.findings.is_empty());
    }
    eprintln!("{placed} of {marked} marks placed, {plausible} houses plausible");
    assert!(marked > 10 * count && plausible >= count - count / 10);
    assert_eq!(placed, marked);
}

/// A front of 10 m x 5.6 m with these regions.
fn front(regions: &[(&str, [f64; 4])]) -> MarkedFacade {
    let regions = regions.iter().map(|(label, [x, y, w, h])| Region {
        label: (*label).into(),
        rect: Rect::new(*x, *y, *w, *h),
    });
    MarkedFacade {
        side: Side::Front,
        layout: Facade::new("front", "m", 10.0, 5.6, regions.collect()).unwrap(),
    }
}

const PLAN: [Rect; 1] = [Rect {
    x: 0.0,
    y: 0.0,
    width: 10.0,
    height: 8.0,
}];

#[test]
fn what_has_no_place_is_told() {
    let shipped = shipped();
    let marks = front(&[
        ("window", [1.0, 0.9, 1.2, 1.4]),
        ("sash", [1.0, 3.7, 1.2, 1.4]),
        ("balcony", [4.0, 2.5, 2.0, 0.5]),
        ("window", [1.5, 1.0, 1.2, 1.4]),
        ("door", [4.0, 0.0, 0.45, 2.1]),
        ("door", [4.5, 0.0, 0.45, 2.1]),
        ("door", [8.0, 0.0, 0.4, 2.1]),
        ("door", [8.6, 1.0, 0.9, 2.1]),
        ("window", [6.0, 0.5, 0.6, 4.8]),
        ("window", [9.2, 3.7, 0.8, 1.4]),
    ]);
    let house = made(&shipped, &[marks], &PLAN).unwrap();
    let outcome: Vec<Result<bool, LeftOut>> = house
        .marked
        .iter()
        .map(|m| m.placed.clone().map(|off| off < 1e-9))
        .collect();
    assert_eq!(house.storeys, 2);
    assert_eq!(outcome[0], Ok(true));
    assert_eq!(outcome[1], Ok(true));
    assert!(matches!(&outcome[2], Err(LeftOut::NoOpening { label }) if label == "balcony"));
    assert_eq!(outcome[3], Err(LeftOut::Overlaps { other: 0 }));
    // Two leaves are one door.
    assert_eq!([&outcome[4], &outcome[5]], [&Ok(true), &Ok(true)]);
    assert!(matches!(
        outcome[6],
        Err(LeftOut::Small { what: "door", .. })
    ));
    assert!(matches!(outcome[7], Err(LeftOut::Sill { .. })));
    assert!(matches!(outcome[8], Err(LeftOut::Storey { .. })));
    assert_eq!(outcome[9], Err(LeftOut::NoRoom));
    let on_front = elements(&house.house.building, Side::Front);
    assert_eq!(on_front.len(), 3);
    let has = |style, wanted: Rect| {
        let near = |r: &Rect| far_apart(r, &wanted) < 1e-6;
        on_front.iter().any(|(s, r)| *s == style && near(r))
    };
    assert!(has(ElementStyle::Sash, Rect::new(1.0, 3.7, 1.2, 1.4)));
    assert!(has(ElementStyle::Door, Rect::new(4.0, 0.0, 0.95, 2.1)));
    assert_eq!(house.house.report.unplaced, 0);

    // A window over a corner of the plan.
    let corner = [Rect::new(0.0, 0.0, 4.0, 8.0), Rect::new(4.0, 2.0, 6.0, 6.0)];
    let marks = front(&[
        ("window", [1.0, 0.9, 1.2, 1.4]),
        ("window", [3.5, 0.9, 1.2, 1.4]),
    ]);
    let house = made(&shipped, &[marks], &corner).unwrap();
    assert!(house.marked[0].placed.is_ok());
    assert!(matches!(
        house.marked[1].placed,
        Err(LeftOut::Corner { .. })
    ));
}

#[test]
fn what_cannot_be_a_house_is_refused() {
    let shipped = shipped();
    let window = [("window", [1.0, 0.9, 1.2, 1.4])];
    let fails = |facades: &[MarkedFacade]| made(&shipped, facades, &PLAN).unwrap_err();
    assert!(matches!(fails(&[]), FacadesError::NoFacade));
    let twice = fails(&[front(&window), front(&window)]);
    assert!(matches!(twice, FacadesError::Twice { side: Side::Front }));
    let none = fails(&[front(&[("balcony", [1.0, 0.9, 1.2, 1.4])])]);
    assert!(matches!(
        none,
        FacadesError::NoElements { side: Side::Front }
    ));
    let side = MarkedFacade {
        side: Side::Left,
        ..front(&window)
    };
    // The left side of the plan is 8 m wide.
    let wide = fails(&[side]).to_string();
    assert!(
        wide.contains("10.00 m") && wide.contains("8.00 m"),
        "{wide}"
    );
    let mut low = front(&window);
    (low.side, low.layout.height) = (Side::Back, 5.0);
    let low = fails(&[front(&window), low]).to_string();
    assert!(low.contains("5.00 m") && low.contains("5.60 m"), "{low}");
    let none = fails(&[front(&[("door", [1.0, 3.0, 0.4, 1.0])])]);
    assert!(matches!(none, FacadesError::NonePlaced { marked: 1, .. }));
    let mut high = front(&window);
    high.layout.height = 40.0;
    assert!(matches!(fails(&[high]), FacadesError::Eaves { .. }));
    let mut rows = front(&[0.9, 3.7, 6.5, 9.3].map(|y| ("window", [1.0, y / 2.1, 1.2, 0.6])));
    rows.layout.height = 11.2;
    for r in &mut rows.layout.regions {
        r.rect.y *= 2.1;
    }
    assert!(matches!(fails(&[rows]), FacadesError::Rows { rows: 4, .. }));

    let mut pixels = front(&window).layout;
    pixels.unit = "px".into();
    let unit = in_metres(Side::Front, &pixels, None, None).unwrap_err();
    assert!(matches!(
        unit,
        FacadesError::Unit {
            side: Side::Front,
            ..
        }
    ));
    let unscaled = MarkedFacade {
        side: Side::Front,
        layout: pixels.clone(),
    };
    assert!(matches!(fails(&[unscaled]), FacadesError::Unit { .. }));
    for bad in [0.0, -1.0, f64::NAN] {
        let scale = in_metres(Side::Front, &pixels, Some(bad), None).unwrap_err();
        assert!(matches!(scale, FacadesError::Scale { .. }));
    }
    let scaled = |w, h| {
        let f = in_metres(Side::Front, &pixels, w, h).unwrap();
        [f.width, f.height, f.regions[0].rect.x, f.regions[0].rect.y]
    };
    assert_eq!(scaled(Some(20.0), None), [20.0, 11.2, 2.0, 1.8]);
    assert_eq!(scaled(None, Some(2.8)), [5.0, 2.8, 0.5, 0.45]);
    assert_eq!(scaled(Some(5.0), Some(5.6)), [5.0, 5.6, 0.5, 0.9]);
    pixels.unit = "cm".into();
    let centimetres = in_metres(Side::Front, &pixels, None, None).unwrap();
    assert!((centimetres.width - 0.1).abs() < 1e-12);
}

//! Houses without a common template: two to seven boxes in any arrangement, to test the generation of mass
//! models on houses that no donor resembles. Nothing but soundness is asked of them: in one piece, no
//! courtyard, nowhere thinner than 0.5 m. They have no facades.

use rand::{Rng, RngExt};

use edifice_base::rng::stream;
use edifice_building_exteriors::mass::is_sound;
use edifice_shape::{BoxStyle, Building, MassBox, PlanUnion, Ridge, Roof, RoofStyle, visibility};

/// Wild house number `index` of the set with this seed.
pub fn wild(seed: u64, index: u64) -> Building {
    let mut rng = stream(seed, "building_exteriors/wild", index);
    loop {
        if let Some(building) = attempt(index, &mut rng) {
            return building;
        }
    }
}

fn attempt(index: u64, rng: &mut impl Rng) -> Option<Building> {
    let floor_height = millimetres(rng.random_range(2.6..3.1));
    let floors: usize = rng.random_range(1..=3);
    let parts = [0.6, 0.5, 0.4].map(|share| rng.random_bool(share));
    let count: usize = rng.random_range(2..=7);
    let general = count
        .checked_sub(parts.iter().filter(|p| **p).count())
        .filter(|n| *n > 0)?;
    let (w, d) = (rng.random_range(9.0..20.0), rng.random_range(8.0..16.0));
    let mut boxes = Vec::new();
    for i in 0..general {
        let height = match i {
            0 => floors,
            _ => rng.random_range(1..=floors),
        };
        let size = [w, d].map(|e: f64| e * rng.random_range(0.25..0.9));
        boxes.push(placed(
            BoxStyle::Main,
            size,
            millimetres(height as f64 * floor_height),
            [w, d],
            rng,
        ));
    }
    let styles = [BoxStyle::Garage, BoxStyle::Porch, BoxStyle::Porch];
    for (k, style) in styles.into_iter().enumerate() {
        if !parts[k] {
            continue;
        }
        let size = match k {
            0 => [rng.random_range(3.0..6.5), rng.random_range(5.0..6.5)],
            _ => [rng.random_range(1.5..5.0), rng.random_range(1.2..2.6)],
        };
        let height = floor_height * rng.random_range(0.75..0.98);
        let mut part = placed(style, size, millimetres(height), [w, d], rng);
        if k > 0 {
            let y = rng.random_range(0.0..0.4) * d;
            part.y = millimetres(if k == 1 { y } else { d - y });
        }
        boxes.push(part);
    }
    let building = Building::new(
        format!("wild_{:04}", index + 1),
        "m",
        floor_height,
        to_the_corner(boxes),
        Vec::new(),
        Vec::new(),
    )
    .ok()?;
    (is_sound(&building) && parts_count(&building, parts)).then_some(building)
}

/// True if each part is seen, and the porches are in front and at the back as drawn.
fn parts_count(building: &Building, parts: [bool; 3]) -> bool {
    let plan = building.floor_plan(0);
    let Some(bounds) = PlanUnion::new(&plan).bounding_box() else {
        return false;
    };
    let middle = bounds.y + bounds.height / 2.0;
    let find = |k: usize| {
        building.boxes.iter().find(|b| match k {
            0 => b.style == BoxStyle::Garage,
            1 => b.style == BoxStyle::Porch && b.y < middle,
            _ => b.style == BoxStyle::Porch && b.y >= middle,
        })
    };
    (0..3).all(|k| match find(k) {
        None => !parts[k],
        Some(part) => {
            let seen = visibility(&[part.plan()], &plan);
            parts[k] && (0.1..0.95).contains(&(seen.visible / seen.perimeter))
        }
    })
}

fn placed(
    style: BoxStyle,
    size: [f64; 2],
    height: f64,
    room: [f64; 2],
    rng: &mut impl Rng,
) -> MassBox {
    let at = [0, 1].map(|a| {
        let free = (room[a] - size[a]).max(0.0);
        millimetres(size[a] / 2.0 + free * rng.random::<f64>())
    });
    let style_of_roof = [RoofStyle::Flat, RoofStyle::Gable, RoofStyle::Hip][rng.random_range(0..3)];
    let flat = style_of_roof == RoofStyle::Flat;
    MassBox {
        style,
        x: at[0],
        y: at[1],
        // Even millimetres, so that centre and edges lie on whole ones.
        width: 2.0 * millimetres(size[0] / 2.0),
        depth: 2.0 * millimetres(size[1] / 2.0),
        height,
        roof: Roof {
            style: style_of_roof,
            pitch: if flat { 0.0 } else { 30.0 },
            ridge: if rng.random() { Ridge::X } else { Ridge::Y },
        },
    }
}

/// Shifts the boxes so that their bounding box starts at the origin.
fn to_the_corner(mut boxes: Vec<MassBox>) -> Vec<MassBox> {
    let low = |f: fn(&MassBox) -> f64| boxes.iter().map(f).fold(f64::INFINITY, f64::min);
    let (x, y) = (low(|b| b.x - b.width / 2.0), low(|b| b.y - b.depth / 2.0));
    for b in &mut boxes {
        (b.x, b.y) = (millimetres(b.x - x), millimetres(b.y - y));
    }
    boxes
}

fn millimetres(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

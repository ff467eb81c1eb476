//! Houses on plots along roads, with paths, drives, hedges and trees: scenes for pictures (Fig. 1 and 15).

mod garden;

use edifice_base::rng::stream;
use edifice_scene::Scene;
use edifice_shape::solid::{Finish, Surface};
use rand::RngExt;

use self::garden::{Garden, Kind};
use super::scene::{Placed, scene};

/// Lengths in metres: lawn beside a house, before it and behind it; widths of road, pavement and path.
const BESIDE: f64 = 3.2;
const BEFORE: f64 = 5.5;
const BEHIND: f64 = 7.0;
const ROAD: f64 = 6.0;
const PAVEMENT: f64 = 1.8;
const PATH: f64 = 1.2;
/// Least width of a gate that looks at the street.
const GATE: f64 = 1.5;
/// Plots along a row for each row: streets look best a few times as wide as deep.
const ASPECT: f64 = 3.0;

/// The direction of a view of a street, y up: fronts and right sides are seen, from above the roofs.
pub const DIRECTION: [f32; 3] = [-0.2, -0.5, -0.85];

/// A house that is to stand on a plot.
#[derive(Debug, Clone, Copy)]
pub struct Fronted<'a> {
    /// Name of its node.
    pub name: &'a str,
    /// Its surface, the front towards smaller y.
    pub surface: &'a Surface,
    /// Index of the colour template.
    pub colours: usize,
}

/// Houses side by side in rows, each row along a road of its own that their fronts look at. `seed` says where trees
/// stand. In metres, y up; the first row is in front. A scene without anything for no houses.
pub fn street(houses: &[Fronted], seed: u64) -> Scene {
    let plots: Vec<Plot> = houses.iter().map(|h| Plot::of(h.surface)).collect();
    let columns = (ASPECT * houses.len() as f64).sqrt().ceil() as usize;
    let mut placed = Vec::new();
    let mut garden = Garden::default();
    let mut front = 0.0;
    let rows: Vec<&[Plot]> = plots.chunks(columns.max(1)).collect();
    let width = |row: &[Plot]| row.iter().map(Plot::width).sum::<f64>();
    let widest = rows.iter().map(|row| width(row)).fold(0.0, f64::max);
    for (r, row) in rows.iter().enumerate() {
        let depth = row.iter().map(Plot::depth).fold(0.0, f64::max);
        let mut left = (widest - width(row)) / 2.0;
        garden.slab(
            Kind::Road,
            [0.0, widest],
            [front - PAVEMENT - ROAD, front - PAVEMENT],
            0.02,
        );
        garden.slab(
            Kind::Pavement,
            [0.0, widest],
            [front - PAVEMENT, front],
            0.1,
        );
        for (c, plot) in row.iter().enumerate() {
            let k = r * columns + c;
            let house = houses[k];
            let at = [left + BESIDE - plot.low[0], front + BEFORE - plot.low[1]];
            placed.push(Placed {
                name: house.name,
                surface: house.surface,
                at,
                colours: house.colours,
            });
            plot.ways(&mut garden, at, front);
            plot.hedges(&mut garden, [left, front], depth);
            plot.trees(&mut garden, [left, front], depth, seed, k as u64);
            left += plot.width();
        }
        front += depth + PAVEMENT + ROAD;
    }
    let mut scene = scene(&placed);
    garden.add_to(&mut scene);
    scene
}

/// The ground of a house: its extents, and where its doors are, in its own coordinates.
struct Plot {
    low: [f64; 2],
    high: [f64; 2],
    /// Left and right end and distance from the front of the front-most door, and of the front-most garage door.
    door: Option<[f64; 3]>,
    garage: Option<[f64; 3]>,
}

impl Plot {
    fn of(surface: &Surface) -> Self {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for p in &surface.positions {
            for k in 0..2 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        if low[0] > high[0] {
            (low, high) = ([0.0; 2], [0.0; 2]);
        }
        Self {
            low,
            high,
            door: front_most(surface, Finish::Door),
            garage: front_most(surface, Finish::GarageDoor),
        }
    }

    fn width(&self) -> f64 {
        self.high[0] - self.low[0] + 2.0 * BESIDE
    }

    fn depth(&self) -> f64 {
        self.high[1] - self.low[1] + BEFORE + BEHIND
    }

    /// The path to the door and the drive to the garage of a house that stands at a place.
    fn ways(&self, garden: &mut Garden, at: [f64; 2], front: f64) {
        if let Some([left, right, y]) = self.door {
            let middle = at[0] + (left + right) / 2.0;
            let across = [middle - PATH / 2.0, middle + PATH / 2.0];
            garden.slab(Kind::Path, across, [front, at[1] + y], 0.05);
        }
        // A gate in a side wall has no drive straight to it.
        if let Some([left, right, y]) = self.garage.filter(|g| g[1] - g[0] > GATE) {
            let across = [at[0] + left - 0.2, at[0] + right + 0.2];
            garden.slab(Kind::Drive, across, [front - PAVEMENT, at[1] + y], 0.11);
        }
    }

    /// Hedges at the left side and at the back of a plot.
    fn hedges(&self, garden: &mut Garden, [left, front]: [f64; 2], depth: f64) {
        let back = front + depth - 1.0;
        garden.slab(
            Kind::Hedge,
            [left - 0.25, left + 0.25],
            [front + 0.4, back],
            0.9,
        );
        garden.slab(
            Kind::Hedge,
            [left, left + self.width()],
            [back - 0.5, back],
            1.3,
        );
    }

    /// One or two trees behind the house, and often one at a front corner that no way leads to.
    fn trees(&self, garden: &mut Garden, [left, front]: [f64; 2], depth: f64, seed: u64, k: u64) {
        let mut rng = stream(seed, "building_exteriors/street", k);
        let house = front + BEFORE + self.high[1] - self.low[1];
        let back = [house + 2.8, front + depth - 2.6];
        for _ in 0..rng.random_range(1..=2) {
            let x = left + rng.random_range(2.0..self.width() - 2.0);
            let share: f64 = rng.random();
            let y = back[0] + share * (back[1] - back[0]).max(0.0);
            garden.tree([x, y], rng.random_range(4.5..8.0), &mut rng);
        }
        let x = left + 1.9;
        let is_way = |way: Option<[f64; 3]>| {
            way.is_some_and(|w| left + BESIDE - self.low[0] + w[0] < x + 1.6)
        };
        if rng.random_bool(0.6) && !is_way(self.door) && !is_way(self.garage) {
            garden.tree([x, front + 2.2], rng.random_range(2.6..4.2), &mut rng);
        }
    }
}

/// Ends and place of what has a finish and is nearest to the front.
fn front_most(surface: &Surface, finish: Finish) -> Option<[f64; 3]> {
    let own = surface.triangles.iter().filter(|(_, f)| *f == finish);
    let corners: Vec<[f64; 3]> = own
        .flat_map(|(t, _)| t.map(|i| surface.positions[i as usize]))
        .collect();
    let y = corners.iter().map(|p| p[1]).reduce(f64::min)?;
    let near = corners.iter().filter(|p| p[1] < y + 0.3);
    let ends = near.fold([f64::INFINITY, f64::NEG_INFINITY], |e, p| {
        [e[0].min(p[0]), e[1].max(p[0])]
    });
    Some([ends[0], ends[1], y])
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_scene::Instance;

    /// A box of 10 by 8 by 5 m with a door in the middle of its front.
    fn house() -> Surface {
        let corner = |k: usize| {
            [
                10.0 * (k & 1) as f64,
                4.0 * (k & 2) as f64,
                1.25 * (k & 4) as f64,
            ]
        };
        let mut positions: Vec<[f64; 3]> = (0..8).map(corner).collect();
        positions.extend([[4.5, 0.0, 0.0], [5.5, 0.0, 0.0], [5.0, 0.0, 2.0]]);
        Surface {
            positions,
            triangles: vec![
                ([0, 1, 5], Finish::Wall),
                ([4, 5, 7], Finish::Roof),
                ([8, 9, 10], Finish::Door),
            ],
        }
    }

    #[test]
    fn houses_keep_apart_and_a_path_leads_to_each_door() {
        let surface = house();
        let houses: Vec<Fronted> = (0..12)
            .map(|colours| Fronted {
                name: "house",
                surface: &surface,
                colours,
            })
            .collect();
        let scene = street(&houses, 1);
        let places: Vec<[f32; 3]> = scene.groups[..12].iter().map(|g| g.translation).collect();
        for (i, a) in places.iter().enumerate() {
            for b in &places[..i] {
                let apart = [(a[0] - b[0]).abs(), (a[2] - b[2]).abs()];
                assert!(
                    apart[0] > 10.0 + 6.0 || apart[1] > 8.0 + 12.0,
                    "{a:?} {b:?}"
                );
            }
        }
        let path = scene
            .materials
            .iter()
            .position(|m| m.name == "path")
            .unwrap();
        let is_path = |i: &&Instance| scene.meshes[i.mesh].parts[0].0 == path;
        let garden = &scene.groups[12];
        let paths: Vec<&Instance> = garden.instances.iter().filter(is_path).collect();
        assert_eq!(paths.len(), 12);
        for (house, path) in places.iter().zip(paths) {
            let middle = path.translation[0] + path.scale[0] / 2.0;
            assert!((middle - house[0] - 5.0).abs() < 1e-4);
            // It ends at the door: at the front of the house.
            assert!((path.translation[2] - house[2]).abs() < 1e-4);
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_street() {
        let surface = house();
        let one = Fronted {
            name: "house",
            surface: &surface,
            colours: 0,
        };
        assert_eq!(street(&[one; 5], 3), street(&[one; 5], 3));
        assert_ne!(street(&[one; 5], 3), street(&[one; 5], 4));
        assert_eq!(street(&[], 3).triangles(), 0);
    }
}

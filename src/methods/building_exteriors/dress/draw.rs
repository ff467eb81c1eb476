//! One draw of the windows and doors of a building.

use edifice_model::{ModelError, Table};
use rand::seq::IndexedRandom;
use rand::{Rng, RngExt};

use super::choice::{Element, ElementKind};
use super::walls::{Faces, Span, WallFace};
use crate::attributes::AttributeRow;
use crate::coding::attribute_rows;
use crate::data::table;
use crate::model_file::ModelFile;

/// First columns of the window to wall ratios of the four sides, of their symmetry, and of their alignment.
const RATIOS: usize = 27;
const SYMMETRY: usize = 31;
const ALIGNMENT: usize = 35;
/// Least and greatest height of a storey where the city does not tell their number, and its middle (m).
const STOREY: [f64; 2] = [2.6, 3.2];
const MIDDLE: f64 = 2.9;
/// Least and greatest height of storeys that are known (m).
const HEIGHTS: [f64; 2] = [2.2, 6.0];
/// Room around an element on its wall, between neighbours, and over its storey's floor and below its ceiling (m).
const MARGIN: f64 = 0.15;
const BETWEEN: f64 = 0.4;
const CEILING: f64 = 0.25;
/// A door begins so far above the foot of its wall (m).
const THRESHOLD: f64 = 0.05;
/// Step and half width of the columns in which room is looked for on a wall (m), and the lower and upper edge of a
/// storey's windows for that.
const STEP: f64 = 0.25;
const COLUMN: f64 = 0.35;
const BAND: [f64; 2] = [1.1, 2.0];
/// Window to wall ratio of a side that the model does not know, and its largest.
const USUAL: f64 = 0.12;
const MOST: f64 = 0.6;

/// Width and height (m) of windows in walls above the ground, by area, at equal steps of their number: 79,848 windows
/// of audited Canadian houses (the energy audits of Natural Resources Canada), without the smallest sixth.
#[rustfmt::skip]
pub const WINDOWS: [[f64; 2]; 40] = [
    [0.84, 0.84], [0.61, 1.22], [1.27, 0.61], [0.89, 0.91], [0.91, 0.91], [0.71, 1.22], [0.56, 1.63], [0.76, 1.22],
    [0.72, 1.35], [0.99, 1.02], [1.02, 1.02], [0.94, 1.14], [0.61, 1.83], [1.17, 0.97], [0.76, 1.52], [0.86, 1.40],
    [0.81, 1.52], [1.14, 1.12], [0.86, 1.52], [1.12, 1.22], [1.52, 0.91], [1.68, 0.86], [1.22, 1.22], [1.13, 1.35],
    [0.99, 1.60], [1.14, 1.45], [1.78, 0.97], [1.14, 1.57], [1.88, 0.99], [1.12, 1.78], [1.24, 1.70], [1.93, 1.17],
    [1.88, 1.30], [1.93, 1.37], [2.01, 1.42], [1.52, 2.03], [2.03, 1.63], [1.78, 2.03], [1.91, 2.03], [3.05, 1.52],
];
/// Height of the head of windows over the floor, and width and height of a door (m).
const HEAD: f64 = 2.15;
const DOOR: [f64; 2] = [1.0, 2.1];
/// Greatest height of the ground floor over the ground (m).
const PLINTH: f64 = 0.6;

/// Rows of attributes drawn from the model, given the mass of a house where it is known.
pub(super) fn rows(
    model: &ModelFile,
    mass: Option<AttributeRow>,
    count: usize,
    rng: &mut impl Rng,
) -> Result<Vec<AttributeRow>, ModelError> {
    let drawn = match mass {
        None => model.sample(count, rng)?,
        Some(mass) => {
            let given: Table = table(std::slice::from_ref(&mass))?;
            model.complete(&given, count, rng)?
        }
    };
    Ok(attribute_rows(&drawn.table))
}

/// Some rows of a pool, drawn with replacement.
pub(super) fn some_of(
    pool: &[AttributeRow],
    count: usize,
    rng: &mut impl Rng,
) -> Vec<AttributeRow> {
    (0..count)
        .filter_map(|_| pool.choose(rng).cloned())
        .collect()
}

/// The stretches of a wall that have room for windows at some height, along the wall (m).
struct Room {
    wall: usize,
    runs: Vec<[f64; 2]>,
}

impl Room {
    fn length(&self) -> f64 {
        self.runs.iter().map(|[a, b]| b - a).sum()
    }
}

/// A building with its walls and their room.
pub(super) struct Site<'a> {
    faces: &'a Faces,
    rooms: Vec<Room>,
    /// Height of the eaves over the ground (m).
    eaves: f64,
    storeys: Option<usize>,
    /// Outward direction of the largest free wall, in radians.
    main: f64,
}

impl<'a> Site<'a> {
    /// The walls of a building whose storeys may be known.
    pub(super) fn new(faces: &'a Faces, storeys: Option<usize>) -> Self {
        let room = |(wall, face): (usize, &WallFace)| Room {
            wall,
            runs: runs(face, faces.ground),
        };
        let rooms: Vec<Room> = faces.walls.iter().enumerate().map(room).collect();
        // The mean height of a wall of at least a fifth of the largest.
        let largest = faces.walls.iter().map(|w| w.area).fold(0.0, f64::max);
        let height = |w: &WallFace| {
            let length = w.bounds[0][1] - w.bounds[0][0];
            w.bounds[1][0] - faces.ground + w.area / length.max(1e-9)
        };
        let tall = faces
            .walls
            .iter()
            .filter(|w| w.area >= largest / 5.0)
            .map(height);
        let main = rooms
            .iter()
            .max_by(|a, b| a.length().total_cmp(&b.length()));
        let main = main.map_or([0.0, -1.0], |r| faces.walls[r.wall].outward);
        Self {
            faces,
            eaves: tall.fold(0.0, f64::max),
            rooms,
            storeys,
            main: main[1].atan2(main[0]),
        }
    }

    /// The side of a wall, 0 front, 1 back, 2 left, 3 right, when the front looks to `front` quarter turns from the
    /// main direction.
    fn side(&self, wall: usize, front: usize) -> usize {
        let [x, y] = self.faces.walls[wall].outward;
        let quarter = std::f64::consts::FRAC_PI_2;
        let turns = (y.atan2(x) - self.main) / quarter - front as f64;
        // Counterclockwise from the front: right, back, left.
        [0, 3, 1, 2][turns.round().rem_euclid(4.0) as usize % 4]
    }

    /// The number of storeys and their height (m): those that are known, else as many as `height` goes into the eaves.
    pub(super) fn storeys(&self, height: f64) -> (usize, f64) {
        let usual = (self.eaves / height).round().max(1.0) as usize;
        let storeys = self.storeys.unwrap_or(usual).max(1);
        let [low, high] = HEIGHTS;
        (storeys, (self.eaves / storeys as f64).clamp(low, high))
    }

    /// The stretches with room, with the index of their wall.
    pub(super) fn runs(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        let rooms = self.rooms.iter();
        rooms.flat_map(|r| r.runs.iter().map(|run| (r.wall, *run)))
    }

    /// True if an element with some room around it lies inside a wall and is free.
    pub(super) fn has_room(&self, wall: usize, rect: Span) -> bool {
        self.faces.walls[wall].has_room(grown(rect, MARGIN))
    }

    /// Windows and doors for a row of attributes.
    pub(super) fn draw(&self, row: &AttributeRow, rng: &mut impl Rng) -> Vec<Element> {
        let mut found = Vec::new();
        let (storeys, storey) = self.storeys(rng.random_range(STOREY[0]..STOREY[1]));
        let Some([width, height]) = WINDOWS.choose(rng).copied() else {
            return found;
        };
        let height = height.min(storey - 2.0 * CEILING);
        let sill = (HEAD.min(storey - CEILING) - height).max(CEILING);
        let ground = self.faces.ground + rng.random_range(0.0..PLINTH);
        let front = self.front(rng);
        let attic = rng.random_bool(0.5);
        let rows = storeys + usize::from(attic);
        for room in &self.rooms {
            let side = self.side(room.wall, front);
            let ratio = row[RATIOS + side].unwrap_or(USUAL).clamp(0.0, MOST);
            let chance = |c: usize| row[c + side].unwrap_or(1.0).clamp(0.0, 1.0);
            let symmetric = rng.random_bool(chance(SYMMETRY));
            let aligned = rng.random_bool(chance(ALIGNMENT));
            for [start, end] in &room.runs {
                let length = end - start;
                let wanted = ratio * length * storey / (width * height);
                let most = (length / (width + BETWEEN)).floor();
                let bays = (wanted + rng.random::<f64>()).floor().min(most) as usize;
                let pitch = length / bays.max(1) as f64;
                // Windows that are not symmetric stand anywhere in their bays, each row in its own way if not aligned.
                let play = (pitch - width - BETWEEN).max(0.0) / 2.0;
                let mut shift = || match symmetric {
                    true => 0.0,
                    false => play * (2.0 * rng.random::<f64>() - 1.0),
                };
                let common = shift();
                for floor in 0..rows {
                    let shift = if aligned { common } else { shift() };
                    for k in 0..bays {
                        let middle = start + (k as f64 + 0.5) * pitch + shift;
                        let foot = ground + floor as f64 * storey + sill;
                        let rect = [
                            [middle - width / 2.0, middle + width / 2.0],
                            [foot, foot + height],
                        ];
                        if self.has_room(room.wall, rect) {
                            found.push(Element {
                                kind: ElementKind::Window,
                                wall: room.wall,
                                storey: floor,
                                rect,
                            });
                        }
                    }
                }
            }
        }
        if let Some(door) = self.door(front, &found, rng) {
            let blocked = grown(door.rect, BETWEEN / 2.0);
            let meets = |a: [f64; 2], b: [f64; 2]| a[0] < b[1] && b[0] < a[1];
            found.retain(|e| e.wall != door.wall || !(0..2).all(|i| meets(e.rect[i], blocked[i])));
            found.push(door);
        }
        found
    }

    /// The front in quarter turns from the main direction, in proportion to the free length of its walls.
    fn front(&self, rng: &mut impl Rng) -> usize {
        let mut lengths = [0.0; 4];
        for room in &self.rooms {
            // Seen from the main direction as front: the side's quarter turn.
            let quarter = [0, 2, 3, 1][self.side(room.wall, 0)];
            lengths[quarter] += room.length();
        }
        let mut left = rng.random::<f64>() * lengths.iter().sum::<f64>();
        for (k, length) in lengths.iter().enumerate() {
            left -= length;
            if left < 0.0 {
                return k;
            }
        }
        0
    }

    /// A door on the front: in place of a window of the ground floor, or in the middle of its wall.
    fn door(&self, front: usize, windows: &[Element], rng: &mut impl Rng) -> Option<Element> {
        let [width, height] = DOOR;
        let own: Vec<&Room> = (self.rooms.iter())
            .filter(|r| self.side(r.wall, front) == 0 && r.length() > 0.0)
            .collect();
        let room = own.choose_weighted(rng, |r| r.length()).ok()?;
        let face = &self.faces.walls[room.wall];
        let foot = face.bounds[1][0] + THRESHOLD;
        let below = windows
            .iter()
            .filter(|e| e.wall == room.wall && e.storey == 0);
        let mut places: Vec<f64> = below.map(|e| (e.rect[0][0] + e.rect[0][1]) / 2.0).collect();
        places.push((face.bounds[0][0] + face.bounds[0][1]) / 2.0);
        let middle = *places.choose(rng)?;
        let rect = [
            [middle - width / 2.0, middle + width / 2.0],
            [foot, foot + height],
        ];
        let room_for = [
            [rect[0][0] - MARGIN, rect[0][1] + MARGIN],
            [foot - THRESHOLD / 2.0, foot + height + MARGIN],
        ];
        face.has_room(room_for).then_some(Element {
            kind: ElementKind::Door,
            wall: room.wall,
            storey: 0,
            rect,
        })
    }
}

fn grown(rect: Span, by: f64) -> Span {
    rect.map(|[low, high]| [low - by, high + by])
}

/// The stretches of a wall in whose every column some storey has room.
fn runs(face: &WallFace, ground: f64) -> Vec<[f64; 2]> {
    let [along, up] = face.bounds;
    let mut found: Vec<[f64; 2]> = Vec::new();
    if (along[1] - along[0]) * (up[1] - up[0]) > 1e5 {
        return found;
    }
    let mut is_open = false;
    let mut u = along[0] + COLUMN;
    while u <= along[1] - COLUMN {
        let mut foot = ground;
        let mut free = false;
        while foot < up[1] && !free {
            free = face.has_room([[u - COLUMN, u + COLUMN], BAND.map(|z| foot + z)]);
            foot += MIDDLE;
        }
        match (free, is_open, found.last_mut()) {
            (true, true, Some(run)) => run[1] = u + COLUMN,
            (true, _, _) => found.push([u - COLUMN, u + COLUMN]),
            _ => {}
        }
        is_open = free;
        u += STEP;
    }
    found.retain(|[a, b]| b - a > 3.0 * COLUMN);
    found
}

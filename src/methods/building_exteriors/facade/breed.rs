//! Method `paper`: Eq. 4 by a genetic algorithm over the layouts of all wall pieces, each sized by Eq. 5.
//!
//! ```text
//! E(F) = sum over sides s, attributes j of ((F_js - F*_js) / F*_js)^2                       (Eq. 4)
//! ```
//!
//! A genome has a section for each side and in it a gene for each piece: its layout. Crossover swaps the layouts of
//! one piece (each piece comes from either parent with equal chance), mutation draws the layout of one piece anew.
//! A layout alternates wall and elements, as in Bao et al. 2013: their widths sum to that of the piece and are nearest
//! to the average widths of the sub-styles, each between 0.5 and 1.5 times its average (Eq. 5, [`knapsack`]).
//!
//! [`knapsack`]: super::knapsack

use rand::{Rng, RngExt};

use super::doors::door_strip;
use super::elements::{Elements, SubStyle};
use super::glaze::millimetres;
use super::knapsack::widths;
use super::layout::{FacadeTarget, Facades};
use super::room::{Room, Walls};
use crate::attributes::facade_attributes;
use edifice_optim::Step;
use edifice_optim::genetic::{Breed, Genetic, GeneticError, Settings};
use edifice_shape::solid::Faces;
use edifice_shape::{Building, ElementStyle, FacadeElement, FacadePiece, Side};

/// Width of an element over its average (Eq. 5).
const RANGE: [f64; 2] = [0.5, 1.5];
/// Most elements of a piece, and draws of a layout before the piece stays bare.
const MOST: usize = 6;
const DRAWS: usize = 12;
/// Lowest door and window (m).
const LEAST: [f64; 2] = [1.9, 0.3];

/// Breeds facades; returns those of lowest energy and every generation.
///
/// # Errors
/// [`GeneticError`] for settings out of range.
pub fn breed(
    building: &Building,
    shell: &Faces,
    target: &FacadeTarget,
    elements: &Elements,
    deviations: &[f64],
    settings: Settings,
    seed: u64,
) -> Result<(Facades, Vec<Step>), GeneticError> {
    let walls = Walls::new(building, shell, &target.fixed);
    let door = door_strip(building, &walls, Side::Front);
    let mut places = Vec::new();
    for (s, strips) in walls.strips.iter().enumerate() {
        for (k, strip) in strips.iter().enumerate() {
            places.extend(strip.rooms.iter().map(|room| WallSection {
                room,
                side: Side::ALL[s],
                start: millimetres(strip.start),
                width: millimetres(strip.width()),
                door: s == 0 && door == Some(k) && room.piece.floor == 0,
            }));
        }
    }
    let mut house = House {
        walls: &walls,
        places,
        elements,
        target,
        deviations,
        evaluations: 0,
    };
    let (run, _) = Genetic::new(settings, Vec::new(), seed)?.run(&mut house, |_| {})?;
    let pieces = house.pieces(&run.best);
    let facades = Facades {
        max_z: house.max_z(&pieces),
        evaluations: house.evaluations,
        pieces,
    };
    Ok((facades, run.trace))
}

/// Eq. 4 of finished facades; a wanted value of zero is divided by the standard deviation instead, and a side without
/// walls counts as zeros.
pub fn energy(
    pieces: &[FacadePiece],
    floor_height: f64,
    wanted: &[f64; 12],
    deviations: &[f64],
) -> f64 {
    let measured = measured(pieces, floor_height);
    let terms = measured.iter().zip(wanted).zip(deviations);
    terms
        .map(|((m, w), s)| ((m - w) / if *w > 1e-9 { *w } else { *s }).powi(2))
        .sum()
}

fn measured(pieces: &[FacadePiece], floor_height: f64) -> Vec<f64> {
    let walls = Building {
        name: String::new(),
        unit: String::new(),
        floor_height,
        boxes: Vec::new(),
        facades: pieces.to_vec(),
        special: Vec::new(),
        unobserved: Vec::new(),
    };
    let measured = facade_attributes(&walls).into_iter();
    measured.map(|v| v.unwrap_or(0.0)).collect()
}

/// A wall piece of the house.
struct WallSection<'a> {
    room: &'a Room,
    side: Side,
    start: f64,
    width: f64,
    /// The door of the house stands here.
    door: bool,
}

struct House<'a> {
    walls: &'a Walls<'a>,
    places: Vec<WallSection<'a>>,
    elements: &'a Elements,
    target: &'a FacadeTarget,
    deviations: &'a [f64],
    evaluations: u64,
}

/// The layout of a piece.
type Gene = Vec<FacadeElement>;

impl House<'_> {
    fn pieces(&self, genome: &[Gene]) -> Vec<FacadePiece> {
        let floor_height = self.walls.floor_height;
        let piece = |(place, gene): (&WallSection, &Gene)| match &place.room.fixed {
            Some(fixed) => fixed.clone(),
            None => FacadePiece {
                side: place.side,
                start: place.start,
                base: place.room.piece.floor as f64 * floor_height,
                width: place.width,
                height: floor_height,
                elements: gene.clone(),
            },
        };
        self.places.iter().zip(genome).map(piece).collect()
    }

    fn max_z(&self, pieces: &[FacadePiece]) -> f64 {
        let measured = measured(pieces, self.walls.floor_height);
        let z = measured
            .iter()
            .zip(&self.target.wanted)
            .zip(self.deviations);
        z.map(|((m, w), s)| ((m - w) / s).abs()).fold(0.0, f64::max)
    }

    /// A random layout that Eq. 5 can size: of one sub-style or of several, in equal parts.
    fn layout(&self, place: &WallSection, rng: &mut impl Rng) -> Gene {
        let doors = &self.elements.doors;
        for _ in 0..DRAWS {
            let count = rng.random_range(0..=MOST);
            let uniform: bool = rng.random();
            let mut chosen: Vec<SubStyle> = Vec::with_capacity(count);
            for k in 0..count {
                let of = &self.elements.windows;
                match of.len() {
                    0 => break,
                    _ if uniform && k > 0 => chosen.push(chosen[0]),
                    n => chosen.push(of[rng.random_range(0..n)]),
                }
            }
            if place.door && !doors.is_empty() {
                let door = doors[rng.random_range(0..doors.len())];
                match chosen.len() {
                    0 => chosen.push(door),
                    n => chosen[rng.random_range(0..n)] = door,
                }
            }
            if let Some(gene) = self.sized(place, &chosen) {
                return gene;
            }
        }
        Vec::new()
    }

    /// Eq. 5: walls and elements alternate and fill the piece. Elements that a roof, a porch or a garage door hides are
    /// left out; `None` when no widths fit.
    fn sized(&self, place: &WallSection, chosen: &[SubStyle]) -> Option<Gene> {
        let mut average = vec![self.elements.gap];
        for e in chosen {
            average.extend([e.width, self.elements.gap]);
        }
        let bound = |factor: f64| average.iter().map(|w| factor * w).collect::<Vec<f64>>();
        let sizes = match chosen.is_empty() {
            true => return Some(Vec::new()),
            false => widths(&average, &bound(RANGE[0]), &bound(RANGE[1]), place.width)?,
        };
        let mut at = 0.0;
        let mut gene = Vec::with_capacity(chosen.len());
        for (k, e) in chosen.iter().enumerate() {
            at += sizes[2 * k];
            let width = sizes[2 * k + 1];
            gene.extend(self.placed(place, e, at, width));
            at += width;
        }
        Some(gene)
    }

    fn placed(
        &self,
        place: &WallSection,
        e: &SubStyle,
        at: f64,
        width: f64,
    ) -> Option<FacadeElement> {
        let start = place.room.piece.start.max(place.start) + at;
        let free = self.walls.free(place.room, [start, start + width])?;
        let is_door = e.style == ElementStyle::Door;
        let low = if is_door { 0.0 } else { free[0] };
        let height = e.height.min(free[1] - low);
        if height < LEAST[usize::from(!is_door)] {
            return None;
        }
        let y = if is_door {
            0.0
        } else {
            e.sill.min(free[1] - height).max(free[0])
        };
        Some(FacadeElement {
            style: e.style,
            x: millimetres(at),
            y: millimetres(y),
            width: millimetres(width),
            height: millimetres(height),
        })
    }
}

impl Breed for House<'_> {
    type Genome = Vec<Gene>;

    /// The energy of a layout (Eq. 4).
    fn cost(&mut self, genome: &Vec<Gene>) -> f64 {
        self.evaluations += 1;
        let pieces = self.pieces(genome);
        energy(
            &pieces,
            self.walls.floor_height,
            &self.target.wanted,
            self.deviations,
        )
    }

    fn random<R: Rng>(&mut self, rng: &mut R) -> Vec<Gene> {
        self.places
            .iter()
            .map(|place| self.layout(place, rng))
            .collect()
    }

    fn cross<R: Rng>(&mut self, a: &Vec<Gene>, b: &Vec<Gene>, rng: &mut R) -> Vec<Gene> {
        let each = a.iter().zip(b);
        each.map(|(p, q)| if rng.random() { p.clone() } else { q.clone() })
            .collect()
    }

    fn mutate<R: Rng>(&mut self, genome: &mut Vec<Gene>, rng: &mut R) {
        if !genome.is_empty() {
            let k = rng.random_range(0..genome.len());
            genome[k] = self.layout(&self.places[k], rng);
        }
    }
}

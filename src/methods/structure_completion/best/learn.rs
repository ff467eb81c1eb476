//! The probability of a candidate element, learnt from whole layouts with parts hidden.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::candidates::{Candidate, Candidates};
use super::doors;
use super::masses;
use super::observation::Observation;
use super::pool::{pool, weights};
use crate::layout::{Class, Element, Layout};
use crate::measure::agreement;
use crate::model::Model;
use crate::sights::Sight;
use edifice_base::rng::stream;
use edifice_base::{Progress, Watched};
use edifice_model::boosting::{Boosting, BoostingError, Settings};

/// Most candidates that are learnt from; of more, every second, third, ... is.
const MOST_ROWS: usize = 120_000;
/// The same of places of a door, and of numbers of columns and rows.
const MOST_PLACES: usize = 60_000;
/// Layouts that agree this well, scaled to one outline, show one building.
const TWINS: f64 = 0.7;

/// For each layout its group of near-twins, by the lowest index of the group: layouts whose elements agree with an F1 of
/// at least 0.7 at an intersection over union of 0.5, scaled to one outline.
pub fn twins(layouts: &[Layout]) -> Vec<usize> {
    let unit = |layout: &Layout| -> Vec<Element> {
        let scaled = layout.elements.iter().map(|e| {
            let mut e = *e;
            e.rect.x /= layout.width;
            e.rect.width /= layout.width;
            e.rect.y /= layout.height;
            e.rect.height /= layout.height;
            e
        });
        scaled.collect()
    };
    let scaled: Vec<Vec<Element>> = layouts.iter().map(unit).collect();
    let alike: Vec<Vec<usize>> = (0..layouts.len())
        .into_par_iter()
        .map(|a| {
            let alike = |b: &usize| {
                let (few, many) = (
                    scaled[a].len().min(scaled[*b].len()),
                    scaled[a].len().max(scaled[*b].len()),
                );
                // The most that F1 could be.
                2.0 * few as f64 >= TWINS * (few + many) as f64
                    && agreement(&scaled[a], &scaled[*b], 0.5).f1 >= TWINS
            };
            (0..a).filter(alike).collect()
        })
        .collect();
    let mut group: Vec<usize> = (0..layouts.len()).collect();
    for (a, others) in alike.into_iter().enumerate() {
        for b in others {
            let (from, to) = (group[a].max(group[b]), group[a].min(group[b]));
            group
                .iter_mut()
                .filter(|g| **g == from)
                .for_each(|g| *g = to);
        }
    }
    group
}

/// Candidates of one layout with a part hidden: the features of each, and whether it is true at both overlaps.
type Rows = (Vec<Vec<f64>>, Vec<[f64; 2]>);
/// Places of a door: the features of each, and whether a hidden door is there.
type DoorRows = (Vec<Vec<f64>>, Vec<f64>);

/// Numbers of columns and rows: the features of each pair, and whether the layout has them.
type MassRows = (Vec<Vec<f64>>, Vec<f64>);

/// A layout with a part hidden.
#[derive(Clone, Copy)]
struct Unit {
    index: usize,
    sight: Sight,
}

/// Features and truth of all candidates of one layout with a part hidden; none where the part holds nothing.
fn rows(model: &Model, unit: Unit, without: &[usize], seed: u64) -> (Rows, DoorRows, MassRows) {
    let Unit { index, sight } = unit;
    let layout = &model.examples[index].layout;
    let name = format!("structure completion: learning, {}", sight.name());
    let mut rng = stream(seed, &name, index as u64);
    let (partial, hidden) = sight.hide(layout, &mut rng);
    if hidden.is_empty() {
        return Default::default();
    }
    let draws = pool(&partial, model, without, &mut rng);
    let fallback = model.window_size(partial.width, partial.height);
    let observation = Observation::new(&partial, partial.observed.clone(), fallback);
    let candidates = Candidates::new(&observation, &draws);
    let truth = |c: &Candidate| {
        let own = hidden.iter().filter(|h| h.class == c.element.class);
        let best = own.map(|h| h.rect.iou(&c.element.rect)).fold(0.0, f64::max);
        OVERLAPS.map(|least| f64::from(u8::from(best >= least)))
    };
    let targets = candidates.all.iter().map(truth).collect();
    let places = doors::places(&observation, &draws, &candidates);
    let is_door = |p: &doors::DoorCandidate| {
        let mut own = hidden.iter().filter(|h| h.class == Class::Door);
        f64::from(u8::from(
            own.any(|h| h.rect.iou(&p.element.rect) >= OVERLAPS[0]),
        ))
    };
    let of_doors = places.iter().map(is_door).collect();
    let rows = candidates.all.into_iter().map(|c| c.features).collect();
    let of_places = places.into_iter().map(|p| p.features).collect();
    let shares = masses::shares(&draws, &weights(&draws));
    let example = &model.examples[index];
    let own = (example.columns.len(), example.rows.len());
    let numbers = masses::features(&observation, &shares).into_iter();
    let of_numbers = numbers
        .map(|(lattice, features)| (features, f64::from(u8::from(lattice == own))))
        .unzip();
    ((rows, targets), (of_places, of_doors), of_numbers)
}

/// The learnt probabilities of elements.
pub struct Learnt {
    /// Probability of a candidate at an intersection over union of 0.5.
    pub loose: Boosting,
    /// The same at 0.75.
    pub tight: Boosting,
    /// Probability of a place of a door; `None` where every layout shows one whatever is hidden.
    pub doors: Option<Boosting>,
    /// Probability of numbers of columns and rows.
    pub masses: Boosting,
}

/// At most `most` of all rows: every second, third, ... of them.
fn thinned<T>(parts: Vec<(Vec<Vec<f64>>, Vec<T>)>, most: usize) -> (Vec<Vec<f64>>, Vec<T>) {
    let total: usize = parts.iter().map(|p| p.1.len()).sum();
    let every = total.div_ceil(most).max(1);
    let rows = parts
        .into_iter()
        .flat_map(|(rows, truth)| rows.into_iter().zip(truth));
    rows.step_by(every).unzip()
}

/// Intersections over union at which a candidate is true.
const OVERLAPS: [f64; 2] = [0.5, 0.75];

/// Learns element probabilities at an intersection over union of 0.5 and of 0.75: every layout of the database is completed
/// with each part hidden ([`Sight::all`]), from the rest of the database without its near-twins. Stopped, from the parts
/// that were hidden until then.
///
/// # Errors
/// [`BoostingError`] when no layout has a candidate.
pub fn learn(model: &Model, seed: u64, watched: &Watched) -> Result<Learnt, BoostingError> {
    let layouts: Vec<Layout> = model.examples.iter().map(|e| e.layout.clone()).collect();
    let group = twins(&layouts);
    let sights = Sight::all();
    let units = (0..layouts.len()).flat_map(|index| {
        let of = |&sight: &Sight| Unit { index, sight };
        sights.iter().map(of).collect::<Vec<Unit>>()
    });
    let units: Vec<Unit> = units.collect();
    let done = AtomicU64::new(0);
    let parts: Vec<(Rows, DoorRows, MassRows)> = units
        .par_iter()
        .map(|&unit| {
            let told = Progress::of(
                "facades with a part hidden",
                done.fetch_add(1, Ordering::Relaxed),
                units.len() as u64,
            );
            if !watched.goes_on(told) {
                return Default::default();
            }
            let twin = |other: &usize| group[*other] == group[unit.index];
            let without: Vec<usize> = (0..layouts.len()).filter(twin).collect();
            rows(model, unit, &without, seed)
        })
        .collect();
    let (mut all, mut places, mut numbers) = (Vec::new(), Vec::new(), Vec::new());
    for (own, of_doors, of_numbers) in parts {
        all.push(own);
        places.push(of_doors);
        numbers.push(of_numbers);
    }
    let (features, targets): Rows = thinned(all, MOST_ROWS);
    let (places, are_doors): DoorRows = thinned(places, MOST_PLACES);
    let (numbers, are_right): MassRows = thinned(numbers, MOST_PLACES);
    let settings = Settings {
        trees: 100,
        levels: 6,
        rate: 0.12,
        ..Settings::default()
    };
    let at = |k: usize| {
        let targets: Vec<f64> = targets.iter().map(|t| t[k]).collect();
        Boosting::learn(&features, &targets, settings, &watched.inner())
    };
    let of_doors = Settings {
        trees: 80,
        levels: 5,
        rate: 0.1,
        ..Settings::default()
    };
    let doors = match places.is_empty() {
        true => None,
        false => Some(Boosting::learn(
            &places,
            &are_doors,
            of_doors,
            &watched.inner(),
        )?),
    };
    let of_masses = Settings {
        trees: 80,
        levels: 4,
        rate: 0.1,
        ..Settings::default()
    };
    Ok(Learnt {
        loose: at(0)?,
        tight: at(1)?,
        doors,
        masses: Boosting::learn(&numbers, &are_right, of_masses, &watched.inner())?,
    })
}

//! A pool of weighted layouts: exact draws of lines, mirrored layouts, transfers from the database; each on shared lines
//! (`regular`).

use rand::Rng;

use super::categorical;
use super::chain::{Chain, LineProblem};
use super::density::Spacing;
use super::fill::{fill, lines_at};
use super::observation::Observation;
use super::regular::regular;
use super::symmetry;
use super::transfer;
use crate::baselines::lattice;
use crate::completion::Reason;
use crate::layout::Element;
use crate::layout::lines::numbers;
use crate::model::{Example, Model};
use crate::partial::PartialLayout;
use edifice_base::rng::Stream;
use edifice_shape::Axis;

/// Draws of each kind.
pub const DRAWS: usize = 16;
/// Bins of the chain for the extent of an element.
const BINS_PER_SIZE: f64 = 8.0;
/// Most bins of an axis.
const MOST_BINS: usize = 480;

/// The origin of a layout of the pool.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// Lines by the chain.
    Chain,
    /// Mirrored, then lines by the chain.
    Mirrored,
    /// Lines by the chain, the part below the lowest seen row from the database.
    Below,
    /// Mirrored, and the part below from the database.
    MirroredBelow,
    /// A database facade warped to the seen lines.
    Warped,
    /// Mirror images alone.
    Mirror,
    /// The lattice of each class, continued at its typical gap.
    Lattice,
}

impl Origin {
    /// All origins, in the order of the features.
    pub const ALL: [Origin; 7] = [
        Origin::Chain,
        Origin::Mirrored,
        Origin::Below,
        Origin::MirroredBelow,
        Origin::Warped,
        Origin::Mirror,
        Origin::Lattice,
    ];

    /// True if a layout of this origin is a draw of a whole completion.
    pub fn is_whole(self) -> bool {
        !matches!(self, Origin::Mirror | Origin::Lattice)
    }
}

/// Share of each origin in the pool as a whole, in the order of [`Origin::ALL`].
pub(super) const SHARES: [f64; 7] = [0.15, 0.25, 0.2, 0.3, 0.1, 0.0, 0.0];
/// A layout of the pool.
#[derive(Debug, Clone)]
pub struct Draw {
    /// Its origin.
    pub origin: Origin,
    /// Share among the layouts of its origin.
    pub weight: f64,
    /// Added elements with their reasons.
    pub added: Vec<(Element, Reason)>,
    /// Columns and rows of its lattice.
    pub lattice: (usize, usize),
    /// Columns and rows of its windows and the seen ones, counted as those of an annotation are ([`numbers`]).
    pub numbers: (usize, usize),
    /// Centres of the columns and of the rows on which its windows and the seen ones stand.
    pub lines: [Vec<f64>; 2],
}

/// The database, and how its rows compare with the lowest seen one.
struct Database<'a> {
    examples: &'a [(usize, &'a Example)],
    rows: transfer::Surroundings,
}

/// Makes the pool; database facades in `without` are left out.
pub fn pool(
    partial: &PartialLayout,
    model: &Model,
    without: &[usize],
    rng: &mut Stream,
) -> Vec<Draw> {
    let examples: Vec<(usize, &Example)> = (model.examples.iter().enumerate())
        .filter(|(index, _)| !without.contains(index))
        .collect();
    let fallback = model.window_size(partial.width, partial.height);
    let observation = Observation::new(partial, partial.observed.clone(), fallback);
    let database = Database {
        rows: transfer::Surroundings::new(&observation, &examples),
        examples: &examples,
    };
    let mut draws = Vec::new();
    let rows = row_draws(&observation, &model.rows, 4 * DRAWS, rng);
    let columns = column_draws(&observation, &model.columns, 2 * DRAWS, rng);
    let (plain, lower) = columns.split_at(columns.len() / 2);
    let mut rows = rows.iter().cycle();
    let mut next_rows = || rows.next().cloned().unwrap_or_default();
    for invented in plain {
        draws.push(whole(
            &observation,
            invented,
            &next_rows(),
            None,
            Origin::Chain,
            rng,
        ));
    }
    for invented in lower {
        let below = Some(&database);
        draws.push(whole(
            &observation,
            invented,
            &next_rows(),
            below,
            Origin::Below,
            rng,
        ));
    }
    if !observation.elements.is_empty() {
        for (axis, count) in sampled_axes(&observation, &model.columns, DRAWS, rng) {
            let added = symmetry::additions(&observation, axis);
            let mut elements = observation.elements.to_vec();
            elements.extend(&added);
            let mirrored = Observation::new(partial, elements, fallback);
            let images: Vec<(Element, Reason)> =
                added.iter().map(|e| (*e, Reason::Symmetry)).collect();
            draws.push(Draw {
                origin: Origin::Mirror,
                weight: count as f64,
                added: images.clone(),
                lattice: (mirrored.columns.len(), mirrored.rows.len()),
                numbers: Default::default(),
                lines: Default::default(),
            });
            for (k, invented) in column_draws(&mirrored, &model.columns, 2 * count, rng)
                .iter()
                .enumerate()
            {
                let below = (k % 2 == 1).then_some(&database);
                let origin = if k % 2 == 1 {
                    Origin::MirroredBelow
                } else {
                    Origin::Mirrored
                };
                let mut draw = whole(&mirrored, invented, &next_rows(), below, origin, rng);
                draw.added.extend(images.iter().copied());
                draws.push(draw);
            }
        }
    }
    draws.extend(warped(&observation, &examples));
    let open = lattice(partial, false);
    draws.push(Draw {
        origin: Origin::Lattice,
        weight: 1.0,
        added: open.added.iter().map(|a| (a.element, a.reason)).collect(),
        lattice: (observation.columns.len(), observation.rows.len()),
        numbers: Default::default(),
        lines: Default::default(),
    });
    for draw in &mut draws {
        let made = regular(&observation, &draw.added);
        let added = made.added.into_iter();
        draw.added = added.map(|(e, reason, _)| (e, reason)).collect();
        draw.lines = made.lines.map(|l| l.all.iter().map(|l| l.at).collect());
        draw.lattice = (draw.lines[0].len(), draw.lines[1].len());
        draw.numbers = numbers(
            partial
                .observed
                .iter()
                .chain(draw.added.iter().map(|a| &a.0)),
        );
    }
    for origin in Origin::ALL {
        let total: f64 = draws
            .iter()
            .filter(|d| d.origin == origin)
            .map(|d| d.weight)
            .sum();
        for draw in draws.iter_mut().filter(|d| d.origin == origin) {
            draw.weight /= total;
        }
    }
    draws
}

/// Weight of each layout in the whole pool.
pub(super) fn weights(draws: &[Draw]) -> Vec<f64> {
    let own = draws.iter().map(|d| d.weight * SHARES[d.origin as usize]);
    let total: f64 = own.clone().sum();
    own.map(|w| w / total.max(1e-12)).collect()
}

/// Axes with the number of draws for each.
fn sampled_axes<R: Rng>(
    observation: &Observation,
    spacing: &Spacing,
    count: usize,
    rng: &mut R,
) -> Vec<(f64, usize)> {
    let axes = symmetry::axes(observation, spacing);
    let weights: Vec<f64> = axes.iter().map(|a| a.1).collect();
    let mut counts = vec![0; axes.len()];
    for _ in 0..count {
        counts[categorical(&weights, rng)] += 1;
    }
    let drawn = axes.iter().zip(counts).filter(|(_, count)| *count > 0);
    drawn.map(|(axis, count)| (axis.0, count)).collect()
}

/// One layout from invented columns and rows; with a database, what lies below the lowest seen row comes from there.
fn whole<R: Rng>(
    observation: &Observation,
    columns: &[f64],
    rows: &[f64],
    database: Option<&Database>,
    origin: Origin,
    rng: &mut R,
) -> Draw {
    let columns = lines_at(&observation.columns, columns, observation.size.0);
    let mut transferred = Vec::new();
    let mut invented = rows.to_vec();
    let mut count = None;
    if let (Some(database), Some(last)) = (database, observation.rows.first()) {
        let choices = database.rows.choices(&columns, observation.size.0);
        let weights: Vec<f64> = choices.iter().map(|b| b.weight).collect();
        if !choices.is_empty() {
            let choice = choices[categorical(&weights, rng)];
            let example = database.examples[choice.example].1;
            transferred = transfer::below_elements(observation, &columns, example, choice.row);
            invented.retain(|&y| y > last.at);
            count = Some(choice.row);
        }
    }
    let rows = lines_at(&observation.rows, &invented, observation.size.1);
    let mut added: Vec<(Element, Reason)> = fill(observation, &columns, &rows, rng)
        .into_iter()
        .map(|e| (e, Reason::Lattice))
        .collect();
    let (width, height) = (observation.partial.width, observation.partial.height);
    for mut element in transferred {
        element.rect = transfer::inside(element.rect, width, height);
        let others = observation
            .elements
            .iter()
            .chain(added.iter().map(|(e, _)| e));
        let taken = others.into_iter().any(|e| e.excludes(&element));
        if !taken && observation.partial.allows(&element) {
            added.push((element, Reason::Database));
        }
    }
    Draw {
        origin,
        weight: 1.0,
        lattice: (columns.len(), rows.len() + count.unwrap_or(0)),
        numbers: Default::default(),
        lines: Default::default(),
        added,
    }
}

/// The best warped facades.
fn warped(observation: &Observation, examples: &[(usize, &Example)]) -> Vec<Draw> {
    let mut found: Vec<(transfer::Warped, (usize, usize))> = examples
        .iter()
        .filter_map(|(_, e)| {
            Some((
                transfer::warp(observation, e)?,
                (e.columns.len(), e.rows.len()),
            ))
        })
        .collect();
    found.sort_by(|a, b| b.0.log_weight.total_cmp(&a.0.log_weight));
    found.truncate(DRAWS);
    let top = found.first().map_or(0.0, |f| f.0.log_weight);
    let draw = |(warped, lattice): (transfer::Warped, (usize, usize))| Draw {
        origin: Origin::Warped,
        weight: (warped.log_weight - top).exp(),
        added: warped
            .elements
            .iter()
            .map(|e| (*e, Reason::Database))
            .collect(),
        lattice,
        numbers: Default::default(),
        lines: Default::default(),
    };
    found.into_iter().map(draw).collect()
}

/// Positions of invented columns.
fn column_draws<R: Rng>(
    observation: &Observation,
    spacing: &Spacing,
    count: usize,
    rng: &mut R,
) -> Vec<Vec<f64>> {
    draws(observation, Axis::X, spacing, count, rng)
}

/// Positions of invented rows; the chain runs from the top down.
fn row_draws<R: Rng>(
    observation: &Observation,
    spacing: &Spacing,
    count: usize,
    rng: &mut R,
) -> Vec<Vec<f64>> {
    draws(observation, Axis::Y, spacing, count, rng)
}

fn draws<R: Rng>(
    observation: &Observation,
    axis: Axis,
    spacing: &Spacing,
    count: usize,
    rng: &mut R,
) -> Vec<Vec<f64>> {
    let length = observation.length(axis);
    let (problem, bin) = line_problem(observation, axis);
    let drawn = Chain::new(&problem, spacing, false).draw(count, rng);
    if drawn.is_empty() {
        return vec![Vec::new(); count];
    }
    let position = |bins: usize| {
        let at = (bins as f64 + 0.5) * bin;
        if axis == Axis::X { at } else { length - at }
    };
    let invented = |lines: Vec<usize>| {
        let new = lines
            .into_iter()
            .filter(|b| problem.observed.binary_search(b).is_err());
        new.map(position).collect()
    };
    drawn.into_iter().map(invented).collect()
}

/// The lines of an observation along an axis as a problem of the chain, and the length of a bin. Rows run down.
pub fn line_problem(observation: &Observation, axis: Axis) -> (LineProblem, f64) {
    let (length, size) = (observation.length(axis), observation.extent(axis));
    let bins = (length / size * BINS_PER_SIZE)
        .ceil()
        .clamp(8.0, MOST_BINS as f64) as usize;
    let bin = length / bins as f64;
    let along = |at: f64| if axis == Axis::X { at } else { length - at };
    let mut observed: Vec<usize> = (observation.lines(axis).iter())
        .map(|l| ((along(l.at) / bin) as usize).min(bins - 1))
        .collect();
    observed.sort_unstable();
    observed.dedup();
    let closest = observed.windows(2).map(|w| w[1] - w[0]).min();
    let widest = observed.windows(2).map(|w| w[1] - w[0]).max().unwrap_or(0);
    let size = size / bin;
    let least = (1.05 * size).ceil() as usize;
    let evidence = (0..bins)
        .map(|b| observation.evidence(axis, along((b as f64 + 0.5) * bin)))
        .collect();
    let problem = LineProblem {
        bins,
        size,
        least: least.min(closest.unwrap_or(least)).max(1),
        most: ((6.0 * size) as usize).max(widest).min(bins),
        observed,
        evidence,
    };
    (problem, bin)
}

//! Houses around observed boxes and facade pieces, which stay as they are to the bit.
//!
//! Coordinates of the partial house are kept. Its corner of least x and y is taken for that of the whole house where
//! the wanted bounding box allows it; else the observed boxes stand at the left or right end, in front or at the back.
//! Wanted columns that the observed boxes contradict are moved and reported as repairs; given ones never are.

use rand::Rng;

use super::error::CompleteError;
use super::observed::wanted_rows;
use super::reconcile::{SAME, origins, reconciled};
use crate::attributes::{AttributeRow, mass_attributes};
use crate::data::table;
use crate::facade::FixedPiece;
use crate::house::walls::walls_of_pieces;
use crate::house::{Database, Draft, Frozen, GenerateError, Generated, Options, Wish, draft};
use crate::mass::contradiction::check_given;
use crate::mass::repair::{changes, repair};
use crate::mass::target::{PARTS, part_of};
use crate::mass::{
    Block, MASS, MassError, MassModel, MassTarget, SearchLimits, is_sound, max_z, search,
};
use crate::model_file::ModelFile;
use edifice_base::rng::stream;
use edifice_shape::{BoxStyle, Building, MassBox};

/// Mass models within this distance (standard deviations) are near enough not to try another place.
const NEAR: f64 = 0.05;
/// Rounds of random arrangements around observed boxes, as a multiple of those without any.
const MORE: usize = 2;
/// Samples among which the most probable answers are sought, answers tried for each house wanted, and their
/// least root mean square distance in standard deviations.
const POOL: usize = 2000;
const TRIES: usize = 12;
/// Rounds of random arrangements for an answer, and the distance in standard deviations at which to stop.
const ROUNDS: usize = 8;
const ENOUGH: f64 = 0.03;
const APART: f64 = 0.05;

/// Completions of a partial house: the most probable answers of the model to what is given, built around the observed
/// parts, those that come nearest to their answer first. Answers whose houses miss the given size, plan or floors, as one
/// with a porch may whose plan is known, are passed over while there are others.
///
/// # Errors
/// [`CompleteError`]; when some answers can be built, the others are passed over.
pub fn completions(
    partial: &Building,
    model: &ModelFile,
    given: &AttributeRow,
    count: usize,
    database: &Database,
    options: &Options,
    seed: u64,
) -> Result<Vec<Generated>, CompleteError> {
    let mut rng = stream(seed, "building/complete", 0);
    // An answer that does not fit the observed boxes is not worth a long search: there are others.
    let options = &Options {
        search: SearchLimits {
            rounds: options.search.rounds.min(ROUNDS),
            enough: ENOUGH,
            ..options.search.clone()
        },
        ..options.clone()
    };
    let evidence = table(std::slice::from_ref(given))?;
    let draws = model.most_probable(&evidence, TRIES * count, POOL, APART, &mut rng)?;
    let is_given: [bool; 49] = std::array::from_fn(|c| given[c].is_some());
    let (mut houses, mut missing) = (Vec::new(), Vec::new());
    let mut first = None;
    let misses = |house: &Generated| {
        let off = |c: usize, given: f64| (house.report.reached[c] - given).abs();
        let own = given.iter().enumerate().take(PARTS[0].1);
        own.filter_map(|(c, v)| Some((c, (*v)?)))
            .any(|(c, v)| off(c, v) > NEAR * database.deviations[c])
    };
    let rows = wanted_rows(&draws.table);
    for (k, wanted) in rows.iter().enumerate() {
        if houses.len() == count {
            break;
        }
        let name = format!("{}_{}", partial.name, k + 1);
        let mut rng = stream(seed, "building/complete/house", k as u64);
        let house = around(
            &name, partial, wanted, &is_given, database, options, &mut rng,
        );
        match house.and_then(|house| Ok(house.build()?)) {
            Ok(house) if misses(&house) => missing.push(house),
            Ok(house) => houses.push(house),
            Err(e) => first = first.or(Some(e)),
        }
    }
    houses.extend(missing);
    houses.truncate(count);
    if let (true, Some(first)) = (houses.is_empty(), first) {
        // What contradicts the given values is wrong with every answer.
        return Err(match first {
            CompleteError::Outside { .. } | CompleteError::NoWall { .. } => first,
            first => CompleteError::NoAnswer {
                tried: rows.len(),
                first: Box::new(first),
            },
        });
    }
    let fit = |h: &Generated| (h.report.unplaced, h.report.mean_z);
    houses.sort_by(|a, b| {
        let (p, q) = (fit(a), fit(b));
        p.0.cmp(&q.0).then(p.1.total_cmp(&q.1))
    });
    for (k, house) in houses.iter_mut().enumerate() {
        let name = format!("{}_{}", partial.name, k + 1);
        house.report.house.clone_from(&name);
        house.building.name = name;
    }
    Ok(houses)
}

/// A house with the wanted attributes around the boxes and facade pieces of a partial house, at the corner of
/// `options.frozen` where it is known; without its surface, so that rows can be compared.
///
/// # Errors
/// [`CompleteError`].
pub fn around(
    name: &str,
    partial: &Building,
    wanted: &[f64; 49],
    given: &[bool; 49],
    database: &Database,
    options: &Options,
    rng: &mut impl Rng,
) -> Result<Draft, CompleteError> {
    check_given(wanted, given).map_err(GenerateError::from)?;
    let frozen = Frozen {
        boxes: partial.boxes.clone(),
        pieces: fixed_pieces(partial)?,
        corner: options.frozen.corner,
    };
    let corner = frozen.corner;
    let options = Options {
        frozen,
        ..options.clone()
    };
    let (row, known) = reconciled(partial, wanted, given)?;
    let mut best: Option<Draft> = None;
    let mut failed = None;
    let corners = corner.map_or_else(|| origins(partial, &row), |c| vec![c]);
    for origin in corners {
        match placed(
            name,
            partial,
            origin,
            (wanted, &row, &known),
            database,
            &options,
            rng,
        ) {
            Ok(house) => {
                let z = house.repaired_z();
                if best.as_ref().is_none_or(|b| z < b.repaired_z()) {
                    best = Some(house);
                }
            }
            Err(e) => failed = failed.or(Some(e)),
        }
        if best.as_ref().is_some_and(|b| b.repaired_z() <= NEAR) {
            break;
        }
    }
    best.ok_or_else(|| failed.unwrap_or(CompleteError::Hidden))
}

/// The house with its corner at `origin`; `rows` are the wanted and the reconciled row and which columns must stay.
fn placed(
    name: &str,
    partial: &Building,
    origin: [f64; 2],
    rows: (&[f64; 49], &[f64; 49], &[bool; 49]),
    database: &Database,
    options: &Options,
    rng: &mut impl Rng,
) -> Result<Draft, CompleteError> {
    let (wanted, mut row, mut known) = (rows.0, *rows.1, *rows.2);
    for b in &partial.boxes {
        if let Some(k) = part_of(b, origin[1] + row[1] / 2.0) {
            let c = PARTS[k].1;
            row[c] = (b.x - origin[0]) / row[0];
            row[c + 1] = (b.y - origin[1]) / row[1];
            (row[c + 2], row[c + 3], row[c + 4]) = (b.width, b.depth, b.height);
            if row[c + 5] <= 0.0 {
                row[c + 5] = 0.5;
            }
            known[c..c + 5].fill(true);
        }
    }
    repair(&mut row, &known, &database.deviations);
    let changes = changes(wanted, &row);
    let mut target = MassTarget::new(std::array::from_fn(|c| row[c]));
    target.floor_height = partial.floor_height;
    let general = partial.boxes.iter().filter(|b| b.style == BoxStyle::Main);
    let blocks: Vec<Block> = general
        .map(|b| {
            let plan = b.plan();
            Block {
                edges: [
                    [plan.x - origin[0], plan.right() - origin[0]],
                    [plan.y - origin[1], plan.top() - origin[1]],
                ],
                floors: partial.floors_of(b).min(target.floors),
                roof: b.roof,
                frozen: true,
            }
        })
        .collect();
    // Observed boxes bind arrangements: it takes more of them to reach the attributes.
    let options_of_search = SearchLimits {
        rounds: MORE * options.search.rounds,
        ..options.search.clone()
    };
    let mut mass = search(&target, &blocks, database, &options_of_search, rng)
        .map_err(|e: MassError| GenerateError::from(e))?;
    exactly(&mut mass, &partial.boxes, origin);
    if !is_sound(&mass.building) {
        return Err(CompleteError::Hidden);
    }
    let measured = mass_attributes(&mass.building);
    mass.max_z = max_z(&measured, &row[..MASS], &database.deviations);
    let wish = Wish {
        name,
        wanted,
        row: &row,
        repaired: changes,
    };
    let house = draft(wish, mass, database, options, rng)?;
    match stands(&house.building, &options.frozen.pieces) {
        true => Ok(house),
        false => Err(CompleteError::Hidden),
    }
}

/// Moves the house to the origin and puts the observed boxes, as they are, in place of those fitted.
fn exactly(mass: &mut MassModel, observed: &[MassBox], origin: [f64; 2]) {
    let boxes = &mut mass.building.boxes;
    for b in boxes.iter_mut() {
        (b.x, b.y) = (b.x + origin[0], b.y + origin[1]);
    }
    for own in observed {
        let same = |b: &MassBox| {
            let (p, q) = (b.plan(), own.plan());
            let ends = [
                p.x - q.x,
                p.y - q.y,
                p.right() - q.right(),
                p.top() - q.top(),
            ];
            b.style == own.style && ends.iter().all(|d| d.abs() < SAME)
        };
        match boxes.iter().position(same) {
            Some(k) => boxes[k] = *own,
            None => boxes.push(*own),
        }
    }
}

/// The observed pieces with their walls.
fn fixed_pieces(partial: &Building) -> Result<Vec<FixedPiece>, CompleteError> {
    let walls = walls_of_pieces(partial).into_iter().enumerate();
    let fixed = walls
        .zip(&partial.facades)
        .map(|((index, wall), piece)| match wall {
            Some(wall) => Ok(FixedPiece {
                piece: piece.clone(),
                at: wall.at,
            }),
            None => Err(CompleteError::NoWall { index }),
        });
    fixed.collect()
}

/// True if the pieces stand on their walls.
fn stands(building: &Building, fixed: &[FixedPiece]) -> bool {
    let walls = walls_of_pieces(building);
    fixed.iter().all(|f| {
        let mut own = building.facades.iter().zip(&walls);
        own.any(|(p, w)| *p == f.piece && w.is_some_and(|w| (w.at - f.at).abs() < SAME))
    })
}

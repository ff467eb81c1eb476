//! Houses from facades with marked windows and doors, and a ground plan (Sec. 7, Fig. 1 and 17): the marks stay where they
//! are, the rest is the model's.
//!
//! # Deviations and readings
//! - The paper's user marks parts of the mass model beside the windows and doors; here the ground plan is given whole, and all
//!   storeys cover it. The walls reach to the eaves of the first facade.
//! - A house has neither garage nor porch nor tower: none is marked, and each would change walls that are given.
//! - A mark stands on the foremost wall of its side. Walls that others hide, and sides without a facade, are the model's.
//! - Storeys are equally high, as everywhere here; the lines between them are moved by up to a tenth of a storey where they would cut a mark.
//! - Of the most probable answers of the model those come first whose house has nothing that one would not believe.

use edifice_base::rng::stream;
use edifice_shape::{Building, ElementStyle, FacadePiece, Rect, Side};

use super::facades_error::FacadesError;
use super::left_out::LeftOut;
use super::marked::{Mark, MarkedFacade, marks};
use super::observed::wanted_rows;
use super::placing::Places;
use super::storeys::Storeys;
use crate::attributes::{AttributeRow, attributes, facade_attributes};
use crate::data::table;
use crate::house::inspect::implausible;
use crate::house::{Database, Draft, Frozen, GenerateError, Generated, Options, Wish, draft};
use crate::mass::footprint::whole;
use crate::mass::repair::{changes, repair};
use crate::mass::{MASS, MassModel};
use crate::model_file::ModelFile;

/// Samples among which the most probable answers are sought, answers tried for each house wanted, and their
/// least root mean square distance in standard deviations.
const POOL: usize = 2000;
const TRIES: usize = 12;
const APART: f64 = 0.05;
/// First columns of the facades, the window styles and the special elements.
const STYLES: usize = 39;
const WINDOWS: usize = 42;
const SPECIAL: usize = 47;
/// Window styles in the order of their columns; a window without a style of its own is never a bay.
const PLAIN: [(usize, ElementStyle); 4] = [
    (0, ElementStyle::Sash),
    (1, ElementStyle::Sliding),
    (2, ElementStyle::Casement),
    (4, ElementStyle::Fixed),
];

/// A marked region, and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkedRegion {
    /// The side of its facade.
    pub side: Side,
    /// Index of the region in its layout.
    pub region: usize,
    /// Its label.
    pub label: String,
    /// The largest distance of an edge of the window or door on the house from the mark, in metres; or why there is none.
    pub placed: Result<f64, LeftOut>,
}

/// A house made of facades and a plan.
#[derive(Debug, Clone)]
pub struct FacadeHouse {
    /// The house.
    pub house: Generated,
    /// Every region of every facade that is not background, in their order.
    pub marked: Vec<MarkedRegion>,
    /// Number of storeys.
    pub storeys: usize,
    /// Properties of the house that one would not believe ([`implausible`]).
    pub findings: Vec<String>,
}

/// The facades and the plan of a house, and how many answers are wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct Facades<'a> {
    /// Name of the house; `_1`, `_2`, ... follow it where more than one is wanted.
    pub name: &'a str,
    /// Its facades, at most one for each side; the first tells the eaves.
    pub facades: &'a [MarkedFacade],
    /// Its ground plan: rectangles from the origin on, in metres.
    pub plan: &'a [Rect],
    /// Houses wanted.
    pub count: usize,
    /// Seed of all random streams.
    pub seed: u64,
}

/// Houses with the windows and doors of facades on a plan, at most as many as wanted, the most believable first.
///
/// # Errors
/// [`FacadesError`]; a mark that has no place is no error, the result says why.
pub fn from_facades(
    wanted: &Facades,
    model: &ModelFile,
    database: &Database,
    options: &Options,
) -> Result<Vec<FacadeHouse>, FacadesError> {
    let Facades {
        name,
        facades,
        plan,
        count,
        seed,
    } = *wanted;
    let (marks, eaves) = marks(facades, plan)?;
    let storeys = Storeys::new(&marks, eaves)?;
    let mass = whole(plan, storeys.lines.len(), storeys.height)?;
    let places = Places::new(&marks, &mass.building, &storeys);
    let given = given(&places, &mass)?;
    let evidence = table(std::slice::from_ref(&given)).map_err(FacadesError::from)?;
    let mut rng = stream(seed, "building/from_facades", 0);
    let draws = model.most_probable(&evidence, TRIES * count, POOL, APART, &mut rng)?;
    let answers = wanted_rows(&draws.table);
    let build = Build {
        mass: &mass,
        given: &given,
        database,
        options,
        seed,
    };
    let mut drafts = Vec::new();
    let mut failed = None;
    for (k, answer) in answers.iter().enumerate() {
        match build.draft(name, &places, answer, k) {
            Ok(made) => drafts.push((implausible(&made.building).len(), k, made)),
            Err(e) => failed = failed.or(Some(e)),
        }
    }
    if let (true, Some(e)) = (drafts.is_empty(), failed) {
        return Err(e.into());
    }
    drafts.sort_by_key(|d| (d.0, d.1));
    let mut houses = Vec::new();
    for (n, (_, answer, first)) in drafts.into_iter().take(count).enumerate() {
        let (mut places, mut house) = (places.clone(), first.build()?);
        // What the surface has no room for is left out, and told.
        while lost(&mut places, &house, &marks) {
            let again = build.draft(name, &places, &answers[answer], answer)?;
            house = again.build()?;
        }
        if count > 1 {
            let name = format!("{name}_{}", n + 1);
            house.report.house.clone_from(&name);
            house.building.name = name;
        }
        houses.push(told(house, facades, &places, &marks)?);
    }
    Ok(houses)
}

/// The attributes that the plan and the marks tell; all others are `None`.
fn given(places: &Places, mass: &MassModel) -> Result<AttributeRow, FacadesError> {
    let measured = Building {
        facades: pieces(places, ElementStyle::Fixed),
        ..mass.building.clone()
    };
    let mut row: AttributeRow = attributes(&measured)?;
    row[STYLES..].fill(None);
    row[SPECIAL + 1] = Some(0.0);
    for (k, style) in PLAIN.into_iter().chain([(3, ElementStyle::Bay)]) {
        if places.shows(style) {
            row[WINDOWS + k] = Some(1.0);
        }
    }
    Ok(row)
}

fn pieces(places: &Places, style: ElementStyle) -> Vec<FacadePiece> {
    let fixed = places.fixed(style).into_iter();
    fixed.map(|f| f.piece).collect()
}

/// The making of a house from an answer of the model.
struct Build<'a> {
    mass: &'a MassModel,
    given: &'a AttributeRow,
    database: &'a Database,
    options: &'a Options,
    seed: u64,
}

impl Build<'_> {
    fn draft(
        &self,
        name: &str,
        places: &Places,
        answer: &[f64; 49],
        number: usize,
    ) -> Result<Draft, GenerateError> {
        let flagged = PLAIN.iter().find(|(k, _)| answer[WINDOWS + k] > 0.5);
        let (column, style) = *flagged.unwrap_or(&PLAIN[3]);
        let fixed = places.fixed(style);
        let known: [bool; 49] = std::array::from_fn(|c| self.given[c].is_some());
        let mut wanted: [f64; 49] = std::array::from_fn(|c| self.given[c].unwrap_or(answer[c]));
        if places.is_plain() {
            wanted[WINDOWS + column] = 1.0;
        }
        // Marks that were left out since are not on the walls any more.
        let on_walls = Building {
            facades: fixed.iter().map(|f| f.piece.clone()).collect(),
            ..self.mass.building.clone()
        };
        for (k, value) in facade_attributes(&on_walls).into_iter().enumerate() {
            wanted[MASS + k] = value.unwrap_or(wanted[MASS + k]);
        }
        let mut row = wanted;
        repair(&mut row, &known, &self.database.deviations);
        let options = Options {
            frozen: Frozen {
                pieces: fixed,
                ..Frozen::default()
            },
            footprint: None,
            ..self.options.clone()
        };
        let wish = Wish {
            name,
            wanted: &wanted,
            row: &row,
            repaired: changes(&wanted, &row),
        };
        let mut rng = stream(self.seed, "building/from_facades/house", number as u64);
        draft(wish, self.mass.clone(), self.database, &options, &mut rng)
    }
}

/// Leaves out the marks that are not in the surface of a house; true if there are any.
fn lost(places: &mut Places, house: &Generated, marks: &[Mark]) -> bool {
    let mut any = false;
    for (piece, element) in &house.model.unplaced {
        let piece = &house.building.facades[*piece];
        let e = &piece.elements[*element];
        let rect = Rect::new(piece.start + e.x, piece.base + e.y, e.width, e.height);
        let own = |m: &Mark| m.side == piece.side && apart(&m.rect, &rect) < 1e-6;
        for (mark, place) in marks.iter().zip(&mut places.of) {
            if place.is_ok() && own(mark) {
                *place = Err(LeftOut::NoRoom);
                any = true;
            }
        }
    }
    any
}

/// The largest distance between edges of two rectangles.
fn apart(a: &Rect, b: &Rect) -> f64 {
    let ends = [
        a.x - b.x,
        a.right() - b.right(),
        a.y - b.y,
        a.top() - b.top(),
    ];
    ends.into_iter().fold(0.0, |most, d| d.abs().max(most))
}

/// The distance of a mark from the nearest window or door of the house, measured on its pieces.
fn measured(house: &Building, mark: &Mark) -> f64 {
    let pieces = house.facades.iter().filter(|p| p.side == mark.side);
    let all = pieces.flat_map(|p| {
        let own = p.elements.iter();
        let own = own.filter(|e| (e.style == ElementStyle::Door) == mark.is_door());
        own.map(|e| Rect::new(p.start + e.x, p.base + e.y, e.width, e.height))
    });
    all.map(|r| apart(&r, &mark.rect))
        .fold(f64::INFINITY, f64::min)
}

/// The house with what became of each region.
fn told(
    house: Generated,
    facades: &[MarkedFacade],
    places: &Places,
    marks: &[Mark],
) -> Result<FacadeHouse, FacadesError> {
    let mut marked = Vec::new();
    for facade in facades {
        for (region, r) in facade.layout.regions.iter().enumerate() {
            if edifice_shape::is_background(&r.label) {
                continue;
            }
            let own = |m: &Mark| m.side == facade.side && m.regions.contains(&region);
            let placed = match marks.iter().position(own) {
                None => Err(LeftOut::NoOpening {
                    label: r.label.clone(),
                }),
                Some(k) => (places.of[k].clone()).map(|_| measured(&house.building, &marks[k])),
            };
            marked.push(MarkedRegion {
                side: facade.side,
                region,
                label: r.label.clone(),
                placed,
            });
        }
    }
    let first = places.of.iter().find_map(|p| p.as_ref().err());
    if let (true, Some(first)) = (places.of.iter().all(Result::is_err), first) {
        return Err(FacadesError::NonePlaced {
            marked: places.of.len(),
            first: first.clone(),
        });
    }
    Ok(FacadeHouse {
        findings: implausible(&house.building),
        storeys: places.storeys().lines.len(),
        house,
        marked,
    })
}

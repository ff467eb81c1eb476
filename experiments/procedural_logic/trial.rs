//! Retrieval as question, candidate and judge.
//!
//! The question is a folder of label grids and a list of those that are queries; the answer is a CSV file `query,facade,distance` with the distance from each
//! query to every other facade. The judge ranks by distance (facades at equal distance come in random order, and the rates are
//! exact expectations over it) and looks which of them have the query's architecture, which candidates do not see.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::Arc;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::figure_4::retrieve;
use super::gold::{Architecture, Doors};
use super::settings::{Retrieval, measure, parameters};
use super::{outline, shipped};
use edifice_base::{Error, Result, Watched};
use edifice_io::{ReadOptions, json, read_bytes, read_facade, read_label_grid, write_atomic};
use edifice_procedural_logic::Model;
use edifice_shape::LabelGrid;
use edifice_sweep::trial::{Answered, Posed, Trial};
use edifice_sweep::{Given, Shared};

/// Retrieval of facades without architectural change.
pub(super) struct Ranking;

/// All facades, and which of them are queries.
pub(super) struct Question {
    facades: Arc<Facades>,
    queries: Vec<usize>,
}

/// Facades at all sizes; those of one file stand apart by the number of files.
pub(super) struct Facades {
    grids: Vec<LabelGrid>,
    architecture: Vec<Architecture>,
    key: String,
}

/// Why distances are no answer.
#[derive(Debug, thiserror::Error)]
enum Refused {
    #[error("the columns are {0:?}, expected query, facade and distance")]
    Columns(Vec<String>),
    #[error("there is no facade `{0}`")]
    Unknown(String),
    #[error("`{0}` is no query")]
    NoQuery(String),
    #[error("the distance `{0}` is no finite number of at least 0")]
    Distance(String),
    #[error("the distance from `{0}` to `{1}` stands twice")]
    Twice(String, String),
    #[error("the distance from `{0}` to `{1}` is missing")]
    Missing(String, String),
    #[error("two facades are called `{0}`")]
    SameName(String),
}

const GRID_FORMAT: &str = "edifice/label-grid";

/// A label grid as a file.
#[derive(Serialize, Deserialize)]
struct GridFile {
    format: String,
    version: u32,
    name: String,
    unit: String,
    labels: Vec<String>,
    /// Boundaries of the columns, from 0.
    xs: Vec<f64>,
    /// Boundaries of the rows, from 0 at the bottom.
    ys: Vec<f64>,
    /// Indices into `labels`, one list a row from the bottom.
    rows: Vec<Vec<u16>>,
}

impl Trial for Ranking {
    type Settings = Retrieval;
    type Question = Question;
    /// The architecture of every facade.
    type Truth = Arc<Facades>;
    /// Distances from each query to all facades, in the order of the question; 0 to itself.
    type Answer = Vec<Vec<f64>>;

    const OUTPUT: &'static str = "answer.csv";
    const CLAIMS: &'static [&'static str] = &["rules"];

    fn prepare(settings: &Retrieval, given: &Given) -> Result<(Question, Arc<Facades>)> {
        static FACADES: Shared<Facades> = Shared::new();
        let mut paths: Vec<_> = given.database.iter().map(|p| p.as_path()).collect();
        paths.push(given.path);
        // By name, so that the order is the same wherever the files are.
        paths.sort_by_key(|path| (path.file_name(), *path));
        let own = paths.iter().position(|p| *p == given.path).unwrap_or(0);
        let key = format!("{} {paths:?}", settings.sizes);
        let facades = FACADES.get(key.clone(), || {
            let grids: Result<Vec<LabelGrid>> = paths.iter().map(|path| picture(path)).collect();
            Ok(at_all_sizes(grids?, settings.sizes, key))
        })?;
        let queries = (own..facades.grids.len()).step_by(paths.len()).collect();
        let truth = Arc::clone(&facades);
        Ok((Question { facades, queries }, truth))
    }

    fn candidate(
        settings: &Retrieval,
        question: &Question,
        _: u64,
        _: &Watched,
    ) -> Result<Answered<Vec<Vec<f64>>>> {
        /// All distances, and the number of rules.
        struct Ranked(DMatrix<f64>, usize);
        static RANKED: Shared<Ranked> = Shared::new();
        let key = format!("{settings:?} {}", question.facades.key);
        let ranked = RANKED.get(key, || {
            let grids = &question.facades.grids;
            let model = Model::fit(grids, parameters(settings)?).map_err(Error::method)?;
            let profiles = model.profiles().map_err(Error::method)?;
            let rules = model.inference.rules.len();
            Ok(Ranked(measure(settings).matrix(&profiles), rules))
        })?;
        let row = |query: &usize| ranked.0.row(*query).iter().copied().collect();
        Ok(Answered {
            claims: BTreeMap::from([("rules".to_owned(), ranked.1 as f64)]),
            ..Answered::plain(question.queries.iter().map(row).collect())
        })
    }

    fn judge(
        _: &Retrieval,
        question: &Question,
        truth: &Arc<Facades>,
        distances: &Vec<Vec<f64>>,
    ) -> Result<BTreeMap<String, f64>> {
        let count = truth.grids.len();
        let mut matrix = DMatrix::zeros(count, count);
        for (query, row) in question.queries.iter().zip(distances) {
            for (facade, distance) in row.iter().enumerate() {
                matrix[(*query, facade)] = *distance;
            }
        }
        // Judged by the architecture, which the method does not see.
        let curve = retrieve(&matrix, &truth.architecture, Doors::Layout);
        let queries: Vec<&Vec<f64>> = (curve.queries.iter())
            .filter(|(query, _)| question.queries.contains(query))
            .map(|(_, rates)| rates)
            .collect();
        let mut found = BTreeMap::from([("queries".to_owned(), queries.len() as f64)]);
        // A facade that no other equals is no query.
        if !queries.is_empty() {
            for rank in [1, 2, 5, 20] {
                let sum: f64 = queries.iter().map(|rates| rates[rank - 1]).sum();
                found.insert(format!("rank_{rank}"), sum / queries.len() as f64);
            }
        }
        Ok(found)
    }

    fn pose(question: &Question, folder: &Path) -> Result<Posed> {
        let names = names(question)?;
        let (input, learn) = (folder.join("queries.csv"), folder.join("facades"));
        std::fs::create_dir(&learn).map_err(|e| Error::io(&learn, "create", e))?;
        for (index, grid) in question.facades.grids.iter().enumerate() {
            let file = GridFile {
                format: GRID_FORMAT.into(),
                version: 1,
                name: grid.name.clone(),
                unit: grid.unit.clone(),
                labels: grid.labels.clone(),
                xs: grid.xs.clone(),
                ys: grid.ys.clone(),
                rows: (grid.cells.chunks(grid.columns().max(1)))
                    .map(<[u16]>::to_vec)
                    .collect(),
            };
            let text = serde_json::to_vec(&file).map_err(Error::method)?;
            // Numbered, so that the order is that of the names.
            write_atomic(&learn.join(format!("{index:05}.grid.json")), &text)?;
        }
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(["query"]).map_err(Error::method)?;
        for query in &question.queries {
            writer
                .write_record([names[*query]])
                .map_err(Error::method)?;
        }
        let bytes = writer
            .into_inner()
            .map_err(|e| Error::method(e.to_string()))?;
        write_atomic(&input, &bytes)?;
        let learn = Some(learn);
        Ok(Posed { input, learn })
    }

    fn posed(posed: &Posed) -> Result<Question> {
        let mut grids = Vec::new();
        if let Some(folder) = &posed.learn {
            for path in edifice_frame::layouts::files(folder, ".json")? {
                grids.push(read_grid(&path)?);
            }
        }
        let table = edifice_io::building_csv::read(&posed.input)?;
        let query = |row: &Vec<String>| {
            let at = grids.iter().position(|grid| grid.name == row[0]);
            at.ok_or_else(|| Error::content(&posed.input, Refused::Unknown(row[0].clone())))
        };
        let queries = table.rows.iter().map(query).collect::<Result<_>>()?;
        let facades = Facades {
            grids,
            // Only a judge needs them.
            architecture: Vec::new(),
            key: format!("{:?}", posed.learn),
        };
        Ok(Question {
            facades: Arc::new(facades),
            queries,
        })
    }

    fn write(question: &Question, distances: &Vec<Vec<f64>>, path: &Path) -> Result<()> {
        let names = names(question)?;
        let mut writer = csv::Writer::from_writer(Vec::new());
        let head = ["query", "facade", "distance"];
        writer.write_record(head).map_err(Error::method)?;
        for (query, row) in question.queries.iter().zip(distances) {
            for (facade, distance) in row.iter().enumerate().filter(|(f, _)| f != query) {
                let distance = distance.to_string();
                let record = [names[*query], names[facade], &distance];
                writer.write_record(record).map_err(Error::method)?;
            }
        }
        let bytes = writer
            .into_inner()
            .map_err(|e| Error::method(e.to_string()))?;
        write_atomic(path, &bytes)
    }

    fn read(question: &Question, path: &Path) -> Result<Vec<Vec<f64>>> {
        let names = names(question)?;
        let index: HashMap<&str, usize> = names.iter().copied().zip(0..).collect();
        let table = edifice_io::building_csv::read(path)?;
        let column = |name: &str| table.header.iter().position(|column| column == name);
        let columns = [column("query"), column("facade"), column("distance")];
        let [Some(query), Some(facade), Some(distance)] = columns else {
            return Err(Error::content(path, Refused::Columns(table.header)));
        };
        let mut rows = vec![vec![None; names.len()]; question.queries.len()];
        for (line, row) in table.rows.iter().enumerate() {
            let wrong = |error| Error::input(path, format!("row {}", line + 1), error);
            let named = |name: &String| {
                let found = index.get(name.as_str()).copied();
                found.ok_or_else(|| wrong(Refused::Unknown(name.clone())))
            };
            let (from, to) = (named(&row[query])?, named(&row[facade])?);
            let place = question.queries.iter().position(|q| *q == from);
            let place = place.ok_or_else(|| wrong(Refused::NoQuery(row[query].clone())))?;
            let value = row[distance].trim().parse::<f64>().ok();
            let value = value.filter(|value| value.is_finite() && *value >= 0.0);
            let value = value.ok_or_else(|| wrong(Refused::Distance(row[distance].clone())))?;
            if rows[place][to].replace(value).is_some() {
                let (from, to) = (row[query].clone(), row[facade].clone());
                return Err(wrong(Refused::Twice(from, to)));
            }
        }
        let mut distances = Vec::new();
        for (query, row) in question.queries.iter().zip(rows) {
            let filled: Result<Vec<f64>> = row
                .into_iter()
                .enumerate()
                .map(|(facade, value)| match value {
                    _ if facade == *query => Ok(0.0),
                    Some(value) => Ok(value),
                    None => {
                        let (from, to) = (names[*query].to_owned(), names[facade].to_owned());
                        Err(Error::content(path, Refused::Missing(from, to)))
                    }
                })
                .collect();
            distances.push(filled?);
        }
        Ok(distances)
    }
}

/// Judges a ranking of facades, each of which is a query, by their architecture.
///
/// # Errors
/// Why the file is no ranking of these facades.
pub fn evaluate(grids: Vec<LabelGrid>, ranking: &Path) -> Result<BTreeMap<String, f64>> {
    let queries = (0..grids.len()).collect();
    let facades = Arc::new(at_all_sizes(grids, 1, String::new()));
    let question = Question {
        facades: Arc::clone(&facades),
        queries,
    };
    let distances = Ranking::read(&question, ranking)?;
    Ranking::judge(&Retrieval::default(), &question, &facades, &distances)
}

/// The names of all facades, which are distinct.
fn names(question: &Question) -> Result<Vec<&str>> {
    let names: Vec<&str> = (question.facades.grids.iter())
        .map(|grid| grid.name.as_str())
        .collect();
    let mut seen = std::collections::HashSet::new();
    match names.iter().find(|name| !seen.insert(**name)) {
        Some(twice) => Err(Error::method(Refused::SameName((*twice).to_owned()))),
        None => Ok(names),
    }
}

fn read_grid(path: &Path) -> Result<LabelGrid> {
    let bytes = read_bytes(path)?;
    json::check_header(&bytes, path, GRID_FORMAT, 1)?;
    let file: GridFile = json::parse_json(&bytes, path)?;
    let grid = LabelGrid {
        name: file.name,
        unit: file.unit,
        xs: file.xs,
        ys: file.ys,
        labels: file.labels,
        cells: file.rows.concat(),
    };
    grid.check().map_err(|e| Error::content(path, e))?;
    Ok(grid)
}

/// A facade in the classes of the real sets.
fn picture(path: &Path) -> Result<LabelGrid> {
    let options = ReadOptions::default();
    if path.to_string_lossy().ends_with(".json") {
        let facade = read_facade(path, &options)?;
        return shipped::picture(&facade).map_err(|e| Error::content(path, e));
    }
    read_label_grid(path, &options)
}

fn at_all_sizes(mut grids: Vec<LabelGrid>, sizes: u64, key: String) -> Facades {
    let count = grids.len();
    let mut architecture: Vec<Architecture> = grids.iter().map(outline::architecture).collect();
    for copy in 2..=sizes {
        for index in 0..count {
            let grid = shipped::resized(&grids[index], copy);
            // Only where along the facade a door stands depends on sizes.
            let doors = outline::architecture(&grid).doors;
            let original = architecture[index].clone();
            architecture.push(Architecture { doors, ..original });
            grids.push(grid);
        }
    }
    Facades {
        grids,
        architecture,
        key,
    }
}

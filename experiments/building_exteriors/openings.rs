//! Windows and doors of city models, hidden and given back by the model (Sec. 1 names city models as a use of the
//! paper's generator; the paper prints no such table).
//!
//! Set `made`: the surfaces of the shipped houses without openings, their own windows and doors as the truth, the model
//! learnt from other data. Set `ingolstadt`: 54 buildings of level of detail 3, surveyed, whose walls are closed. An
//! element counts as found if one of its kind lies within 0.8 m of its plane with an intersection over union of at least
//! .5, one for each.

use edifice_base::{Error, Result};
use edifice_building_exteriors::dress::{Grid, Settings, dress, openings, plain_grid};
use edifice_building_exteriors::house::parts::parts;
use edifice_building_exteriors::house::{Joining, model};
use edifice_building_exteriors::model_file::ModelFile;
use edifice_building_exteriors::survey::Candidate;
use edifice_io::building_json;
use edifice_report::{Align, Row, Table};
use edifice_shape::triangles::TriangleMesh;
use edifice_shape::{Building, DetailedBuilding, PartKind, WallRect};
use serde_json::{Map, Value};

use super::data;
use super::hidden_openings::{Hidden, ingolstadt};
use edifice_frame::Context;

/// The model that ships, learnt from real houses.
const MODEL: &str = "building_exteriors/real.houses.json";
/// Farthest that an element may lie from the plane of another (m), and least cosine of their directions.
const PLANE: f64 = 0.8;
const DIRECTION: f64 = 0.97;
/// Distance up to which two elements in one plane are on one wall (m).
const BESIDE: f64 = 5.0;
/// Distance of two made houses (m).
const APART: f64 = 60.0;

/// Counts of one method on one set.
#[derive(Default)]
struct Score {
    /// For windows and doors: found, given, true.
    counts: [[usize; 3]; 2],
    /// Sum over the buildings of the difference of the numbers of windows.
    count_error: usize,
    /// Probability of each element given, and whether there is one.
    calls: Vec<(f64, bool)>,
}

/// Hides, gives back, and judges.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let path = ctx.shipped(MODEL)?;
    let text = std::fs::read_to_string(&path).map_err(|e| Error::io(&path, "read", e))?;
    let model = ModelFile::from_json(&text).map_err(|e| Error::content(&path, e))?;
    let path = ctx.shipped(data::HOUSES)?;
    let houses = building_json::read(&path)?;
    let few = ctx.budget().choose(4, 50, 200);
    let settings = Settings {
        draws: ctx.budget().choose(20, 100, 200),
        seed: ctx.seed(),
    };
    ctx.setting("houses", few);
    ctx.setting("draws", settings.draws);
    let mut sets = vec![("made", made(&houses[..few.min(houses.len())])?)];
    if let Some(path) = ctx.real("city/ingolstadt_lod3_semantic.json.gz")? {
        sets.push(("ingolstadt", ingolstadt(&path)?));
    }
    let mut table = Table::new("Windows and doors given back to closed walls")
        .column("buildings", Align::Left)
        .column("method", Align::Left)
        .numbers([
            "windows",
            "given",
            "precision",
            "recall",
            "F1",
            "difference of counts",
            "doors",
            "doors given",
            "F1 of doors",
            "mean probability",
            "share found",
            "calibration error",
        ]);
    for (set, hidden) in &sets {
        let none = Map::<String, Value>::new();
        let city: Vec<Candidate> = hidden
            .iter()
            .map(|h| Candidate {
                name: &h.name,
                mesh: &h.mesh,
                attributes: &none,
            })
            .collect();
        let ours = dress(&city, &model, &settings).map_err(Error::method)?;
        let grid = plain_grid(&city, &Grid::default());
        for (method, answer) in [("model", &ours), ("plain grid", &grid)] {
            let score = Score::new(hidden, answer, false);
            table.row(score.cells(set, method));
            for (metric, value) in [
                ("f1", score.f1(0)),
                ("precision", score.precision()),
                ("recall", score.recall()),
                ("f1_doors", score.f1(1)),
                (
                    "count_difference",
                    score.count_error as f64 / hidden.len() as f64,
                ),
            ] {
                ctx.observe(Row {
                    dataset: (*set).into(),
                    method: method.into(),
                    instance: "all".into(),
                    seed: Some(settings.seed),
                    metric: metric.into(),
                    value,
                    ..Row::default()
                });
            }
            if *set != "made" {
                let seen = Score::new(hidden, answer, true);
                table.row(seen.cells(&format!("{set}, walls with openings"), method));
            }
        }
    }
    ctx.table(&table);
    ctx.note(
        "The plain grid: windows of 1.2 m x 1.4 m, 3 m apart, a row in each storey of 2.9 m, on every wall that is free. \
         A probability is the share of draws with an element of the kind there; the calibration error is the mean \
         difference of probability and share found over ten bins. Walls that the survey did not see have no openings in \
         it: the rows of walls with openings count what is given on these alone.",
    );
    Ok(())
}

/// The made houses without their openings, side by side.
fn made(houses: &[Building]) -> Result<Vec<Hidden>> {
    let one = |(k, house): (usize, &Building)| -> Result<Hidden> {
        let whole = model(house, Joining::Boxes).map_err(Error::method)?;
        let mut closed = house.clone();
        closed.facades.clear();
        let closed = model(&closed, Joining::Boxes).map_err(Error::method)?;
        let moved = |p: &[f64; 3]| [p[0] + APART * k as f64, p[1], p[2]];
        let named = parts(house, &whole);
        let truth = openings(&named).filter_map(|p| {
            let mut rect = p.rect?;
            rect.corner = moved(&rect.corner);
            (!p.name.starts_with("garage")).then_some((p.kind, rect))
        });
        Ok(Hidden {
            name: house.name.clone(),
            mesh: TriangleMesh {
                positions: closed.surface.positions.iter().map(moved).collect(),
                triangles: closed.surface.triangles.iter().map(|(t, _)| *t).collect(),
            },
            truth: truth.collect(),
        })
    };
    houses.iter().enumerate().map(one).collect()
}

/// The second rectangle's corner from the first one's, along its wall and upwards; `None` in different planes.
fn offset(a: &WallRect, b: &WallRect) -> Option<[f64; 2]> {
    let along = a.along;
    let cosine = along[0] * b.along[0] + along[1] * b.along[1];
    let to = [b.corner[0] - a.corner[0], b.corner[1] - a.corner[1]];
    let off = along[0] * to[1] - along[1] * to[0];
    let u = along[0] * to[0] + along[1] * to[1];
    let is_same = cosine >= DIRECTION && off.abs() <= PLANE;
    is_same.then_some([u, b.corner[2] - a.corner[2]])
}

/// True if two rectangles lie on one wall, so far as one can see.
fn is_beside(a: &WallRect, b: &WallRect) -> bool {
    offset(a, b).is_some_and(|[u, _]| u.abs() < BESIDE)
}

/// Intersection over union of two rectangles on walls; 0 in different planes.
fn iou(a: &WallRect, b: &WallRect) -> f64 {
    let Some([u, z]) = offset(a, b) else {
        return 0.0;
    };
    let common = |from: f64, own: f64, other: f64| (own.min(from + other) - from.max(0.0)).max(0.0);
    let both = common(u, a.width, b.width) * common(z, a.height, b.height);
    both / (a.width * a.height + b.width * b.height - both)
}

impl Score {
    /// With `seen`, only what is given on walls with true openings counts.
    fn new(hidden: &[Hidden], answers: &[DetailedBuilding], seen: bool) -> Self {
        let mut score = Self::default();
        for (own, answer) in hidden.iter().zip(answers) {
            for (k, kind) in [PartKind::Window, PartKind::Door].into_iter().enumerate() {
                let truth: Vec<&WallRect> = own
                    .truth
                    .iter()
                    .filter(|t| t.0 == kind)
                    .map(|t| &t.1)
                    .collect();
                let mut is_used = vec![false; truth.len()];
                let mut given = 0;
                for part in openings(answer).filter(|p| p.kind == kind) {
                    let Some(rect) = part.rect else { continue };
                    let with = |t: &(PartKind, WallRect)| is_beside(&t.1, &rect);
                    if seen && !own.truth.iter().any(with) {
                        continue;
                    }
                    given += 1;
                    let free = (0..truth.len()).filter(|i| !is_used[*i]);
                    let found = free.into_iter().find(|&i| iou(truth[i], &rect) >= 0.5);
                    if let Some(i) = found {
                        is_used[i] = true;
                        score.counts[k][0] += 1;
                    }
                    let probability = part.attributes.get("probability").and_then(Value::as_f64);
                    score
                        .calls
                        .extend(probability.map(|p| (p, found.is_some())));
                }
                score.counts[k][1] += given;
                score.counts[k][2] += truth.len();
                if kind == PartKind::Window {
                    score.count_error += given.abs_diff(truth.len());
                }
            }
        }
        score
    }

    fn precision(&self) -> f64 {
        self.counts[0][0] as f64 / self.counts[0][1].max(1) as f64
    }

    fn recall(&self) -> f64 {
        self.counts[0][0] as f64 / self.counts[0][2].max(1) as f64
    }

    fn f1(&self, kind: usize) -> f64 {
        let [found, given, all] = self.counts[kind];
        2.0 * found as f64 / (given + all).max(1) as f64
    }

    /// Mean probability, share found, and expected calibration error over ten bins.
    fn calibration(&self) -> Option<[f64; 3]> {
        let n = self.calls.len() as f64;
        let sums = |calls: &[&(f64, bool)]| {
            let p: f64 = calls.iter().map(|c| c.0).sum();
            [p, calls.iter().filter(|c| c.1).count() as f64]
        };
        let all: Vec<&(f64, bool)> = self.calls.iter().collect();
        let bin = |c: &(f64, bool)| ((c.0 * 10.0) as usize).min(9);
        let error = (0..10).map(|b| {
            let own: Vec<&(f64, bool)> = self.calls.iter().filter(|c| bin(c) == b).collect();
            let [p, found] = sums(&own);
            (p - found).abs()
        });
        let [p, found] = sums(&all);
        (n > 0.0).then(|| [p / n, found / n, error.sum::<f64>() / n])
    }

    fn cells(&self, set: &str, method: &str) -> Vec<String> {
        let [[_, given, all], [_, doors_given, doors]] = self.counts;
        let number = |v: f64| format!("{v:.3}");
        let mut cells = vec![
            set.to_owned(),
            method.to_owned(),
            all.to_string(),
            given.to_string(),
            number(self.precision()),
            number(self.recall()),
            number(self.f1(0)),
            self.count_error.to_string(),
            doors.to_string(),
            doors_given.to_string(),
            number(self.f1(1)),
        ];
        match self.calibration() {
            Some(all) => cells.extend(all.map(number)),
            None => cells.extend(["–", "–", "–"].map(String::from)),
        }
        cells
    }
}

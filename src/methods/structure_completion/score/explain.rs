//! The explanation of a score: the grid, the pair or the side of the facade that makes each term what it is.

use super::grid::Grid;
use super::pair::{alignment, pattern};
use super::{Evaluation, ScoreModel, Term, global};

/// One term of a score.
#[derive(Debug, Clone, PartialEq)]
pub struct TermExplanation {
    /// The scoring function.
    pub term: Term,
    /// Its weight w.
    pub weight: f64,
    /// Its feature f: the mean over all grids or pairs.
    pub feature: f64,
    /// The least of its values over grids, pairs or the facade.
    pub least: f64,
    /// The grid, pair or facade at which that value arises, in words.
    pub culprit: String,
}

fn named(grid: &Grid) -> String {
    let [columns, rows] = [grid.lines[0].len(), grid.lines[1].len()];
    let [x, y] = grid.low;
    let class = grid.class.name();
    format!("{class} grid of {columns} x {rows} at ({x:.1}, {y:.1})")
}

impl ScoreModel {
    /// Every term of an evaluation with its culprit.
    pub fn explain(&self, evaluation: &Evaluation, facade: [f64; 2]) -> Vec<TermExplanation> {
        let lines = Term::ALL.into_iter().enumerate().map(|(k, term)| {
            let (least, culprit) = match k {
                0..4 => self.worst_grid(evaluation, k, facade),
                8 => self.worst_grid(evaluation, 4, facade),
                4..6 => worst_pair(evaluation, facade, k - 4),
                _ => (
                    evaluation.features[k],
                    self.of_facade(evaluation, facade, term),
                ),
            };
            TermExplanation {
                term,
                weight: self.weights[k],
                feature: evaluation.features[k],
                least,
                culprit,
            }
        });
        lines.collect()
    }

    fn worst_grid(&self, evaluation: &Evaluation, k: usize, facade: [f64; 2]) -> (f64, String) {
        let values = evaluation.unary.iter().map(|u| u[k]).enumerate();
        let Some((i, least)) = values.min_by(|a, b| a.1.total_cmp(&b.1)) else {
            return (0.0, "no grids".into());
        };
        let g = &evaluation.grids[i];
        let ratio = |value: Option<f64>| value.map_or("none".into(), |v| format!("{v:.3}"));
        let axes = |f: &dyn Fn(usize) -> Option<f64>| {
            format!("{} across and {} upright", ratio(f(0)), ratio(f(1)))
        };
        let what = match k {
            0 => format!("height / width {:.3}", g.size[1] / g.size[0]),
            1 => format!(
                "size / spacing {}",
                axes(&|a| g.spacing[a].map(|d| g.size[a] / d))
            ),
            2 => format!(
                "deviation / extent {}",
                axes(&|a| g.deviation[a].map(|d| d / g.extent(a)))
            ),
            3 => format!("{:.3} of its cells filled", g.completeness()),
            _ => {
                let worst = |axis: usize| {
                    let ends = g.ends[axis].iter();
                    let far = ends.map(|[low, high]| low.max(facade[axis] - high));
                    far.fold(0.0, f64::max) / g.size[axis]
                };
                format!(
                    "border up to {:.2} of its size at the sides, {:.2} above or below",
                    worst(0),
                    worst(1)
                )
            }
        };
        (least, format!("{}: {what}", named(g)))
    }

    fn of_facade(&self, evaluation: &Evaluation, facade: [f64; 2], term: Term) -> String {
        let grids = &evaluation.grids;
        if grids.is_empty() {
            return "no elements".into();
        }
        match term {
            Term::Compatibility => {
                let (sets, types) = self.compatibility.cover(grids, facade[0] * facade[1]);
                format!("{types} element types, covered by {sets} facades of the database")
            }
            Term::Coverage => {
                format!(
                    "grids cover {:.3} of the facade",
                    global::coverage(grids, facade)
                )
            }
            _ => {
                let (area, door) = global::symmetry(grids, facade);
                let door = door.map_or("no door".into(), |at| {
                    format!("doors at {at:.2} of the width")
                });
                format!("{area:.3} of the area is symmetric, {door}")
            }
        }
    }
}

fn worst_pair(evaluation: &Evaluation, facade: [f64; 2], k: usize) -> (f64, String) {
    let values = evaluation.pairs.iter().map(|p| p[k]).enumerate();
    let Some((at, least)) = values.min_by(|a, b| a.1.total_cmp(&b.1)) else {
        return (0.0, "no pairs of grids".into());
    };
    let count = evaluation.grids.len();
    let mut all = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
    let Some((i, j)) = all.nth(at) else {
        return (least, "no pairs of grids".into());
    };
    let (a, b) = (&evaluation.grids[i], &evaluation.grids[j]);
    let axes = (0..2).filter_map(|axis| {
        let axis_name = ["columns", "rows"][axis];
        match k {
            0 => pattern(a, b, axis).map(|p| format!("{axis_name} follow {}", p.letters())),
            _ => alignment(a, b, axis, facade)
                .map(|(_, share)| format!("{share:.2} of the {axis_name} aligned")),
        }
    });
    let what: Vec<String> = axes.collect();
    let what = match what.is_empty() {
        true => ["not interleaved", "projections do not overlap"][k].to_string(),
        false => what.join(", "),
    };
    (least, format!("{} and {}: {what}", named(a), named(b)))
}

//! The default model against the baselines: Wilcoxon's signed-rank test of the facades' differences in F1, two-sided, with
//! Holm's correction over all comparisons of a measure.
//!
//! A comparison is a set, a part hidden and a baseline. As a correction over very many comparisons hides small
//! differences, each part is compared over all real sets as well, with a correction of its own.

use std::collections::BTreeMap;

use super::columns::{BASELINES, COLUMNS, text};
use super::measures::Measured;
use super::models::MADE;
use edifice_frame::Context;
use edifice_report::{Align, Table};
use edifice_sweep::statistics::{holm, signed_rank};

/// Level of the tests.
const LEVEL: f64 = 0.05;

/// The default model against one baseline.
struct Margin {
    name: String,
    baseline: String,
    difference: f64,
    facades: usize,
    p: f64,
}

/// The values of one measure by column, of each facade.
type ByFacade<'a> = BTreeMap<(&'a str, &'a str, &'a str), BTreeMap<&'a str, f64>>;

/// All comparisons.
pub(crate) struct Margins<'a>(&'a [Measured]);

impl<'a> Margins<'a> {
    /// Of measured cases.
    pub(crate) fn new(cases: &'a [Measured]) -> Self {
        Self(cases)
    }

    /// Comparisons by what `name` makes of a set and a part; those that it names nothing are left out.
    fn compared(&self, measure: &str, name: impl Fn(&str, &str) -> Option<String>) -> Vec<Margin> {
        let mut facades: ByFacade = BTreeMap::new();
        for m in self.0 {
            if let Some(value) = m.value(measure) {
                let key = (m.case[0].as_str(), m.case[2].as_str(), m.case[1].as_str());
                facades.entry(key).or_default().insert(&m.column, value);
            }
        }
        let mut groups: BTreeMap<(String, &str), Vec<f64>> = BTreeMap::new();
        for ((set, part, _), columns) in &facades {
            let (Some(name), Some(own)) = (name(set, part), columns.get(COLUMNS[0])) else {
                continue;
            };
            for baseline in BASELINES {
                if let Some(value) = columns.get(baseline.name()) {
                    let group = groups.entry((name.clone(), baseline.name())).or_default();
                    group.push(own - value);
                }
            }
        }
        let mut margins: Vec<Margin> = groups
            .into_iter()
            .map(|((name, baseline), differences)| Margin {
                name,
                baseline: baseline.to_owned(),
                difference: differences.iter().sum::<f64>() / differences.len() as f64,
                facades: differences.len(),
                p: signed_rank(&differences).map_or(1.0, |s| s.p),
            })
            .collect();
        let raw: Vec<f64> = margins.iter().map(|m| m.p).collect();
        for (margin, p) in margins.iter_mut().zip(holm(&raw)) {
            margin.p = p;
        }
        margins
    }

    /// Writes how often the default model is significantly above and below, and each cell in which it is below.
    pub(crate) fn tables(&self, ctx: &mut Context) {
        let title =
            "The default model against the baselines (signed-rank test, Holm's correction, 5 %)";
        let mut summary = Table::new(title)
            .column("measure and cells", Align::Left)
            .numbers([
                "comparisons",
                "above",
                "no difference",
                "below",
                "lower mean",
            ]);
        let mut losses = Table::new("Cells in which a baseline is significantly better")
            .column("measure", Align::Left)
            .column("cell", Align::Left)
            .column("baseline", Align::Left)
            .numbers(["difference", "facades", "p (Holm)"]);
        for (measure, shown) in [("f1_50", "F1 at 0.5"), ("f1_75", "F1 at 0.75")] {
            let of_part = |set: &str, part: &str| (set != MADE).then(|| part.to_owned());
            let of_cell = |set: &str, part: &str| Some(format!("{set} {part}"));
            let both = [
                ("parts, real sets together", self.compared(measure, of_part)),
                ("sets and parts", self.compared(measure, of_cell)),
            ];
            for (cells, margins) in both {
                let sure = |m: &&Margin| m.p < LEVEL;
                let above = margins.iter().filter(sure).filter(|m| m.difference > 0.0);
                let below: Vec<&Margin> = (margins.iter().filter(sure))
                    .filter(|m| m.difference < 0.0)
                    .collect();
                let (above, lower) = (
                    above.count(),
                    margins.iter().filter(|m| m.difference < 0.0).count(),
                );
                let equal = margins.len() - above - below.len();
                let counts = [margins.len(), above, equal, below.len(), lower];
                let name = format!("{shown}, {cells}");
                summary.row(std::iter::once(name).chain(counts.into_iter().map(|n| n.to_string())));
                for m in below {
                    losses.row([
                        shown.to_owned(),
                        m.name.clone(),
                        m.baseline.clone(),
                        text(Some(m.difference), 3),
                        m.facades.to_string(),
                        text(Some(m.p), 4),
                    ]);
                }
            }
        }
        ctx.table(&summary);
        if losses.is_empty() {
            ctx.note("In no cell is a baseline significantly better.");
        } else {
            ctx.table(&losses);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(facade: usize, column: &str, value: f64) -> Measured {
        Measured {
            case: ["set".into(), facade.to_string(), "r20".into()],
            column: column.into(),
            values: vec![("f1_50".into(), value)],
            masses: Vec::new(),
            pair: None,
        }
    }

    #[test]
    fn a_baseline_that_is_always_better_is_found() {
        let mut cases = Vec::new();
        for k in 0..20 {
            cases.push(case(k, COLUMNS[0], 0.4 + 0.01 * k as f64));
            cases.push(case(k, "lattice", 0.5 + 0.011 * k as f64));
            cases.push(case(k, "mirror", 0.4 + 0.01 * k as f64));
        }
        let margins = Margins::new(&cases).compared("f1_50", |_, part| Some(part.to_owned()));
        let of = |name: &str| {
            margins
                .iter()
                .find(|m| m.baseline == name)
                .expect("a margin")
        };
        assert!(of("lattice").difference < -0.09 && of("lattice").p < 0.001);
        assert_eq!(of("mirror").p, 1.0);
    }
}

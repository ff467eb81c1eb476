//! The tables of the benchmark.

use std::collections::BTreeSet;

use super::super::plausibility::auc;
use super::against::Margins;
use super::columns::{BASELINES, COLUMNS, number, text};
use super::measures::{Measured, calibration_error, ratio};
use super::models::MADE;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_report::{Align, Table};
use edifice_structure_completion::sights::Sight;

/// Least number of pairs that a classifier is asked about.
const PAIRS: usize = 20;

/// All measured cases.
pub(crate) struct Cases<'a>(pub &'a [Measured]);

impl Cases<'_> {
    /// Names of the real sets; without real data that of the made facades.
    fn sets(&self) -> Vec<&str> {
        let all: BTreeSet<&str> = self.0.iter().map(|m| m.case[0].as_str()).collect();
        let real: Vec<&str> = all.iter().copied().filter(|s| *s != MADE).collect();
        if real.is_empty() {
            all.into_iter().collect()
        } else {
            real
        }
    }

    /// The cases of a column; of one set and of one part hidden, where they are given.
    fn of(&self, column: &str, set: Option<&str>, part: Option<&str>) -> Vec<&Measured> {
        let fits = |m: &&Measured| {
            m.column == column
                && set.is_none_or(|s| m.case[0] == s)
                && part.is_none_or(|p| m.case[2] == p)
        };
        self.0.iter().filter(fits).collect()
    }

    /// Mean of a measure; `None` of no case.
    fn mean(&self, cases: &[&Measured], measure: &str) -> Option<f64> {
        let values: Vec<f64> = cases.iter().filter_map(|m| m.value(measure)).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }

    /// Mean over sets of the means over their facades.
    fn over_sets(&self, column: &str, measure: &str, part: Option<&str>) -> Option<f64> {
        let means: Vec<f64> = self
            .sets()
            .into_iter()
            .filter_map(|set| self.mean(&self.of(column, Some(set), part), measure))
            .collect();
        (!means.is_empty()).then(|| means.iter().sum::<f64>() / means.len() as f64)
    }

    fn columns(&self) -> Vec<&'static str> {
        let names = COLUMNS.into_iter();
        let all = names.chain(BASELINES.iter().map(|b| b.name()));
        all.filter(|c| self.0.iter().any(|m| m.column == *c))
            .collect()
    }

    /// F1 at one overlap, of each part and over all, for all columns.
    fn agreement(&self, ctx: &mut Context, measure: &str, title: &str) {
        let columns = self.columns();
        let mut table = Table::new(title)
            .column("hidden", Align::Left)
            .numbers(columns.iter().copied());
        let rows = std::iter::once(None).chain(Sight::all().into_iter().map(|s| Some(s.name())));
        for part in rows {
            let name = part.clone().unwrap_or_else(|| "all".into());
            let cell = |column: &&str| text(self.over_sets(column, measure, part.as_deref()), 3);
            table.row(std::iter::once(name).chain(columns.iter().map(cell)));
        }
        ctx.table(&table);
    }

    /// The worth of a mask: each region with it, without it, and the answers without it judged within the region.
    fn masks(&self, ctx: &mut Context) {
        let mut table = Table::new("What a mask tells: the default model's F1 at 0.5 with it, without it, and of what is added within the region without it")
            .column("hidden", Align::Left)
            .numbers(["masked", "maskless", "maskless, within the region", "elements added beyond it"]);
        for part in Sight::all().into_iter().filter(|s| !s.is_masked()) {
            let own = |measure: &str, sight: Sight| {
                text(self.over_sets("default", measure, Some(&sight.name())), 3)
            };
            table.row([
                part.masked().name(),
                own("f1_50", part.masked()),
                own("f1_50", part),
                own("f1_50_within", part),
                own("beyond", part),
            ]);
        }
        ctx.table(&table);
    }

    /// F1 at 0.5 of each set and part.
    fn by_set(&self, ctx: &mut Context) {
        let columns = self.columns();
        let mut table = Table::new("F1 at 0.5, set by set")
            .column("set and hidden part", Align::Left)
            .numbers(columns.iter().copied());
        let mut sets = self.sets();
        if !sets.contains(&MADE) {
            sets.push(MADE);
        }
        for set in sets {
            for part in Sight::all() {
                let part = part.name();
                let cell = |column: &&str| {
                    let own = self.of(column, Some(set), Some(&part));
                    text(self.mean(&own, "f1_50"), 3)
                };
                let cells = columns.iter().map(cell);
                table.row(std::iter::once(format!("{set} {part}")).chain(cells));
            }
        }
        ctx.table(&table);
    }

    /// Coherence, doors, counts and calibration of one column of `best`.
    fn further(&self, ctx: &mut Context, column: &str) {
        const MEASURES: [&str; 11] = [
            "overlaps, %",
            "new windows off lines, %",
            "columns within 1, %",
            "rows within 1, %",
            "doors found",
            "false doors a facade",
            "CRPS of the count",
            "80 % interval covers",
            "its width",
            "ECE of mass, first answers",
            "ECE of mass, all answers",
        ];
        let mut table = Table::new(format!("Further measures: {column}"))
            .column("hidden", Align::Left)
            .numbers(MEASURES);
        let sets = self.sets();
        let rows = std::iter::once(None).chain(Sight::all().into_iter().map(|s| Some(s.name())));
        for part in rows {
            let cases: Vec<&Measured> = sets
                .iter()
                .flat_map(|set| self.of(column, Some(set), part.as_deref()))
                .collect();
            let percent = |m: &str| text(self.mean(&cases, m).map(|v| 100.0 * v), 1);
            let off = ratio(cases.iter(), "off_lines", "new_windows");
            let firsts = cases.iter().filter_map(|m| m.masses.first().copied());
            let firsts: Vec<(f64, bool)> = firsts.collect();
            let all: Vec<(f64, bool)> = cases.iter().flat_map(|m| m.masses.clone()).collect();
            let name = part.clone().unwrap_or_else(|| "all".into());
            table.row([
                name,
                percent("overlaps"),
                number(100.0 * off, 1),
                percent("columns_right"),
                percent("rows_right"),
                number(ratio(cases.iter(), "doors_found", "doors_hidden"), 2),
                text(self.mean(&cases, "doors_false"), 2),
                text(self.mean(&cases, "count_crps"), 2),
                text(self.mean(&cases, "count_covered"), 3),
                text(self.mean(&cases, "count_width"), 1),
                number(calibration_error(&firsts).0, 3),
                number(calibration_error(&all).0, 3),
            ]);
        }
        ctx.table(&table);
    }

    /// Skill of a classifier of truth against draws, both on shared lines.
    fn draws(&self, ctx: &mut Context) -> Result<()> {
        let columns: Vec<&str> = COLUMNS
            .into_iter()
            .filter(|c| self.columns().contains(c))
            .collect();
        let title = "AUC of a classifier of truth against draws, both on shared lines (0.5: it cannot tell them apart)";
        let mut table = Table::new(title)
            .column("set", Align::Left)
            .numbers(columns.iter().copied());
        for set in self.sets() {
            let mut cells = vec![set.to_owned()];
            for column in &columns {
                let cases = self.of(column, Some(set), None);
                let pairs = cases.iter().filter_map(|m| m.pair.clone());
                let pairs: Vec<(Vec<f64>, Vec<f64>)> = pairs.collect();
                if pairs.len() < PAIRS {
                    cells.push("–".into());
                    continue;
                }
                let skill = auc(&pairs, ctx.seed()).map_err(Error::method)?;
                let row = super::super::row(set, column, "all".into(), None, "auc_draws", skill);
                ctx.observe(row);
                cells.push(number(skill, 2));
            }
            table.row(cells);
        }
        ctx.table(&table);
        Ok(())
    }

    /// Writes all tables.
    pub(crate) fn tables(&self, ctx: &mut Context) -> Result<()> {
        self.agreement(ctx, "f1_50", "F1 at an intersection over union of 0.5");
        self.agreement(ctx, "f1_75", "F1 at 0.75");
        self.agreement(ctx, "f1_50_95", "F1 at 0.5 to 0.95, mean of ten");
        for column in COLUMNS.into_iter().filter(|c| self.columns().contains(c)) {
            self.further(ctx, column);
        }
        Margins::new(self.0).tables(ctx);
        self.draws(ctx)?;
        self.masks(ctx);
        self.by_set(ctx);
        Ok(())
    }
}

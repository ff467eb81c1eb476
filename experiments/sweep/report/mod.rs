//! The report of a sweep: tables for reading and for a paper, and figures.

mod compare;
mod figures;
mod publish;

pub use compare::{ArmResult, Comparison, Question, compare};
pub use publish::publish;

use std::path::Path;

use super::collect::records;
use super::journal::Keep;
use super::plan::Plan;
use super::record::Record;
use super::study::Study;
use edifice_base::{Error, Result, csv, file};
use edifice_report::{Align, Figure, Page, Section, Table, index, write_figure};

/// Folder of the report in a sweep's folder.
pub const REPORT: &str = "report";

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
enum ReportError {
    #[error(
        "{missing} of {tasks} tasks have no result ({worst}); run `edifice sweep run` or `edifice sweep retry`, or say --allow-missing to compare on what all arms have"
    )]
    Missing {
        missing: usize,
        tasks: usize,
        worst: String,
    },
    #[error("no instance has a result of every arm")]
    Nothing,
}

/// Writes the report of a sweep: `report.md`, `.csv`, `.tex`, `.html` and figures. Returns the text of the report.
///
/// # Errors
/// [`Error::Content`] when tasks have no result and `allow_missing` is not said; [`Error::Io`].
pub fn report(plan: &Plan, out: &Path, study: &Study, allow_missing: bool) -> Result<String> {
    let records = records(plan, out, Keep::All)?;
    check(plan, out, &records, allow_missing)?;
    let comparison = compare(plan, study, &records);
    if comparison.common.is_empty() {
        return Err(Error::content(out, ReportError::Nothing));
    }
    let folder = out.join(REPORT);
    std::fs::create_dir_all(&folder).map_err(|e| Error::io(&folder, "create", e))?;
    let table = table(plan, &comparison);
    let figures = [
        ("ranks", figures::ranking(plan, &comparison)),
        ("profiles", figures::profiles(plan, &comparison)),
        (
            "targets",
            figures::targets(plan, study, &comparison, &records),
        ),
        (
            "anytime",
            figures::anytime(plan, study, &comparison, &records),
        ),
    ];
    let seconds: f64 = records.iter().map(|record| record.seconds).sum();
    let mut text = format!(
        "# {}\n\n{}\n\n{}\n",
        study.name,
        summary(plan, &comparison),
        table.markdown()
    );
    for (name, figure) in &figures {
        if let Some(figure) = figure {
            write_figure(&folder, name, figure)?;
            text += &format!("\n![{}]({name}.png)\n", Figure::caption(figure));
        }
    }
    let write = |name: &str, text: &str| file::write_atomic(&folder.join(name), text.as_bytes());
    write("report.md", &text)?;
    write("report.tex", &table.latex())?;
    write("report.csv", &csv(plan, &comparison))?;
    let page = Page {
        slug: ".".into(),
        paper: study.name.to_owned(),
        sections: vec![Section {
            name: "report".into(),
            heading: study.about.to_owned(),
            markdown: text.clone(),
            files: Vec::new(),
            made: format!("version {}", plan.head.program),
            ..Section::default()
        }],
    };
    write("report.html", &index(&[page]))?;
    publish::provenance(plan, study, seconds, &folder)?;
    Ok(text)
}

fn check(plan: &Plan, out: &Path, records: &[Record], allow_missing: bool) -> Result<()> {
    let missing = records
        .iter()
        .filter(|record| record.outcome.is_none())
        .count();
    if missing == 0 || allow_missing {
        return Ok(());
    }
    let mut by_arm = vec![0usize; plan.head.arms.len()];
    for record in records.iter().filter(|record| record.outcome.is_none()) {
        by_arm[record.arm] += 1;
    }
    let worst = by_arm.iter().enumerate().max_by_key(|(_, count)| **count);
    let worst = worst.map_or_else(String::new, |(arm, count)| {
        format!("{count} of arm `{}`", plan.head.arms[arm].name)
    });
    Err(Error::content(
        out,
        ReportError::Missing {
            missing,
            tasks: records.len(),
            worst,
        },
    ))
}

/// The comparison, in a sentence.
fn summary(plan: &Plan, comparison: &Comparison) -> String {
    let head = &plan.head;
    let seeds = plan.tasks.len() / (head.arms.len() * head.instances.len()).max(1);
    let reference = &head.arms[comparison.question.reference].name;
    let mut text = format!(
        "{} arms, {} instances, {seeds} seeds; compared by `{}` on the {} {} that all arms have. Means with 95 % bootstrap \
         intervals over instances and seeds; differences to `{reference}` are paired, p by Wilcoxon's signed-rank test with Holm's correction, effect \
         the matched-pairs rank biserial correlation (positive: larger values than the reference).",
        head.arms.len(),
        head.instances.len(),
        comparison.question.metric,
        comparison.common.len(),
        comparison.unit
    );
    if comparison.unit == "seeds" {
        text += " There is one instance: what is tested over its seeds says nothing of others.";
    }
    if let Some(ranks) = &comparison.ranks {
        text += &format!(" Friedman p {}.", probability(ranks.p));
    }
    text
}

fn table(plan: &Plan, comparison: &Comparison) -> Table {
    let mut table = Table::new(format!("{} by arm", comparison.question.metric))
        .column("arm", Align::Left)
        .numbers([
            "mean",
            "95 % interval",
            "difference",
            "95 % interval",
            "better/equal/worse",
            "p",
            "p (Holm)",
            "effect",
        ]);
    let bounded = comparison.lines.iter().any(|line| line.gap.is_some());
    if bounded {
        table = table.numbers(["gap to bound"]);
    }
    table = table.numbers(["failed"]);
    let open = lacks_tasks(comparison);
    if open {
        table = table.numbers(["missing"]);
    }
    for (arm, line) in plan.head.arms.iter().zip(&comparison.lines) {
        let range = |low: f64, high: f64| format!("{} to {}", short(low), short(high));
        let mut cells = vec![arm.name.clone()];
        cells.push(line.interval.map_or_else(String::new, |i| short(i.mean)));
        cells.push(
            line.interval
                .map_or_else(String::new, |i| range(i.low, i.high)),
        );
        cells.push(line.difference.map_or_else(String::new, |i| short(i.mean)));
        cells.push(
            line.difference
                .map_or_else(String::new, |i| range(i.low, i.high)),
        );
        cells.push(match line.difference {
            Some(_) => format!("{}/{}/{}", line.counts.0, line.counts.1, line.counts.2),
            None => "reference".into(),
        });
        cells.push(
            line.test
                .map_or_else(String::new, |test| probability(test.p)),
        );
        cells.push(line.adjusted.map_or_else(String::new, probability));
        cells.push(
            line.test
                .map_or_else(String::new, |test| format!("{:.2}", test.effect)),
        );
        if bounded {
            cells.push(
                line.gap
                    .map_or_else(String::new, |gap| format!("{:.2} %", 100.0 * gap)),
            );
        }
        cells.push(line.failed.to_string());
        if open {
            cells.push(line.missing.to_string());
        }
        table.row(cells);
    }
    table
}

/// True if tasks have not run: then how many is said.
fn lacks_tasks(comparison: &Comparison) -> bool {
    comparison.lines.iter().any(|line| line.missing > 0)
}

fn csv(plan: &Plan, comparison: &Comparison) -> String {
    let mut text = String::from(
        "arm,mean,low,high,difference,difference_low,difference_high,better,equal,worse,p,p_holm,effect,gap,failed",
    );
    let open = lacks_tasks(comparison);
    text += if open { ",missing\n" } else { "\n" };
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    for (arm, line) in plan.head.arms.iter().zip(&comparison.lines) {
        let mut cells = vec![
            csv::quoted(&arm.name),
            number(line.interval.map(|i| i.mean)),
            number(line.interval.map(|i| i.low)),
            number(line.interval.map(|i| i.high)),
            number(line.difference.map(|i| i.mean)),
            number(line.difference.map(|i| i.low)),
            number(line.difference.map(|i| i.high)),
            line.counts.0.to_string(),
            line.counts.1.to_string(),
            line.counts.2.to_string(),
            number(line.test.map(|test| test.p)),
            number(line.adjusted),
            number(line.test.map(|test| test.effect)),
            number(line.gap),
            line.failed.to_string(),
        ];
        if open {
            cells.push(line.missing.to_string());
        }
        text += &(cells.join(",") + "\n");
    }
    text
}

/// Four significant digits.
fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let digits = (3 - value.abs().log10().floor() as i32).clamp(0, 12) as usize;
    format!("{value:.digits$}")
}

fn probability(p: f64) -> String {
    match p < 0.001 {
        true => "<0.001".into(),
        false => format!("{p:.3}"),
    }
}

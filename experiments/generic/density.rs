//! Density estimation as question, candidate and judge.
//!
//! The question is a table to learn from and a table of rows to give log densities of; the answer is a CSV file with a column `log_density`, one number a
//! row. Log densities alone do not say whether a density integrates to 1, and a constant added to all of them would win any comparison. So
//! the rows that are asked about are mixed with *probes*, drawn from a known density `q` (a kernel estimate of the rows that are learnt
//! from), and the judge checks what holds for every density `p`: the mean of `min(p/q, M)` over the probes has an expectation of
//! at most 1. By Hoeffding's inequality a true density exceeds `1 + t` with probability at most `exp(-2 n t^2 / M^2)`, which is 1e-6 here. A density
//! that is honest at probes alone passes: the check is necessary, not sufficient.
//!
//! # Deviations and readings
//! - Probes are rounded to the decimals that a column of the table has, since they would be known by their digits otherwise, and `q` is evaluated
//!   where they then are. That is done where the step is at most a sixteenth of the kernel's width: `q` hardly changes within one, and a density
//!   that peaks at one of them is not refused for it. In a column of coarser steps (whole numbers of a few, say) probes keep all digits, and
//!   a candidate can tell them.

use std::path::Path;

use rand::seq::SliceRandom;
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use edifice_base::rng::stream;
use edifice_base::{Error, Result};

/// Probes among the rows that are asked about.
const PROBES: usize = 4096;
/// `M`: where the ratio of densities is cut off.
const CUT: f64 = 16.0;
/// Probability with which a true density is refused.
const FALSE_ALARM: f64 = 1e-6;
/// Most kernels of `q`.
const KERNELS: usize = 500;
/// Least width of a kernel, in steps of the last decimal, where probes are rounded to it.
const STEPS: f64 = 16.0;

/// Why log densities are no answer, or rows no table.
#[derive(Debug, thiserror::Error)]
pub(crate) enum DensityError {
    /// A cell is no finite number.
    #[error("`{0}` is no finite number")]
    NotANumber(String),
    /// The column is missing.
    #[error("there is no column `log_density`")]
    NoColumn,
    /// The number of rows differs.
    #[error("{found} log densities, expected one for each of {asked} rows")]
    Count {
        /// Rows of the answer.
        found: usize,
        /// Rows of the question.
        asked: usize,
    },
    /// The log densities are of no density.
    #[error(
        "these are no log densities of a density: the mean ratio to a known density over {PROBES} rows drawn from it is {found:.3} (cut off at {CUT}), and \
         at most {most:.3} for any density that integrates to 1"
    )]
    NotNormalized {
        /// The mean found.
        found: f64,
        /// The largest that a density has.
        most: f64,
    },
}

/// The question to a candidate: all that it sees.
pub(crate) struct Question {
    /// Names of the columns.
    pub header: Vec<String>,
    /// Rows to learn from.
    pub train: Vec<Vec<f64>>,
    /// Rows whose log densities are asked for.
    pub asked: Vec<Vec<f64>>,
}

/// The truth about a question: only the judge sees it.
pub(crate) struct Truth {
    /// Rows of the question that are unseen ones of the table, in the order of the split.
    unseen: Vec<usize>,
    /// The other rows, and the log density that they were drawn from.
    probes: Vec<(usize, f64)>,
}

/// Mixes unseen rows with probes.
pub(crate) fn question(
    header: Vec<String>,
    train: Vec<Vec<f64>>,
    unseen: &[Vec<f64>],
    seed: u64,
) -> (Question, Truth) {
    let rng = &mut stream(seed, "density probes", 0);
    let kernels = Kernels::new(&train, rng);
    let decimals: Vec<Option<usize>> = (0..header.len())
        .map(|column| {
            let cells = train.iter().chain(unseen).map(|row| row[column]);
            let most = cells.map(decimals).max().unwrap_or(0);
            let step = 10_f64.powi(-(most as i32));
            (kernels.widths[column] >= STEPS * step).then_some(most)
        })
        .collect();
    let mut rows: Vec<(Option<usize>, Vec<f64>)> = unseen
        .iter()
        .enumerate()
        .map(|(index, row)| (Some(index), row.clone()))
        .collect();
    rows.extend((0..PROBES).map(|_| {
        let row = kernels.draw(rng).into_iter().zip(&decimals);
        (None, row.map(|(x, places)| rounded(x, *places)).collect())
    }));
    rows.shuffle(rng);
    let mut truth = Truth {
        unseen: vec![0; unseen.len()],
        probes: Vec::new(),
    };
    for (place, (origin, row)) in rows.iter().enumerate() {
        match origin {
            Some(index) => truth.unseen[*index] = place,
            None => truth.probes.push((place, kernels.log_density(row))),
        }
    }
    let asked = rows.into_iter().map(|(_, row)| row).collect();
    let question = Question {
        header,
        train,
        asked,
    };
    (question, truth)
}

/// Decimals of a number as it is written.
fn decimals(x: f64) -> usize {
    let text = x.to_string();
    text.split_once('.').map_or(0, |(_, places)| places.len())
}

/// A number with so many decimals; as it is without.
fn rounded(x: f64, places: Option<usize>) -> f64 {
    // A text of decimals is a number: it reads back. A zero has no sign.
    let read = |places: usize| format!("{x:.places$}").parse().unwrap_or(x) + 0.0;
    places.map_or(x, read)
}

/// Mean negative log density of the unseen rows, nats.
///
/// # Errors
/// [`DensityError`] when the log densities cannot be those of a density.
pub(crate) fn judge(truth: &Truth, logs: &[f64]) -> std::result::Result<f64, DensityError> {
    let ratios = (truth.probes.iter()).map(|&(place, own)| (logs[place] - own).exp().min(CUT));
    let found = ratios.sum::<f64>() / truth.probes.len() as f64;
    let most = 1.0 + CUT * ((1.0 / FALSE_ALARM).ln() / (2.0 * PROBES as f64)).sqrt();
    if found > most {
        return Err(DensityError::NotNormalized { found, most });
    }
    let sum: f64 = truth.unseen.iter().map(|&place| logs[place]).sum();
    Ok(-sum / truth.unseen.len() as f64)
}

/// A Gaussian kernel estimate with one width a column.
struct Kernels {
    centres: Vec<Vec<f64>>,
    widths: Vec<f64>,
}

impl Kernels {
    fn new<R: Rng>(rows: &[Vec<f64>], rng: &mut R) -> Self {
        let d = rows.first().map_or(0, Vec::len);
        let n = rows.len() as f64;
        let width = |column: usize| {
            let mean = rows.iter().map(|row| row[column]).sum::<f64>() / n;
            let variance = rows.iter().map(|r| (r[column] - mean).powi(2)).sum::<f64>() / n;
            // Scott's rule, made wider: a ratio to a narrow density would say little elsewhere.
            let width = 1.5 * variance.sqrt() * n.powf(-1.0 / (d as f64 + 4.0));
            if width > 0.0 { width } else { 1.0 }
        };
        let widths = (0..d).map(width).collect();
        let mut centres = rows.to_vec();
        centres.shuffle(rng);
        centres.truncate(KERNELS);
        Self { centres, widths }
    }

    fn draw<R: Rng>(&self, rng: &mut R) -> Vec<f64> {
        let centre = &self.centres[rng.random_range(0..self.centres.len())];
        let cells = centre.iter().zip(&self.widths);
        cells
            .map(|(at, width)| at + width * rng.sample::<f64, _>(StandardNormal))
            .collect()
    }

    fn log_density(&self, row: &[f64]) -> f64 {
        let scale: f64 = (self.widths.iter())
            .map(|width| width.ln() + 0.5 * std::f64::consts::TAU.ln())
            .sum();
        let logs: Vec<f64> = (self.centres.iter())
            .map(|centre| {
                let cells = row.iter().zip(centre).zip(&self.widths);
                -0.5 * cells.map(|((x, c), w)| ((x - c) / w).powi(2)).sum::<f64>()
            })
            .collect();
        let top = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = logs.iter().map(|log| (log - top).exp()).sum();
        top + sum.ln() - (self.centres.len() as f64).ln() - scale
    }
}

/// The header and the rows of a CSV file of finite numbers.
///
/// # Errors
/// [`Error::Input`] with the row and the cell that is none.
pub(crate) fn read(path: &Path) -> Result<(Vec<String>, Vec<Vec<f64>>)> {
    let table = edifice_io::building_csv::read(path)?;
    let number = |(row, cell): (usize, &String)| {
        let value = cell.trim().parse::<f64>().ok();
        value.filter(|value| value.is_finite()).ok_or_else(|| {
            let place = format!("row {}", row + 1);
            Error::input(path, place, DensityError::NotANumber(cell.clone()))
        })
    };
    let rows = table.rows.iter().enumerate();
    let rows: Result<Vec<Vec<f64>>> = rows
        .map(|(i, row)| row.iter().map(|cell| number((i, cell))).collect())
        .collect();
    Ok((table.header, rows?))
}

/// Writes a table of numbers, each so that it reads back to the same bits.
///
/// # Errors
/// [`Error::Io`].
pub(crate) fn write<'a>(
    header: &[String],
    rows: impl Iterator<Item = &'a [f64]>,
    path: &Path,
) -> Result<()> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header).map_err(Error::method)?;
    for row in rows {
        let cells = row.iter().map(f64::to_string);
        writer.write_record(cells).map_err(Error::method)?;
    }
    let bytes = writer
        .into_inner()
        .map_err(|e| Error::method(e.to_string()))?;
    edifice_io::write_atomic(path, &bytes)
}

/// The log densities of an answer, one for each row that was asked about.
///
/// # Errors
/// Names the row of what is none.
pub(crate) fn read_answer(path: &Path, asked: usize) -> Result<Vec<f64>> {
    let (header, rows) = read(path)?;
    let column = header.iter().position(|name| name == "log_density");
    let column = column.ok_or_else(|| Error::content(path, DensityError::NoColumn))?;
    let found = rows.len();
    if found != asked {
        return Err(Error::content(path, DensityError::Count { found, asked }));
    }
    Ok(rows.iter().map(|row| row[column]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(count: usize, seed: u64) -> Vec<Vec<f64>> {
        let rng = &mut stream(seed, "density test", 0);
        let mut row = || (0..3).map(|_| rng.sample(StandardNormal)).collect();
        (0..count).map(|_| row()).collect()
    }

    fn normal(row: &[f64]) -> f64 {
        let square: f64 = row.iter().map(|x| x * x).sum();
        -0.5 * square - 1.5 * std::f64::consts::TAU.ln()
    }

    #[test]
    fn a_density_passes_and_one_that_adds_a_constant_does_not() {
        for seed in 0..50 {
            let unseen = rows(100, 2);
            let header = vec!["a".into(), "b".into(), "c".into()];
            let (question, truth) = question(header, rows(400, 1), &unseen, seed);
            let honest: Vec<f64> = question.asked.iter().map(|row| normal(row)).collect();
            let nll = judge(&truth, &honest).unwrap();
            let expected = -unseen.iter().map(|row| normal(row)).sum::<f64>() / 100.0;
            assert!((nll - expected).abs() < 1e-12);
            let boosted: Vec<f64> = honest.iter().map(|log| log + 1.0).collect();
            let refused = judge(&truth, &boosted);
            assert!(matches!(refused, Err(DensityError::NotNormalized { .. })));
        }
    }

    #[test]
    fn probes_have_the_digits_of_the_table() {
        // Three decimals, two, and whole numbers of a few.
        let table = |count, seed| -> Vec<Vec<f64>> {
            let scaled = rows(count, seed).into_iter().map(|row| {
                let [a, b, c] = [0, 1, 2].map(|at| row[at]);
                vec![
                    rounded(a, Some(3)),
                    rounded(300.0 * b, Some(2)),
                    rounded(c, Some(0)),
                ]
            });
            scaled.collect()
        };
        let header = vec!["a".into(), "b".into(), "c".into()];
        let unseen = table(100, 2);
        let (question, truth) = question(header, table(400, 1), &unseen, 1);
        for (column, most) in [(0, 3), (1, 2)] {
            let told = |row: &Vec<f64>| decimals(row[column]) > most;
            assert!(!question.asked.iter().any(told));
            // Neither have all of them fewer.
            let most = |row: &&Vec<f64>| decimals(row[column]) == most;
            let probes = truth
                .probes
                .iter()
                .map(|(place, _)| &question.asked[*place]);
            assert!(probes.filter(most).count() > 3 * PROBES / 4);
        }
        let probe = &question.asked[truth.probes[0].0];
        assert!(decimals(probe[2]) > 3);
        // A density still passes, and one that adds a constant does not.
        let density = |row: &Vec<f64>| normal(&[row[0], row[1] / 300.0, row[2]]) - 300_f64.ln();
        let honest: Vec<f64> = question.asked.iter().map(density).collect();
        assert!(judge(&truth, &honest).is_ok());
        let boosted: Vec<f64> = honest.iter().map(|log| log + 1.0).collect();
        assert!(judge(&truth, &boosted).is_err());
    }
}

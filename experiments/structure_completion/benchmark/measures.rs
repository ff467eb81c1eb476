//! The values of one completion, computed without knowledge of the method.

use serde::{Deserialize, Serialize};

use super::super::plausibility::statistics;
use edifice_base::rng::Stream;
use edifice_shape::{Axis, Rect};
use edifice_structure_completion::best::modes;
use edifice_structure_completion::completion::Completion;
use edifice_structure_completion::layout::lines::lines;
use edifice_structure_completion::layout::{Class, Element, Layout};
use edifice_structure_completion::measure::{agreement, off_lines, overlaps};
use edifice_structure_completion::method::{self, Method};
use edifice_structure_completion::model::Model;
use edifice_structure_completion::partial::{PartialLayout, hidden_in};

/// Answers that are asked for.
const ANSWERS: usize = 5;

/// The values of one facade, one part hidden and one method or model.
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Measured {
    /// Set, name of the facade, part hidden.
    pub case: [String; 3],
    /// Method or model.
    pub column: String,
    /// Measure, value.
    pub values: Vec<(String, f64)>,
    /// Mass of each answer, and whether the facade has its numbers of columns and rows.
    pub masses: Vec<(f64, bool)>,
    /// Statistics of the true layout and of a draw, both on shared lines.
    pub pair: Option<(Vec<f64>, Vec<f64>)>,
}

impl Measured {
    /// The value of a measure.
    pub(crate) fn value(&self, measure: &str) -> Option<f64> {
        let found = self.values.iter().find(|v| v.0 == measure);
        found.map(|v| v.1)
    }
}

/// The elements that a completion adds.
pub(crate) fn added(completion: Option<&Completion>) -> Vec<Element> {
    let all = completion.into_iter().flat_map(|c| &c.added);
    all.map(|a| a.element).collect()
}

/// Numbers of columns and rows of windows.
fn lattice<'a>(elements: impl Iterator<Item = &'a Element>) -> [usize; 2] {
    let windows: Vec<Rect> = elements
        .filter(|e| e.class == Class::Window)
        .map(|e| e.rect)
        .collect();
    Axis::BOTH.map(|axis| lines(&windows, axis).0.len())
}

fn share(part: usize, of: usize) -> f64 {
    part as f64 / of.max(1) as f64
}

/// Completes a partial layout by a method and measures it against what is hidden. `untold` are the regions that hide it where
/// the partial layout has no mask that tells them.
pub(crate) fn measured(
    case: [String; 3],
    (column, method, model): (&str, Method, &Model),
    layout: &Layout,
    (partial, hidden): (&PartialLayout, &[Element]),
    untold: Option<&[Rect]>,
    rng: &mut Stream,
) -> Measured {
    let (answers, windows, drawn) = match method {
        Method::Best => {
            let answer = modes::complete(partial, model, ANSWERS, rng);
            (answer.completions, answer.windows, Some(answer.drawn))
        }
        method => (
            method::complete(method, partial, model, 1, rng),
            Vec::new(),
            None,
        ),
    };
    let first = added(answers.first());
    let mut values: Vec<(String, f64)> = Vec::new();
    let mut put = |measure: &str, value: f64| values.push((measure.to_owned(), value));
    let at = |least: f64| agreement(&first, hidden, least).f1;
    put("f1_50", at(0.5));
    put("f1_75", at(0.75));
    let steps = (0..10).map(|k| at(0.5 + 0.05 * f64::from(k)));
    put("f1_50_95", steps.sum::<f64>() / 10.0);
    if let Some(regions) = untold {
        let (within, beyond): (Vec<Element>, Vec<Element>) =
            first.iter().partition(|e| hidden_in(regions, &e.rect));
        put("f1_50_within", agreement(&within, hidden, 0.5).f1);
        put("beyond", beyond.len() as f64);
    }
    put(
        "overlaps",
        f64::from(u8::from(overlaps(&partial.observed, &first) > 0)),
    );
    let is_new = |e: &&Element| e.class == Class::Window;
    put("new_windows", first.iter().filter(is_new).count() as f64);
    put("off_lines", off_lines(&partial.observed, &first) as f64);
    let truth = lattice(layout.elements.iter());
    let numbers = |added: &[Element]| lattice(partial.observed.iter().chain(added));
    let found = numbers(&first);
    for (k, name) in ["columns_right", "rows_right"].into_iter().enumerate() {
        put(name, f64::from(u8::from(found[k].abs_diff(truth[k]) <= 1)));
    }
    let doors = |all: &[Element]| -> Vec<Element> {
        let own = all.iter().filter(|e| e.class == Class::Door);
        own.copied().collect()
    };
    let (own, real) = (doors(&first), doors(hidden));
    let met = agreement(&own, &real, 0.5).matched;
    put("doors_hidden", real.len() as f64);
    put("doors_found", met as f64);
    put("doors_false", (own.len() - met) as f64);
    if let Some(counts) = Counts::new(&windows) {
        let truth = hidden.iter().filter(|e| e.class == Class::Window).count();
        put("count_crps", counts.crps(truth));
        put("count_covered", f64::from(u8::from(counts.covers(truth))));
        put("count_width", counts.width());
    }
    let masses = match method {
        Method::Best => answers
            .iter()
            .map(|a| (a.mass, numbers(&added(Some(a))) == truth))
            .collect(),
        _ => Vec::new(),
    };
    let pair = drawn.map(|drawn| {
        let whole = |added: Vec<Element>| {
            let all: Vec<Element> = partial.observed.iter().copied().chain(added).collect();
            statistics(layout.width, layout.height, &all)
        };
        (whole(modes::on_lines(partial, model, hidden)), whole(drawn))
    });
    Measured {
        case,
        column: column.to_owned(),
        values,
        masses,
        pair,
    }
}

/// A distribution of the number of hidden windows, by rising number.
struct Counts(Vec<(usize, f64)>);

impl Counts {
    /// Shares of the pool, made to sum to 1; `None` of an empty pool.
    fn new(windows: &[(usize, f64)]) -> Option<Self> {
        let total: f64 = windows.iter().map(|w| w.1).sum();
        let mut all: Vec<(usize, f64)> = windows.iter().map(|w| (w.0, w.1 / total)).collect();
        all.sort_by_key(|w| w.0);
        (total > 0.0).then_some(Self(all))
    }

    /// Continuous ranked probability score: the integral of the squared difference of the two distribution functions,
    /// in windows; lower is better.
    fn crps(&self, truth: usize) -> f64 {
        let most = self.0.last().map_or(0, |w| w.0).max(truth);
        let below = |n: usize| self.0.iter().filter(|w| w.0 <= n).map(|w| w.1).sum::<f64>();
        let step = |n: usize| f64::from(u8::from(n >= truth));
        (0..most).map(|n| (below(n) - step(n)).powi(2)).sum()
    }

    /// The least number up to which at least this share lies.
    fn quantile(&self, share: f64) -> usize {
        let mut sum = 0.0;
        for &(n, weight) in &self.0 {
            sum += weight;
            if sum >= share - 1e-9 {
                return n;
            }
        }
        self.0.last().map_or(0, |w| w.0)
    }

    /// True if a number lies from the 10 % to the 90 % quantile.
    fn covers(&self, truth: usize) -> bool {
        (self.quantile(0.1)..=self.quantile(0.9)).contains(&truth)
    }

    fn width(&self) -> f64 {
        (self.quantile(0.9) - self.quantile(0.1)) as f64
    }
}

/// Expected calibration error of ten bins of equal width: the mean over all of the distance between the mean mass of a bin and
/// the share of it that is right; and how many there are.
pub(crate) fn calibration_error(masses: &[(f64, bool)]) -> (f64, usize) {
    const BINS: usize = 10;
    let mut bins = [(0.0, 0.0, 0usize); BINS];
    for &(mass, right) in masses {
        let bin = &mut bins[((mass * BINS as f64) as usize).min(BINS - 1)];
        bin.0 += mass;
        bin.1 += f64::from(u8::from(right));
        bin.2 += 1;
    }
    let off: f64 = bins.iter().map(|b| f64::abs(b.0 - b.1)).sum();
    (off / masses.len().max(1) as f64, masses.len())
}

/// The share of the first over the sum of the second, over cases.
pub(crate) fn ratio<'a>(
    cases: impl Iterator<Item = &'a &'a Measured>,
    part: &str,
    of: &str,
) -> f64 {
    let (mut a, mut b) = (0.0, 0.0);
    for case in cases {
        a += case.value(part).unwrap_or(0.0);
        b += case.value(of).unwrap_or(0.0);
    }
    if b > 0.0 { a / b } else { f64::NAN }
}

/// Share of made grids that are completed perfectly, as text.
pub(crate) fn perfect(count: usize, of: usize) -> String {
    format!("{count} of {of} ({:.0} %)", 100.0 * share(count, of))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_by_hand() {
        let counts = Counts::new(&[(4, 1.0), (2, 1.0)]).expect("a distribution");
        // |F - step| is 1/2 at 2 and 3 for a truth of 4.
        assert_eq!(counts.crps(4), 0.5);
        assert_eq!(counts.crps(2), 0.5);
        assert_eq!(counts.crps(6), 0.25 + 0.25 + 1.0 + 1.0);
        assert!(counts.covers(3) && !counts.covers(5));
        assert_eq!(counts.width(), 2.0);
        assert!(Counts::new(&[]).is_none());
    }

    #[test]
    fn calibration_by_hand() {
        let all = [(0.85, true), (0.85, true), (0.25, false), (0.25, true)];
        let (error, count) = calibration_error(&all);
        assert!((error - (0.3 + 0.5) / 4.0).abs() < 1e-12);
        assert_eq!(count, 4);
    }
}

//! Real columns as categories: histograms of shortest description.
//!
//! n values in K bins of widths L_k with h_k values each, cut at K - 1 of E candidate places, are described in
//!
//! ```text
//! - Σ_k h_k log(h_k / (n L_k)) + log R(n, K) + log C(E, K - 1)   nats,
//! ```
//! up to a constant of the precision of the values; R is the sum of the maximum likelihoods of all data (normalised maximum
//! likelihood), `R(n, 1) = 1`, `R(n, 2) = Σ_h C(n, h) (h/n)^h ((n-h)/n)^(n-h)`, `R(n, K+2) = R(n, K+1) + n/K R(n, K)`. The cuts of least
//! length are found by dynamic programming, in `O(K E²)`.
//!
//! # Deviations and readings
//! - Candidates lie midway between neighbouring values, at most 128 of them, at even shares of the values.
//! - At least two bins and at most eight: a column of one category says nothing, one of many takes too many rows to learn from.
//!
//! Source: Kontkanen and Myllymäki 2007, *MDL histogram density estimation*, Eq. 9 to 17.

use statrs::function::factorial::ln_binomial;

use crate::{Cell, ModelError, Table};

/// Most candidate places.
const PLACES: usize = 128;
/// Most bins.
const MOST: usize = 8;

/// A real column as categories.
#[derive(Debug, Clone, PartialEq)]
pub struct Binned {
    /// The column.
    pub column: String,
    /// Its cuts, ascending, in its own unit: a value at a cut is of the upper bin.
    pub cuts: Vec<f64>,
}

impl Binned {
    /// Names of the bins, ascending.
    pub fn names(&self) -> Vec<String> {
        let Some((first, last)) = self.cuts.first().zip(self.cuts.last()) else {
            return vec!["all".to_owned()];
        };
        let between = self.cuts.windows(2);
        let between = between.map(|w| format!("{} .. {}", w[0], w[1]));
        std::iter::once(format!("< {first}"))
            .chain(between)
            .chain([format!(">= {last}")])
            .collect()
    }

    fn bin(&self, value: f64) -> usize {
        self.cuts.partition_point(|cut| *cut <= value)
    }
}

/// The cuts of shortest description of finite values; none where they are all equal.
///
/// # Examples
/// ```
/// use edifice_model::tables::bins::cuts;
/// let values: Vec<f64> = (0..200).map(|i| if i % 2 == 0 { 0.0 } else { 10.0 } + (i % 20) as f64 / 20.0).collect();
/// let found = cuts(&values);
/// // Two dense bins, and between them one of few values: cuts lie midway between values.
/// assert!(found.iter().any(|cut| *cut > 0.8 && *cut < 10.2));
/// assert!(cuts(&[1.0, 1.0]).is_empty());
/// ```
pub fn cuts(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    // Midway between neighbours, and how many values lie below.
    let all: Vec<(f64, usize)> = (1..n)
        .filter(|&i| sorted[i] > sorted[i - 1])
        .map(|i| (0.5 * sorted[i] + 0.5 * sorted[i - 1], i))
        .collect();
    let places = thinned(&all, n);
    let (Some(first), Some(last)) = (places.first(), places.last()) else {
        return Vec::new();
    };
    let mut edges = vec![(2.0 * sorted[0] - first.0, 0)];
    edges.extend(&places);
    edges.push((2.0 * sorted[n - 1] - last.0, n));
    let unit = edges[edges.len() - 1].0 - edges[0].0;
    let cost = |a: usize, b: usize| -> f64 {
        let h = (edges[b].1 - edges[a].1) as f64;
        match h > 0.0 {
            true => -h * (h * unit / (n as f64 * (edges[b].0 - edges[a].0))).ln(),
            false => 0.0,
        }
    };
    let ends = edges.len();
    // Least cost of the values below edge b in the bins so far, and the last cut before.
    let mut least: Vec<f64> = (0..ends).map(|b| cost(0, b)).collect();
    let mut before: Vec<Vec<usize>> = Vec::new();
    let mut best: Option<(f64, usize)> = None;
    let regrets = regrets(n, MOST);
    for bins in 2..=MOST.min(ends - 1) {
        let shortest = |b: usize| {
            let ways = (bins - 1..b).map(|a| (least[a] + cost(a, b), a));
            let best = ways.min_by(|x, y| x.0.total_cmp(&y.0));
            best.unwrap_or((f64::INFINITY, 0))
        };
        let (next, from): (Vec<f64>, Vec<usize>) = (0..ends).map(shortest).unzip();
        least = next;
        before.push(from);
        let length =
            least[ends - 1] + regrets[bins - 1] + ln_binomial(places.len() as u64, bins as u64 - 1);
        if best.is_none_or(|(shortest, _)| length < shortest) {
            best = Some((length, bins));
        }
    }
    let mut found = Vec::new();
    let mut at = ends - 1;
    for from in before[..best.map_or(0, |(_, bins)| bins - 1)].iter().rev() {
        at = from[at];
        found.push(edges[at].0);
    }
    found.reverse();
    found
}

/// At most [`PLACES`] of the places, at even shares of n values.
fn thinned(all: &[(f64, usize)], n: usize) -> Vec<(f64, usize)> {
    if all.len() <= PLACES {
        return all.to_vec();
    }
    let share = |at: &(f64, usize)| at.1 * PLACES / n;
    let mut kept: Vec<(f64, usize)> = Vec::with_capacity(PLACES);
    for at in all {
        if kept.last().is_none_or(|last| share(last) != share(at)) {
            kept.push(*at);
        }
    }
    kept
}

/// `log R(n, K)` for K = 1 to `most`.
fn regrets(n: usize, most: usize) -> Vec<f64> {
    let of = n as f64;
    let terms = (0..=n).map(|h| {
        let (h, rest) = (h as f64, (n - h) as f64);
        let log = |k: f64| if k > 0.0 { k * (k / of).ln() } else { 0.0 };
        (ln_binomial(n as u64, h as u64) + log(h) + log(rest)).exp()
    });
    let mut all = vec![1.0, terms.sum::<f64>()];
    for k in 1..most.max(2) - 1 {
        all.push(all[k] + of / k as f64 * all[k - 1]);
    }
    all.into_iter().map(f64::ln).collect()
}

/// The table with its real columns as categories, and how each was cut. Missing cells stay missing.
///
/// # Errors
/// Those of building a table.
///
/// # Examples
/// ```
/// use edifice_model::{Table, tables::bins::binned};
/// let table = Table::new().real("width", (0..100).map(|i| Some([5.0, 12.0][i % 2] + (i % 10) as f64 * 0.01)))?;
/// let (codes, how) = binned(&table)?;
/// assert_eq!(how[0].column, "width");
/// assert_eq!(codes.column("width")?.categories(), Some(how[0].names().as_slice()));
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn binned(table: &Table) -> Result<(Table, Vec<Binned>), ModelError> {
    let mut out = Table::new();
    let mut how = Vec::new();
    for column in table.columns() {
        let cells = (0..table.rows()).map(|row| column.cell(row));
        if let Some(names) = column.categories() {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let codes = cells.map(|cell| match cell {
                Cell::Code(code) => Some(code),
                _ => None,
            });
            out = out.codes(column.name(), &names, codes)?;
            continue;
        }
        let numbers: Vec<Option<f64>> = cells
            .map(|cell| match cell {
                Cell::Real(value) => Some(value),
                _ => None,
            })
            .collect();
        let known: Vec<f64> = numbers.iter().flatten().copied().collect();
        let own = Binned {
            column: column.name().to_owned(),
            cuts: cuts(&known),
        };
        let names = own.names();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let codes = numbers.iter().map(|cell| cell.map(|value| own.bin(value)));
        out = out.codes(column.name(), &names, codes)?;
        how.push(own);
    }
    Ok((out, how))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuts_move_with_the_values() {
        let values: Vec<f64> = (0..400)
            .map(|i| f64::from(i % 4 / 3) * 10.0 + f64::from(i) / 400.0)
            .collect();
        let found = cuts(&values);
        assert!(!found.is_empty() && found.len() < 20, "{found:?}");
        for shift in [-1000.0, 1000.0] {
            let moved: Vec<f64> = values.iter().map(|v| v + shift).collect();
            let again = cuts(&moved);
            assert_eq!(again.len(), found.len());
            for (a, b) in again.iter().zip(&found) {
                assert!((a - shift - b).abs() < 1e-9, "{a} {b}");
            }
        }
    }
}

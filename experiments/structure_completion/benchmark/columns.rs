//! The columns of the tables, and numbers in their cells.

use edifice_structure_completion::method::Method;

/// The columns of the default method.
pub(crate) const COLUMNS: [&str; 3] = ["default", "other_sets", "same_set"];
/// The methods that it is compared with.
pub(crate) const BASELINES: [Method; 7] = [
    Method::Lattice,
    Method::LatticeOpen,
    Method::Mirror,
    Method::Nearest,
    Method::LowRank,
    Method::Paper,
    Method::Annealing,
];

/// A number with so many decimals; a dash where there is none.
pub(crate) fn text(value: Option<f64>, decimals: usize) -> String {
    number(value.unwrap_or(f64::NAN), decimals)
}

/// The same; a dash for what is no number.
pub(crate) fn number(value: f64, decimals: usize) -> String {
    match value.is_finite() {
        true => format!("{value:.decimals$}"),
        false => "–".into(),
    }
}

//! Lengths as houses have them: whole millimetres.

/// Rounds to millimetres.
pub(super) fn millimetres(metres: f64) -> f64 {
    (metres * 1e3).round() / 1e3
}

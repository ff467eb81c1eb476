//! `--tolerance P%`: label pictures retiled for a short grammar before anything else is done with them.

use std::path::Path;

use edifice_base::{Error, Result, unwatched};
use edifice_facade_grammar::{InferError, Settings, infer};
use edifice_io::Source;
use edifice_layout::retile::{RetileError, retile};
use edifice_shape::Facade;

use crate::print;

/// A share of the area on the command line: per cent, with or without the sign.
pub(crate) fn per_cent(text: &str) -> std::result::Result<f64, String> {
    let number = text.trim().trim_end_matches('%').trim_end();
    match number.parse::<f64>() {
        Ok(value) if (0.0..100.0).contains(&value) => Ok(value / 100.0),
        _ => Err("expected per cent of the area, from 0 to below 100, as 1 or 1%".to_owned()),
    }
}

/// The tiling of shortest grammar whose picture differs from that of the file in at most a share of the area; prices are
/// those of `settings`, and the difference and both prices are told.
pub(crate) fn retiled(
    source: Source,
    path: &Path,
    share: f64,
    settings: &Settings,
) -> Result<Facade> {
    let own = match &source {
        Source::Layout(facade) => {
            facade.check_tiling().map_err(|e| Error::content(path, e))?;
            Some(facade.clone())
        }
        _ => None,
    };
    let grid = source.label_grid(path)?;
    let price = |facade: &Facade| -> std::result::Result<f64, InferError> {
        let found = infer(std::slice::from_ref(facade), settings, &unwatched)?;
        Ok(settings.costs.grammar(&found.grammar))
    };
    let made = retile(&grid, own, share, price).map_err(|error| match error {
        RetileError::Tolerance { .. } => Error::option("--tolerance", error.to_string()),
        other => Error::content(path, other),
    })?;
    print::message(&format!(
        "{}: {:.3} % of the area became wrong, cost {:.1} to {:.1}, {} pictures priced",
        path.display(),
        100.0 * made.wrong,
        made.before,
        made.price,
        made.priced
    ));
    Ok(made.facade)
}

//! Comparison of two layouts as dictionaries.

use edifice_shape::AnnotatedFacade;
use edifice_shape::comparison::{Agreement, THRESHOLDS, compare_layouts};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::errors::failed;
use super::worker::detached;

/// The agreement of all elements, and of each label under `labels`; only elements in the unknown part count, where `found` names one.
///
/// # Errors
/// An `EdificeError` for layouts of different outlines.
pub fn comparison<'py>(
    py: Python<'py>,
    truth: AnnotatedFacade,
    found: AnnotatedFacade,
) -> PyResult<Bound<'py, PyDict>> {
    let result = detached(py, move || compare_layouts(&truth, &found, false))?.map_err(failed)?;
    let about = agreement(py, &result.all)?;
    let labels = PyDict::new(py);
    for (label, own) in &result.labels {
        labels.set_item(label, agreement(py, own)?)?;
    }
    about.set_item("labels", labels)?;
    Ok(about)
}

fn agreement<'py>(py: Python<'py>, own: &Agreement) -> PyResult<Bound<'py, PyDict>> {
    let (about, f1) = (PyDict::new(py), PyDict::new(py));
    for (at, value) in THRESHOLDS.iter().zip(own.f1()) {
        f1.set_item(at, value)?;
    }
    about.set_item("f1", f1)?;
    about.set_item("mean_f1", own.mean_f1())?;
    about.set_item("iou", own.iou)?;
    about.set_item("truth", own.truth)?;
    about.set_item("predicted", own.predicted)?;
    Ok(about)
}

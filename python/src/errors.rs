//! Errors as exceptions.

use pyo3::exceptions::PyValueError;
use pyo3::{PyErr, create_exception};

create_exception!(
    edifice,
    EdificeError,
    PyValueError,
    "What failed and where, in the words of the command line."
);

/// An error of the library as an exception.
pub fn failed(error: impl std::fmt::Display) -> PyErr {
    EdificeError::new_err(error.to_string())
}

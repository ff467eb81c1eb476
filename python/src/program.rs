//! `edifice.program`: probabilistic programs written in Python, run by the engines of `edifice_model::program`.
//!
//! A program is a generator function: it yields [`Effect`]s, and `yield` answers with the value of a choice. So the engine drives the
//! program and not the other way round, and no handler outlives its run.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use edifice_model::program::dist::Dist;
use edifice_model::program::{self, Address, Chains, Handler, Program, ProgramError, Value};
use pyo3::exceptions::{PyStopIteration, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::distribution::{Distribution, Use};
use super::errors::failed;
use super::posterior::Posterior;
use super::worker::{Stop, detached};

/// A wish of a program to its engine, which it yields.
enum Request {
    Sample(Address, Distribution),
    Observe(Distribution, Value),
    Factor(f64),
}

/// A choice, an observation or a factor, to be yielded by a program.
#[pyclass(module = "edifice.program", frozen)]
pub struct Effect(Request);

/// The address that a name, or a tuple of a name and one or two indices, stands for.
pub fn address(at: &Bound<'_, PyAny>) -> PyResult<Address> {
    if let Ok(name) = at.extract::<String>() {
        return Ok(Address::from(name));
    }
    if let Ok((name, i)) = at.extract::<(String, u32)>() {
        return Ok(Address::from((name, i)));
    }
    if let Ok((name, i, j)) = at.extract::<(String, u32, u32)>() {
        return Ok(Address::from((name, i, j)));
    }
    Err(PyTypeError::new_err(format!(
        "{at} is no address: expected a name, (name, index) or (name, index, index)"
    )))
}

/// A choice: `x = yield sample("x", normal(0, 1))`. An address is used once in a run.
#[pyfunction]
pub fn sample(at: &Bound<'_, PyAny>, distribution: Distribution) -> PyResult<Effect> {
    Ok(Effect(Request::Sample(address(at)?, distribution)))
}

/// Data: `yield observe(normal(x, 1), 3.2)` weighs the run by the density of the value.
#[pyfunction]
pub fn observe(distribution: Distribution, value: &Bound<'_, PyAny>) -> PyResult<Effect> {
    let value = distribution.stored(value)?;
    Ok(Effect(Request::Observe(distribution, value)))
}

/// `yield factor(log)` weighs the run by exp(log); minus infinity makes it impossible.
#[pyfunction]
pub fn factor(log: f64) -> Effect {
    Effect(Request::Factor(log))
}

/// The value that a run returned, shared by the draws that kept it.
pub type Returned = Option<Arc<Py<PyAny>>>;

/// A generator function as a program.
pub struct Code {
    function: Py<PyAny>,
    arguments: Py<PyTuple>,
    /// The first exception that a run raised.
    raised: Mutex<Option<PyErr>>,
    stopped: Arc<AtomicBool>,
}

struct Sample<'h, H>(&'h mut H, Address);

impl<H: Handler> Use<H::Real> for Sample<'_, H> {
    type Out = Value;

    fn with<D: Dist<H::Real>>(self, make: impl Fn() -> D) -> Value {
        let x = self.0.sample(self.1, make());
        make().store(&x)
    }
}

struct Observe<'h, 'v, H>(&'h mut H, &'v Value);

impl<H: Handler> Use<H::Real> for Observe<'_, '_, H> {
    type Out = bool;

    fn with<D: Dist<H::Real>>(self, make: impl Fn() -> D) -> bool {
        let loaded = make().load(self.1);
        if let Some(x) = &loaded {
            self.0.observe(make(), x);
        }
        loaded.is_some()
    }
}

impl Code {
    /// Runs the generator to its end and answers what it yields.
    fn drive<H: Handler>(&self, py: Python<'_>, h: &mut H) -> PyResult<Py<PyAny>> {
        let made = self
            .function
            .bind(py)
            .call1(self.arguments.bind(py).clone())?;
        let Ok(send) = made.getattr("send") else {
            return Err(PyTypeError::new_err(
                "a program is a generator function: `x = yield sample(\"x\", normal(0, 1))`",
            ));
        };
        let mut answer = py.None().into_bound(py);
        loop {
            let effect = match send.call1((answer,)) {
                Ok(effect) => effect,
                Err(end) if end.is_instance_of::<PyStopIteration>(py) => {
                    return Ok(end.value(py).getattr("value")?.unbind());
                }
                Err(error) => return Err(error),
            };
            let Ok(effect) = effect.cast::<Effect>() else {
                return Err(PyTypeError::new_err(format!(
                    "the program yielded {effect}, expected sample(...), observe(...) or factor(...)"
                )));
            };
            answer = py.None().into_bound(py);
            let request: &Request = &effect.get().0;
            match request {
                Request::Sample(at, d) => {
                    let value = d.apply(Sample(h, at.clone()));
                    answer = d.given(py, &value)?;
                }
                Request::Observe(d, value) => {
                    if !d.apply(Observe(h, value)) {
                        return Err(failed(format!("{value:?} is no value of {d:?}")));
                    }
                }
                Request::Factor(log) => h.factor(H::Real::from(*log)),
            }
        }
    }
}

impl Program for Code {
    type Out = Returned;

    fn run<H: Handler>(&self, h: &mut H) -> Returned {
        let out = match self.stopped.load(Ordering::Relaxed) {
            true => None,
            false => Python::attach(|py| match self.drive(py, h) {
                Ok(out) => Some(Arc::new(out)),
                Err(error) => {
                    let mut raised = self.raised.lock().unwrap_or_else(|e| e.into_inner());
                    raised.get_or_insert(error);
                    None
                }
            }),
        };
        if out.is_none() {
            // The engine ends at a weight that is not a number.
            h.factor(H::Real::from(f64::NAN));
        }
        out
    }
}

/// Runs an engine on a program in a thread of its own; an exception of the program comes before the engine's error.
fn engine(
    py: Python<'_>,
    function: Py<PyAny>,
    arguments: Py<PyTuple>,
    run: impl FnOnce(&Code) -> Result<program::Posterior<Returned>, ProgramError> + Send + 'static,
) -> PyResult<Posterior> {
    let stop = Stop(Arc::default());
    let code = Code {
        function,
        arguments,
        raised: Mutex::default(),
        stopped: Arc::clone(&stop.0),
    };
    let (found, raised) = detached(py, move || {
        let found = run(&code);
        (
            found,
            code.raised.into_inner().unwrap_or_else(|e| e.into_inner()),
        )
    })?;
    match (raised, found) {
        (Some(error), _) => Err(error),
        (None, Ok(inner)) => Ok(Posterior::of(inner)),
        (None, Err(error)) => Err(failed(error)),
    }
}

/// Runs by the prior, weighted by what the data say of them.
#[pyfunction]
#[pyo3(signature = (program, *arguments, count = 1000, seed = 1))]
pub fn importance(
    py: Python<'_>,
    program: Py<PyAny>,
    arguments: Py<PyTuple>,
    count: usize,
    seed: u64,
) -> PyResult<Posterior> {
    engine(py, program, arguments, move |code| {
        program::importance(code, count, seed)
    })
}

/// Sequential Monte Carlo: runs that are weighed and drawn anew after each observation.
#[pyfunction]
#[pyo3(signature = (program, *arguments, count = 1000, seed = 1))]
pub fn smc(
    py: Python<'_>,
    program: Py<PyAny>,
    arguments: Py<PyTuple>,
    count: usize,
    seed: u64,
) -> PyResult<Posterior> {
    engine(py, program, arguments, move |code| {
        program::smc(code, count, seed)
    })
}

/// Chains of single changes, each begun with a run of the prior.
#[pyfunction]
#[pyo3(signature = (program, *arguments, chains = 4, warmup = 1000, draws = 1000, seed = 1))]
pub fn metropolis(
    py: Python<'_>,
    program: Py<PyAny>,
    arguments: Py<PyTuple>,
    chains: usize,
    warmup: usize,
    draws: usize,
    seed: u64,
) -> PyResult<Posterior> {
    let settings = Chains {
        chains,
        warmup,
        draws,
        seed,
    };
    engine(py, program, arguments, move |code| {
        program::metropolis(code, &settings)
    })
}

/// The posterior by trying every way through a program of finitely many choices.
#[pyfunction]
#[pyo3(signature = (program, *arguments))]
pub fn exact(py: Python<'_>, program: Py<PyAny>, arguments: Py<PyTuple>) -> PyResult<Posterior> {
    engine(py, program, arguments, program::exact)
}

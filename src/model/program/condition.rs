//! Programs made of programs: conditioned on choices by their addresses.

use rustc_hash::FxHashMap;

use super::address::Address;
use super::dist::Dist;
use super::trace::Value;
use super::{Handler, Program};

/// A program some of whose choices are data, from [`given`].
#[derive(Clone, Debug)]
pub struct Given<P> {
    program: P,
    values: FxHashMap<Address, Value>,
}

/// The program with these choices observed: each takes its value, and weighs the run by its density.
///
/// A value of another kind than the choice (a whole number for a real one) makes the run impossible, as a value outside of the
/// support does. An address that a run does not come to has no effect on it.
///
/// # Examples
/// A coin of unknown bias that fell on one side, as data by its address:
/// ```
/// use edifice_model::program::{Address, Handler, Program, Value, dist, given, importance};
/// struct Coin;
/// impl Program for Coin {
///     type Out = ();
///     fn run<H: Handler>(&self, h: &mut H) {
///         let bias = h.sample("bias", dist::beta(1.0, 1.0));
///         h.sample("side", dist::bernoulli(bias));
///     }
/// }
/// let seen = given(Coin, [(Address::from("side"), Value::Whole(1))]);
/// let posterior = importance(&seen, 4000, 1)?;
/// assert!((posterior.mean("bias").unwrap() - 2.0 / 3.0).abs() < 0.02);
/// # Ok::<(), edifice_model::program::ProgramError>(())
/// ```
pub fn given<P: Program>(
    program: P,
    values: impl IntoIterator<Item = (Address, Value)>,
) -> Given<P> {
    Given {
        program,
        values: values.into_iter().collect(),
    }
}

impl<P: Program> Program for Given<P> {
    type Out = P::Out;

    fn run<H: Handler>(&self, h: &mut H) -> P::Out {
        self.program.run(&mut Conditioned {
            inner: h,
            values: &self.values,
        })
    }
}

struct Conditioned<'a, H> {
    inner: &'a mut H,
    values: &'a FxHashMap<Address, Value>,
}

impl<H: Handler> Handler for Conditioned<'_, H> {
    type Real = H::Real;

    fn sample<D: Dist<H::Real>>(&mut self, at: impl Into<Address>, d: D) -> D::Value {
        let at = at.into();
        let Some(value) = self.values.get(&at) else {
            return self.inner.sample(at, d);
        };
        match d.load(value) {
            Some(x) => {
                self.inner.observe(d, &x);
                x
            }
            None => {
                self.inner.factor(H::Real::from(f64::NEG_INFINITY));
                self.inner.sample(at, d)
            }
        }
    }

    fn observe<D: Dist<H::Real>>(&mut self, d: D, x: &D::Value) {
        self.inner.observe(d, x);
    }

    fn factor(&mut self, log: H::Real) {
        self.inner.factor(log);
    }
}

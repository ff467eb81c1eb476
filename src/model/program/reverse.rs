//! Reverse-mode differentiation: every operation writes a node on a tape, and one pass back gives all derivatives.
//!
//! For `y = f(a, b)` the tape holds the places of a and b and the partial derivatives `∂y/∂a`, `∂y/∂b`. From the last node back,
//! the adjoint `ȳ = ∂out/∂y` is passed on as `ā += ȳ ∂y/∂a`. Time and memory are a small multiple of those of the program
//! (Griewank and Walther 2008, Ch. 3).

use std::cell::RefCell;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::real::Real;

/// The record of all operations since the tape was made or cleared.
///
/// # Examples
/// ```
/// use edifice_model::program::{Real, reverse::Tape};
/// let tape = Tape::default();
/// let (x, y) = (tape.variable(2.0), tape.variable(3.0));
/// let out = x * y + x.ln();
/// assert_eq!(out.value(), 6.0 + 2.0_f64.ln());
/// assert_eq!(tape.gradient(out, 2), [3.0 + 0.5, 2.0]);
/// ```
#[derive(Debug, Default)]
pub struct Tape {
    nodes: RefCell<Vec<TapeNode>>,
}

/// Places of the two arguments and the derivatives by them; a place is that of the node itself where there is none.
#[derive(Debug, Clone, Copy)]
struct TapeNode {
    from: [u32; 2],
    slope: [f64; 2],
}

/// A number on a tape, or a constant.
#[derive(Debug, Clone, Copy)]
pub struct Var<'t> {
    tape: Option<&'t Tape>,
    place: u32,
    value: f64,
}

impl Tape {
    /// A variable. The variables come first on a tape: the i-th one made is the i-th entry of [`Tape::gradient`].
    pub fn variable(&self, value: f64) -> Var<'_> {
        self.push(value, [None, None], [0.0; 2])
    }

    /// Forgets everything, keeping the memory. Numbers made before have no meaning afterwards.
    pub fn clear(&mut self) {
        self.nodes.get_mut().clear();
    }

    /// Derivatives of `out` by the first `count` variables. O(nodes of the tape).
    pub fn gradient(&self, out: Var<'_>, count: usize) -> Vec<f64> {
        let nodes = self.nodes.borrow();
        let mut adjoint = vec![0.0; nodes.len().max(count)];
        if out.tape.is_some() {
            adjoint[out.place as usize] = 1.0;
            for place in (0..=out.place as usize).rev() {
                let (node, own) = (nodes[place], adjoint[place]);
                for (from, slope) in node.from.iter().zip(node.slope) {
                    // A zero adjoint carries nothing, even along an infinite slope.
                    if *from as usize != place && own != 0.0 {
                        adjoint[*from as usize] += own * slope;
                    }
                }
            }
        }
        adjoint.truncate(count);
        adjoint
    }

    fn push(&self, value: f64, from: [Option<u32>; 2], slope: [f64; 2]) -> Var<'_> {
        let mut nodes = self.nodes.borrow_mut();
        let place = nodes.len() as u32;
        nodes.push(TapeNode {
            from: from.map(|f| f.unwrap_or(place)),
            slope,
        });
        Var {
            tape: Some(self),
            place,
            value,
        }
    }
}

impl<'t> Var<'t> {
    fn on(self) -> Option<u32> {
        self.tape.map(|_| self.place)
    }

    fn with(self, other: Self, value: f64, slope: [f64; 2]) -> Self {
        match self.tape.or(other.tape) {
            Some(tape) => tape.push(value, [self.on(), other.on()], slope),
            None => Self::from(value),
        }
    }
}

impl From<f64> for Var<'_> {
    fn from(value: f64) -> Self {
        Self {
            tape: None,
            place: 0,
            value,
        }
    }
}

impl Real for Var<'_> {
    fn value(self) -> f64 {
        self.value
    }

    fn through(self, value: f64, derivative: f64) -> Self {
        match self.tape {
            Some(tape) => tape.push(value, [Some(self.place), None], [derivative, 0.0]),
            None => Self::from(value),
        }
    }
}

impl Neg for Var<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.through(-self.value, -1.0)
    }
}

impl Add for Var<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.with(other, self.value + other.value, [1.0, 1.0])
    }
}

impl Sub for Var<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.with(other, self.value - other.value, [1.0, -1.0])
    }
}

impl Mul for Var<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.with(other, self.value * other.value, [other.value, self.value])
    }
}

impl Div for Var<'_> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let y = self.value / other.value;
        self.with(other, y, [1.0 / other.value, -y / other.value])
    }
}

impl Add<f64> for Var<'_> {
    type Output = Self;
    fn add(self, other: f64) -> Self {
        self.through(self.value + other, 1.0)
    }
}

impl Sub<f64> for Var<'_> {
    type Output = Self;
    fn sub(self, other: f64) -> Self {
        self.through(self.value - other, 1.0)
    }
}

impl Mul<f64> for Var<'_> {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        self.through(self.value * other, other)
    }
}

impl Div<f64> for Var<'_> {
    type Output = Self;
    fn div(self, other: f64) -> Self {
        self.through(self.value / other, 1.0 / other)
    }
}

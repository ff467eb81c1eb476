//! The parts of text that makes solids.

use chumsky::span::SimpleSpan;
use rustc_hash::FxHashMap;

/// All statements.
#[derive(Debug, Clone, Default)]
pub(super) struct Program<'a> {
    /// Names with their values, in order; true for those that a start shape may state.
    pub values: Vec<(&'a str, Expression<'a>, bool)>,
    pub functions: FxHashMap<&'a str, Function<'a>>,
    pub rules: FxHashMap<&'a str, Vec<Operation<'a>>>,
}

/// `name(a, b) = ...`
#[derive(Debug, Clone)]
pub(super) struct Function<'a> {
    pub parameters: Vec<&'a str>,
    pub body: Expression<'a>,
}

/// An operation or a symbol of a rule.
#[derive(Debug, Clone)]
pub(super) enum Operation<'a> {
    Translate([Expression<'a>; 3], SimpleSpan),
    Rotate([Expression<'a>; 3], SimpleSpan),
    Size([Expression<'a>; 3], SimpleSpan),
    /// `primitiveCube()` without an asset, `i("...")` with one.
    Insert(Option<&'a str>, SimpleSpan),
    /// `NIL`, and `alignScopeToGeometry(yUp, 0, 0)`, which leaves the scope of a start shape as it is.
    Nothing,
    /// `[ ... ]`
    Aside(Vec<Operation<'a>>),
    Symbol(&'a str, SimpleSpan),
}

/// A number, possibly computed, with its place in the text.
#[derive(Debug, Clone)]
pub(super) struct Expression<'a> {
    pub kind: Kind<'a>,
    pub span: SimpleSpan,
}

/// Kinds of numbers.
#[derive(Debug, Clone)]
pub(super) enum Kind<'a> {
    Number(f64),
    Name(&'a str),
    Call(&'a str, Vec<Expression<'a>>),
    Negative(Box<Expression<'a>>),
    /// A number, and others that are added to it, or multiplied with it, in turn.
    Chain(Box<Expression<'a>>, Vec<(char, Expression<'a>)>),
    /// `case a < b : c else : d`
    Case(Box<[Expression<'a>; 4]>),
}

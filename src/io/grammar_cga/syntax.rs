//! The parts of CGA text, as written.

use chumsky::span::SimpleSpan;

use edifice_shape::Axis;

/// Something with its place in the text.
pub(super) type At<T> = (T, SimpleSpan);

/// A statement at the top of the text.
#[derive(Debug, Clone)]
pub(super) enum Item<'a> {
    /// `version "2019.0"` and annotations such as `@Group("roof")`: nothing depends on them.
    Skipped,
    /// `@StartRule`: the next rule is where derivation starts.
    StartRule,
    /// `attr name = value`, `const name = value`.
    Constant(At<&'a str>, At<Expression<'a>>),
    /// `Name --> ...`.
    Rule(Box<CgaRule<'a>>),
}

/// A rule: one alternative, or several with percentages.
#[derive(Debug, Clone)]
pub(super) struct CgaRule<'a> {
    /// Our comments before the rule.
    pub notes: Vec<At<&'a str>>,
    pub name: At<&'a str>,
    /// Names of the numbers that it takes.
    pub parameters: Vec<&'a str>,
    pub alternatives: Vec<Alternative<'a>>,
}

/// `30% : split(x) { ... }`, `else : ...`, or just an operation.
#[derive(Debug, Clone)]
pub(super) struct Alternative<'a> {
    /// Our comments before the alternative.
    pub notes: Vec<At<&'a str>>,
    pub chance: Chance<'a>,
    pub target: At<Target<'a>>,
}

/// The part of an alternative before its colon.
#[derive(Debug, Clone)]
pub(super) enum Chance<'a> {
    Always,
    Percent(At<Expression<'a>>),
    Else,
}

/// The replacement of a part.
#[derive(Debug, Clone)]
pub(super) enum Target<'a> {
    Symbol(&'a str),
    Split(Axis, Vec<Entry<'a>>),
    /// `color("#ff0000") A`: calls of operations, and what follows them. The last one may be a rule with parameters.
    Calls(Vec<Call<'a>>, Option<Box<Target<'a>>>),
}

/// `Floor(3, 1.2)`: an operation or a rule with what it takes.
#[derive(Debug, Clone)]
pub(super) struct Call<'a> {
    pub name: At<&'a str>,
    /// Numbers; none where something else stands in the parentheses.
    pub numbers: Option<Vec<At<Expression<'a>>>>,
}

/// One entry between the bars of a split.
#[derive(Debug, Clone)]
pub(super) enum Entry<'a> {
    /// `3 : A`
    Part(Part<'a>),
    /// `{ 3 : A | 2 : B }*`, whose parts may be repeats again.
    Repeat(Vec<Entry<'a>>, SimpleSpan),
}

/// The sign before a size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Prefix {
    /// Nothing: exactly this size.
    Absolute,
    /// `~`: a share of what the others leave.
    Floating,
    /// `'`: a fraction of the whole.
    Fraction,
}

/// `3 : A`, `~3 : A` or `'0.3 : A`.
#[derive(Debug, Clone)]
pub(super) struct Part<'a> {
    pub prefix: Prefix,
    pub size: At<Expression<'a>>,
    pub target: At<Target<'a>>,
}

/// A number, possibly computed.
#[derive(Debug, Clone)]
pub(super) enum Expression<'a> {
    Number(&'a str),
    Name(&'a str),
    /// `rand(1, 2)`: any number between two.
    Between(Box<Expression<'a>>, Box<Expression<'a>>),
    Negative(Box<Expression<'a>>),
    Binary(Box<Expression<'a>>, char, Box<Expression<'a>>),
}

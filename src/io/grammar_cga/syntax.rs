//! The parts of CGA text, as written.

use chumsky::span::SimpleSpan;

use crate::shape::Axis;

/// Something with its place in the text.
pub(super) type At<T> = (T, SimpleSpan);

/// A statement at the top of the text.
#[derive(Debug, Clone)]
pub(super) enum Item<'a> {
    /// `version "2019.0"`: nothing depends on it.
    Version,
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

/// What stands before the colon of an alternative.
#[derive(Debug, Clone)]
pub(super) enum Chance<'a> {
    Always,
    Percent(At<Expression<'a>>),
    Else,
}

/// What a part becomes.
#[derive(Debug, Clone)]
pub(super) enum Target<'a> {
    Symbol(&'a str),
    Split(Axis, Vec<Entry<'a>>),
}

/// One entry between the bars of a split.
#[derive(Debug, Clone)]
pub(super) enum Entry<'a> {
    /// `3 : A`
    Part(Part<'a>),
    /// `{ 3 : A | 2 : B }*`
    Repeat(Vec<Part<'a>>, SimpleSpan),
}

/// `3 : A` or `~3 : A`.
#[derive(Debug, Clone)]
pub(super) struct Part<'a> {
    pub relative: bool,
    pub size: At<Expression<'a>>,
    pub target: At<Target<'a>>,
}

/// A number, possibly computed.
#[derive(Debug, Clone)]
pub(super) enum Expression<'a> {
    Number(&'a str),
    Name(&'a str),
    Negative(Box<Expression<'a>>),
    Binary(Box<Expression<'a>>, char, Box<Expression<'a>>),
}

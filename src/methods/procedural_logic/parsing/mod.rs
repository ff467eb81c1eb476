//! From a labelled facade to its parse tree (Sec. 3.3), and that made n-ary (Sec. 4.1.1).

pub(super) mod alphabet;
pub(super) mod canvas;
pub(super) mod lines;
pub(super) mod nary;
pub(super) mod parse;

//! Facades from attributes (Sec. 6.2): windows and doors on the walls of a mass model, so that the measured
//! window-to-wall ratio, symmetry and alignment of each side and the window styles are the wanted ones.
//!
//! **`best`**, the default, treats each side on its own. Its walls are cut into strips at the corners of the outlines;
//! a strip is *free* when some wall piece of it can hold windows off its middle. Then
//!
//! 1. symmetry: the subset of free strips made asymmetric, and the width of at most one further asymmetric strip
//!    cut off a wider one (the cut is a downpipe or corner board), so that `1 - sym` of the area is asymmetric:
//!    all subsets of the ten largest free strips are tried;
//! 2. alignment: the strips whose windows stand above each other, a subset of the strips with several floors that
//!    has the wanted share of pairs;
//! 3. numbers of windows from a list of spacings, sizes `(0.91 s, 1.22 s)` metres within what the wall has free, the
//!    one scale `s` of the side by bisection for the window-to-wall ratio.
//!
//! Layouts for several spacings and orders of subsets are measured with the one code of attributes, and the nearest
//! to the wanted attributes is kept. Styles go to strips so that each wanted one occurs; a door stands in the
//! strip of the front that the front porch covers. Where no strip has a door for a porch, one is hung behind it before a layout is measured,
//! and the windows of that side are made smaller by what it takes.
//!
//! **`paper`** ([`breed()`]): Eq. 4 by a genetic algorithm (100 genomes; a gene is the layout of a wall piece), each layout
//! sized by Eq. 5; elements are sub-styles of the database on the house with the most similar styles ([`elements()`]).
//!
//! # Deviations and readings
//! - `best`: sizes follow one scale for a side, not sub-styles of single elements. `paper`: Eq. 5 couples widths on a piece
//!   only through their sum, so that [`knapsack`] solves it exactly without a solver; heights and sills are the averages
//!   of the sub-style, cut to what the wall has free; a drawn layout has one sub-style or several, in equal parts.
//! - Windows keep clear of corners, of roofs before the wall and of each other, and of garage doors: hard bounds, so
//!   that a ratio out of reach is missed, never forced.
//! - Eq. 4 divides by wanted values that may be zero: distances are in standard deviations of the database here.

mod breed;
mod cut;
mod doors;
mod elements;
mod glaze;
pub mod knapsack;
mod layout;
mod rescale;
mod room;
mod styles;

pub use breed::{breed, energy};
pub use elements::{Elements, SubStyle, elements};
pub use layout::{FacadeTarget, Facades, furnish};
pub use room::FixedPiece;

//! Structure completion (Fan, Musialski, Liu, Wonka 2014, *Structure Completion for Facade Layouts*): from the elements
//! that are seen of a facade to one or several whole layouts.
//!
//! # The problem
//! A facade is a domain `[0, W] x [0, H]` with elements, each a class (window, door, balcony, shop) and a bounding box (Sec. 3.2).
//! A [`partial::PartialLayout`] has three states: observed elements, known wall, and an unknown part. Wanted are the
//! hidden elements, from the observed ones and from a database of whole layouts. A [`completion::Completion`] only adds.
//!
//! # The default method, [`best`]
//! It answers with whole layouts on shared lines. Let `p_i` be the probability that a hidden element matches candidate
//! `i`, half at an intersection over union of 0.5 and half at 0.75. Among coherent layouts the one with the highest expected
//! score `2 sum p_i / (|S| + E[n])` is chosen (`best::judge`). Candidates and `p_i` come from:
//!
//! 1. exact draws of the columns and rows of the lattice, by a chain over (position, previous gap) whose every
//!    factor is normalized over the positions ([`best::chain`]);
//! 2. the same with the observed elements mirrored about sampled axes ([`best::symmetry`]);
//! 3. what lies below a like row of the database, and whole facades of the database warped to the seen lines ([`best::transfer`]);
//! 4. each draw put on shared lines: new lines continue the seen ones by rule, windows take their place and size from
//!    their column and row, balconies from their row; what would overlap is left out;
//! 5. boosted trees over the support by each of these and the place of the candidate, learnt on the database with parts
//!    hidden ([`best::learn`]), and such trees over the places of a door ([`best::doors`]).
//!
//! Several answers are the best layouts of the modes of the draws, told apart by the numbers of columns and rows, each with
//! its share of the probability ([`best::modes`]). Where the seen windows are cells of one exact lattice, that lattice comes
//! first.
//!
//! [`baselines`] are what it is compared with; [`task`] hides parts of whole layouts and [`measure`] compares, independently of
//! any method. [`method`] is the table of all.
//!
//! # Deviations and readings
//! - The paper knows no wall: all that is not observed is unknown. Here the unknown part may be given, and wall that is
//!   known to be empty stays empty.
//! - The paper maximizes its score (Eq. 15) over candidates of a policy. A higher score is not a nearer completion, so
//!   the default method maximizes the expected agreement instead.
//! - Elements are on one line when their centres differ by less than 0.35 of their median extent; the paper does not
//!   say how grids are found.
//! - Balconies wider than 0.4 of the facade, and shops, take no part in the chain; they come from symmetry and the database.
//! - One door is added where none is seen and the best place has a probability above 0.08, though that lowers the
//!   expected score: a facade without a door is not plausible. An exact lattice gets none. Beside a single seen door no other is
//!   added.
//! - Balconies of single windows are decided on row by row ([`best`]): all of a row's windows of one width, none, those of the mirror
//!   image, or those of the columns of another row.
//! - Without a mask, a lattice of which nearly every cell is seen is taken as a region that is seen: that no line is seen beyond it says
//!   nothing. Element probabilities are learnt with and without masks.
//! - New windows that would be alone on a column or on a row are left out.
//! - Facades in scope ([`layout::scope`]): at least 8 windows, half of the cells of their lattice occupied, 70 % of the windows with
//!   another one in their row and column.

pub mod annealing;
pub mod baselines;
pub mod best;
pub mod completion;
pub mod frozen;
pub mod layout;
pub mod made;
pub mod measure;
pub mod method;
pub mod model;
pub mod model_file;
pub mod partial;
pub mod policy;
pub mod score;
pub mod sights;
pub mod task;

/// The version of `rand` whose generators the functions here take.
pub use rand;

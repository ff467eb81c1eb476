//! Structure completion (Fan, Musialski, Liu, Wonka 2014, *Structure Completion for Facade Layouts*): from the elements
//! that are seen of a facade to one or several whole layouts.
//!
//! # The problem
//! A facade is a domain `[0, W] x [0, H]` with elements, each a class (window, door, balcony, shop) and a bounding box (Sec. 3.2).
//! A [`partial::PartialLayout`] has three states: observed elements, known wall, and an unknown part. Wanted are the
//! hidden elements, from the observed ones and from a database of whole layouts. A [`completion::Completion`] only adds.
//!
//! # The default method, [`best`]
//! Let `p_i` be the probability that a hidden element matches candidate `i` with an intersection over union of at least
//! 0.5. The chosen set maximizes the expected score `2 sum p_i / (|S| + E[n])` ([`best::select`]). Candidates and `p_i` come from:
//!
//! 1. exact draws of the columns and rows of the lattice, by a chain over (position, previous gap) whose every
//!    factor is normalized over the positions ([`best::chain`]);
//! 2. the same with the observed elements mirrored about sampled axes ([`best::symmetry`]);
//! 3. what lies below a like row of the database, and whole facades of the database warped to the seen lines ([`best::transfer`]);
//! 4. boosted trees over the support by each of these and the place of the candidate, learnt on the database with parts
//!    hidden ([`best::learn`]).
//!
//! Several answers are the modes of the draws, told apart by the size of the lattice and by symmetry, each with its share of
//! the probability ([`best::modes`]).
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
//! - A door is added where there is none and the best place has a probability above 0.08, though that lowers the
//!   expected score: a facade without a door is not plausible.
//! - Facades in scope ([`layout::scope`]): at least 8 windows, half of the cells of their lattice occupied, 70 % of the windows with
//!   another one in their row and column.

pub mod annealing;
pub mod baselines;
pub mod best;
pub mod completion;
pub mod layout;
pub mod made;
pub mod measure;
pub mod method;
pub mod model;
pub mod model_file;
pub mod partial;
pub mod policy;
pub mod score;
pub mod task;

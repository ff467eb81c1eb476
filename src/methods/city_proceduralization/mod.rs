//! City proceduralization: a city of triangles becomes a grammar of instances (Demir, Aliaga and Benes
//! 2014, "Proceduralization of Buildings at City Scale").
//!
//! 1. **Components** ([`decompose`], Sec. IV.A and B). A building is cut at the heights where the second
//!    difference of its section area A(z) is large; each slab is closed and gets an oriented box.
//! 2. **Types** ([`types`], Sec. IV.C and D). Components with like features are of one type; a type has a
//!    representative, its template, which takes the place of all its members: box to box, by an affine map.
//! 3. **Parse tree** ([`parse_tree`], Sec. V). Types that stand near each other often and at like distances (Eq. 8 to 11)
//!    are joined by communities, level by level, up to one root.
//!    In `best`, [`patterns`]: types of buildings at like relative places.
//! 4. **Grammar** ([`emission`], Eq. 5 to 7). Leaves are terminals, inner nodes non-terminals with a rule and
//!    mean transforms; each instance keeps where its parts really stand.
//! 5. **Districts, blocks and rows** ([`arrangement`]), in `best`: the rules between the axiom and the buildings, which do the placing.
//!
//! # Modes
//! | | `paper` | `best` |
//! | --- | --- | --- |
//! | features | vertex count of the simplified outline, width, height, depth, rotation, standardized and weighted | 16 x 16 height map in the box, turned to a canonical half turn; 12 principal components, weighted by volume |
//! | types | k-means, k halved level by level | Ward's hierarchy, then medoids under the mismatched volume, at a price of derived triangles, which rises where more would be derived than the city has, over the four quarter turns; for few polygons, the price is higher, triangles of templates have one, too, and of twice as many types those of most worth stay |
//! | template | nearest to the mean, or of fewest triangles | medoid, 12 bits, coplanar triangles merged before and after rounding, closed where the component is |
//! | buildings | no types of their own | rules with parameters (`rulebook`): a type's building, put into the width, depth and heights of another |
//! | what stands together | parse tree of types of components, Girvan-Newman | [`building_types`], as many as the buildings ask for; the town plan's tree ([`arrangement`]); beside it, [`patterns`] that repeat |
//!
//! # Deviations and readings
//! - A(z) is computed exactly from the triangles instead of from rendered images, every 0.25 m. Second differences
//!   are taken at 1 m (0.5 m in buildings below 15 m), the threshold is 5 % of the largest area, consecutive
//!   hits are one cut at the largest change (at a horizontal face, if there is one), and no component
//!   is lower than 2 m.
//! - The plan's rotation is a feature in `paper`; `best` keeps it with the instance.
//! - The window features ([`windows`]) are read off the four sides of a component, drawn at 0.1 m (at most 256) pixels: what is
//!   darker than Otsu's threshold is a window; areas are in three clusters, the one of most members is dominant; windows two
//!   standard deviations and a quarter off are outliers; distances below half a window are of windows in one column. Sides of which less
//!   than a quarter is painted are left out; a component without painted sides has the mean features, and in a city without
//!   textures the six features are equal and fall out. A texture's bytes are shared out by the texels that components cover.
//! - A template is drawn with the looks of its representative: orthographic views of the sides and the top of its box, whatever
//!   box it is then put into. In `best` the greys of 4 x 4 cells of each side count beside the height map.
//! - Localization by photographs (Sec. VI) takes facades that are rectified and cut to their edges; their scale is not known, so that
//!   lengths are compared as shares of the facade.
//! - The paper places representatives without saying how their size is treated; here they are scaled to the box of
//!   what they replace.
//! - Slabs are closed at the top, because another roof may stand on them than the one that they were cut from.
//! - D (Eq. 11) is a distance; the graph's edge weight for communities is its inverse.
//! - "Edges for distant node type pairs are omitted": an edge stays when it is among the four of least D of one of its nodes.
//! - Feature 1 is the vertex count of the simplified convex hull of the plan; the paper simplifies the outlines of four side views.
//! - In `paper` an instance keeps where its parts really stand, beside the mean transforms of Eq. 7; without these residuals
//!   (`InstanceGrammar::rules_only`) parts stand where Eq. 7 puts them, as the paper prints.
//! - The paper's tree is of types; in `best` instances are grouped, by the town plan: a type of building has other neighbours at each of its
//!   places, and patterns of whole buildings repeat in few real cities. An edit of a type moves its neighbours in rows.
//! - The mean of Eq. 9 is taken over the pairs of neighbours of the two types.

pub mod arrangement;
pub mod building_types;
mod candidates;
pub mod component;
mod components;
pub mod country;
mod detail;
pub mod emission;
pub mod facades;
mod facility;
pub mod features;
mod gain;
pub mod judge;
pub mod localization;
mod medoids;
pub mod morphology;
mod nearest;
mod order;
mod orientation;
pub mod parse_tree;
pub mod patterns;
mod principal_axes;
pub mod proceduralize;
mod pruning;
mod rulebook;
mod search;
pub mod settings;
mod stacks;
pub mod synthesis;
pub mod type_graph;
pub mod types;
mod uses;
pub mod windows;

pub use component::Component;
pub use components::{Decomposition, decompose};
pub use features::PAPER_FEATURES;
pub use parse_tree::Detection;
pub use proceduralize::{Proceduralized, Structure, from_components, proceduralize};
pub use search::{Verdict, largest, smallest};
pub use settings::{Budget, Mode, Precision, ProceduralizeError, Representative, Settings};

//! Instance grammars: symbols with transforms (Demir et al. 2014, Eq. 5 to 7).
//!
//! A terminal is a template: a mesh in the unit box (x and y from -1/2 to 1/2, z from 0 to 1). A rule
//! `N → ⊕ E_l N_l` puts its successors, each by a transform E_l, into the frame of N. The axiom's
//! derivation is the city.
//!
//! A placed non-terminal may carry `parts`: where each successor of its rule stands in this instance, or
//! that it is absent; a part may be of another template than the rule's. Without them the successors stand where the rule, with its mean transforms, puts
//! them. A rule may have parameters ([`InstanceRule::part`]): an instance gives the numbers, and the parts follow; what the
//! rule does not reach is a residual, again in `parts`, that can be dropped ([`InstanceGrammar::rules_only`]).
//!
//! Buildings may stand in rows, rows in blocks, and blocks in districts ([`Begins`]): in a row each begins where the one before it ends
//! ([`Places`]), so that a type that is made wider pushes its neighbours aside.

mod arranged;
mod check;
mod derive;
mod error;
mod kept;
mod limits;
mod parametric;
mod places;
mod repeated;

pub use arranged::{Begins, Grid};
pub use derive::{InstanceDerivation, TemplateInstance};
pub use error::InstanceGrammarError;
pub use kept::Kept;
pub use limits::INSTANCE_LIMIT;
pub use places::Places;
pub use repeated::{Posed, Repeated, repeated};

use std::sync::Arc;

use edifice_shape::triangles::TriangleMesh;

/// A symbol in its place: scaled, turned about the vertical, shifted.
#[derive(Debug, Clone, PartialEq)]
pub struct Placement {
    /// Template or non-terminal.
    pub symbol: String,
    /// Shift, in metres, in the frame of the rule's symbol.
    pub at: [f64; 3],
    /// Turn about the vertical in degrees, counterclockwise seen from above.
    pub turn: f64,
    /// Of a template: its width, depth and height in metres. Of a non-terminal: one factor, three times.
    pub size: [f64; 3],
    /// Identifier of the building that this is, or is a part of.
    pub id: Option<String>,
    /// Further properties of that building.
    pub attributes: serde_json::Map<String, serde_json::Value>,
    /// The places of this instance's successors, in the order of the rule; `None` is absent. If the list is empty, the
    /// rule's own places hold.
    pub parts: Vec<Option<Placement>>,
    /// Of a non-terminal whose rule has parameters, their values in metres: width, depth and the height of each level.
    pub numbers: Vec<f64>,
}

impl Placement {
    /// A symbol at a place.
    pub fn new(symbol: impl Into<String>, at: [f64; 3], turn: f64, size: [f64; 3]) -> Self {
        Self {
            symbol: symbol.into(),
            at,
            turn,
            size,
            id: None,
            attributes: serde_json::Map::new(),
            parts: Vec::new(),
            numbers: Vec::new(),
        }
    }
}

/// A terminal: a mesh in the unit box.
#[derive(Debug, Clone, PartialEq)]
pub struct Template {
    /// Symbol.
    pub symbol: String,
    /// The mesh.
    pub mesh: TriangleMesh,
    /// The picture file (PNG, JPEG or WebP) of its box mapping ([`edifice_shape::triangles::BoxTexture`]), if it has one.
    pub texture: Option<Arc<[u8]>>,
}

/// One way to replace a non-terminal.
#[derive(Debug, Clone, PartialEq)]
pub struct InstanceRule {
    /// The non-terminal.
    pub symbol: String,
    /// Weight against the other rules of the symbol, above 0.
    pub weight: f64,
    /// Number of levels of a rule with parameters (w, d, h1, ..., hn), whose successors are in shares of them
    /// ([`InstanceRule::part`]); 0 where lengths are metres.
    pub levels: usize,
    /// True if the successors stand in a row along x: the first at its own place, each other one where the one before it ends; its shift along
    /// x is the gap between them ([`Places`]).
    pub row: bool,
    /// Factors of all lengths along the axes of the symbol: what an edit of a type changes, wherever the type stands.
    pub scale: [f64; 3],
    /// The placements that replace it.
    pub successors: Vec<Placement>,
}

/// A city as rules over templates.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct InstanceGrammar {
    /// Name.
    pub name: String,
    /// Coordinate reference system.
    pub reference_system: Option<String>,
    /// The shift from these coordinates to those of the reference system.
    pub origin: [f64; 3],
    /// Start symbol.
    pub axiom: String,
    /// Terminals.
    pub templates: Vec<Template>,
    /// Rules; of several with one symbol, a derivation takes the first, sampling draws by weight.
    pub rules: Vec<InstanceRule>,
}

impl InstanceGrammar {
    /// The rule that a derivation begins with: the axiom's first.
    pub fn top(&self) -> Option<&InstanceRule> {
        self.rules.iter().find(|r| r.symbol == self.axiom)
    }

    /// The same, to be changed.
    pub fn top_mut(&mut self) -> Option<&mut InstanceRule> {
        self.rules.iter_mut().find(|r| r.symbol == self.axiom)
    }
}

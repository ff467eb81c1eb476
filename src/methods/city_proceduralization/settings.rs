//! Settings of the method, and the errors that it may end with.

use super::parse_tree::Detection;
use super::type_graph::DistanceWeights;
use edifice_cluster::WardError;
use edifice_grammar::instance::InstanceGrammarError;

/// The method of finding types.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// As the paper writes.
    Paper,
    /// Geometric features, Ward, medoids.
    Best,
}

/// The number of templates that the grammar may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Budget {
    /// One for each distinct component.
    All,
    /// This number of templates.
    Templates(usize),
    /// The number of components, halved this many times.
    Level(u32),
}

impl Budget {
    /// The number of templates for a number of components.
    pub(super) fn templates(self, components: usize) -> usize {
        match self {
            Budget::All => components,
            Budget::Templates(k) => k.clamp(1, components),
            Budget::Level(level) => components.checked_shr(level).unwrap_or(0).max(1),
        }
    }
}

/// The precision in which a grammar is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// Millimetres, ten-thousandths of degrees, templates on 16 bits.
    Millimetre,
    /// Centimetres, hundredths of degrees, templates on 12 bits.
    Centimetre,
    /// Decimetres, half degrees, templates on 7 bits: for few bytes.
    Decimetre,
}

/// The member that represents a type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Representative {
    /// The member nearest to the mean. In `best` derived triangles have a small price.
    Nearest,
    /// The member of fewest polygons ("-poly"). In `best` triangles have a higher price, those of templates, too: fewer are derived, in
    /// fewer bytes, at a loss of some hundredths of the intersection over union.
    FewestPolygons,
}

/// Settings of the method.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The method of finding types.
    pub mode: Mode,
    /// The number of templates that the grammar may have.
    pub budget: Budget,
    /// Weights W of the eleven features, in `paper`.
    pub weights: [f64; 11],
    /// The member that represents a type.
    pub representative: Representative,
    /// Weights of Eq. 11.
    pub distance: DistanceWeights,
    /// The method of finding communities, in `paper`.
    pub detection: Detection,
    /// Seed of k-means, in `paper`.
    pub seed: u64,
    /// The precision of numbers, in `best`. `None`: millimetres where each component has its own template,
    /// centimetres otherwise.
    pub precision: Option<Precision>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            mode: Mode::Best,
            budget: Budget::Level(4),
            weights: [1.0; 11],
            representative: Representative::Nearest,
            distance: DistanceWeights::default(),
            detection: Detection::GirvanNewman,
            seed: 1,
            precision: None,
        }
    }
}

/// Why a city cannot be proceduralized.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProceduralizeError {
    /// There is nothing to proceduralize.
    #[error("no building has a triangle with an area")]
    Empty,
    /// It was stopped before anything was found.
    #[error("stopped before the first building was cut")]
    Stopped,
    /// Features cannot be clustered.
    #[error("features: {0}")]
    Ward(#[from] WardError),
    /// The grammar made is not sound: an error of this program.
    #[error("the grammar is not sound: {0}")]
    Grammar(#[from] InstanceGrammarError),
}

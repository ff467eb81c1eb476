//! Kinds of references.

/// The way in which a reference splits a facade, and the form of its own layouts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Floors, then tiles.
    FloorsFirst,
    /// Bays, then tiles.
    ColumnsFirst,
    /// Directions alternate: zones, sections, storeys, tiles.
    Interleaved,
    /// Wing, centre, wing; then floors, then tiles.
    Symmetric,
    /// Groups within groups: base, main part and top; storeys; sections; tiles.
    Nested,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Kind; 5] = [
        Kind::FloorsFirst,
        Kind::ColumnsFirst,
        Kind::Interleaved,
        Kind::Symmetric,
        Kind::Nested,
    ];

    /// Its name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Kind::FloorsFirst => "floors_first",
            Kind::ColumnsFirst => "columns_first",
            Kind::Interleaved => "interleaved",
            Kind::Symmetric => "symmetric",
            Kind::Nested => "nested",
        }
    }
}

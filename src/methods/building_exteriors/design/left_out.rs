//! Reasons for which a marked window or door is not on the house.

/// Farthest that a door may begin above the line of its storey (m).
pub(super) const SILL: f64 = 0.6;

/// Why a marked window or door is not on the house.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LeftOut {
    /// The label names neither a window nor a door.
    #[error("{label:?} is neither a window nor a door")]
    NoOpening {
        /// The label.
        label: String,
    },
    /// No wall of the side reaches over it: it stands over a corner of the plan, or beyond its end.
    #[error(
        "no wall reaches from {from:.2} to {to:.2} m along the side: it lies over a corner of the plan"
    )]
    Corner {
        /// Its start along the side, in metres.
        from: f64,
        /// Its end, in metres.
        to: f64,
    },
    /// It is too high for a storey, or reaches over the eaves.
    #[error(
        "it reaches from {from:.2} to {to:.2} m over the ground; storeys are {storey:.2} m high, the eaves {eaves:.2} m"
    )]
    Storey {
        /// Its lower edge over the ground, in metres.
        from: f64,
        /// Its upper edge, in metres.
        to: f64,
        /// Height of a storey, in metres.
        storey: f64,
        /// Height of the eaves, in metres.
        eaves: f64,
    },
    /// It is too small for what it is.
    #[error("{width:.2} m x {height:.2} m is too small for a {what}")]
    Small {
        /// A window or a door.
        what: &'static str,
        /// Its width, in metres.
        width: f64,
        /// Its height, in metres.
        height: f64,
    },
    /// A door begins too far above the line of its storey.
    #[error("the door begins {sill:.2} m above its floor, at most {SILL} m are possible")]
    Sill {
        /// The distance, in metres.
        sill: f64,
    },
    /// It overlaps one that was marked before it.
    #[error("it overlaps regions[{other}]")]
    Overlaps {
        /// Index of the region that it overlaps.
        other: usize,
    },
    /// The surface of the wall has no room for it: it touches a corner, the eaves or another element.
    #[error("the wall has no room for it: it touches a corner, the eaves or another element")]
    NoRoom,
}

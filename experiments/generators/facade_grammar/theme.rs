//! The kinds of buildings, and which are made.

use super::elements::Glazing;

/// The order of the kinds of windows along a floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rhythm {
    /// A A A A.
    Same,
    /// A B A B.
    Alternate,
    /// A B B A: the ends differ from the rest.
    Ends,
    /// B B A B B: the middle differs.
    Middle,
    /// A A B B A A.
    Pairs,
    /// A B C C B A.
    Mirror,
}

impl Rhythm {
    /// The kind that stands at place `i` of `n`, from 0 for A.
    pub(crate) fn kind(self, i: usize, n: usize) -> usize {
        let last = n - 1;
        match self {
            Rhythm::Same => 0,
            Rhythm::Alternate => i % 2,
            Rhythm::Ends => usize::from(i == 0 || i == last),
            Rhythm::Middle => usize::from(2 * i == last || 2 * i == last + 1),
            Rhythm::Pairs => i / 2 % 2,
            Rhythm::Mirror => i.min(last - i) % 3,
        }
    }
}

/// The division of the body before its floors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Body {
    /// One piece.
    Plain,
    /// A middle part whose floors differ, between two wings.
    Projection,
    /// Towers at both ends, with floors of their own.
    Towers,
    /// A stair with windows between the floors, off the middle.
    Stair,
    /// A bay on one side only.
    Side,
}

/// The ground floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ground {
    /// As the floors above, with a door in one column.
    Door,
    /// Shop windows with another rhythm.
    Shops,
    /// Heavy piers between large openings.
    Arcade,
}

/// The part above the cornice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Attic {
    /// Nothing.
    None,
    /// Dormers in a roof, with another spacing than the windows below.
    Dormers,
    /// A low floor of small windows.
    Low,
}

/// A kind of building.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Theme {
    /// Its name, which facades carry.
    pub name: &'static str,
    /// Fewest and most floors, without ground floor and attic.
    pub floors: (u32, u32),
    /// Fewest and most window columns.
    pub columns: (u32, u32),
    /// Kinds of windows, in order of use.
    pub glazing: &'static [Glazing],
    /// Rhythms that floors draw from.
    pub rhythms: &'static [Rhythm],
    /// Division of the body.
    pub body: Body,
    /// Ground floor.
    pub ground: Ground,
    /// The part above the cornice.
    pub attic: Attic,
    /// Share of windows' kinds that carry a balcony: 0 none, 1 every second kind, 2 also one that
    /// runs along a whole floor.
    pub balconies: u32,
    /// True if pilasters stand between columns.
    pub pilasters: bool,
    /// Fewest and most windows that differ from what the rhythm asks for.
    pub breaks: (u32, u32),
}

use Glazing::{Casement, Lattice, Plain, Sash, Shutters, Transom};

const PALACE: Theme = Theme {
    name: "palace",
    floors: (3, 5),
    columns: (9, 15),
    glazing: &[Transom, Casement, Sash],
    rhythms: &[Rhythm::Alternate, Rhythm::Ends, Rhythm::Mirror],
    body: Body::Projection,
    ground: Ground::Arcade,
    attic: Attic::Low,
    balconies: 1,
    pilasters: true,
    breaks: (1, 3),
};
const BOULEVARD: Theme = Theme {
    name: "boulevard",
    floors: (4, 6),
    columns: (5, 9),
    glazing: &[Casement, Transom],
    rhythms: &[Rhythm::Same, Rhythm::Ends, Rhythm::Alternate],
    body: Body::Plain,
    ground: Ground::Shops,
    attic: Attic::Dormers,
    balconies: 2,
    pilasters: false,
    breaks: (1, 4),
};
const TENEMENT: Theme = Theme {
    name: "tenement",
    floors: (3, 5),
    columns: (6, 10),
    glazing: &[Sash, Casement, Shutters],
    rhythms: &[Rhythm::Pairs, Rhythm::Ends, Rhythm::Middle],
    body: Body::Stair,
    ground: Ground::Door,
    attic: Attic::Low,
    balconies: 1,
    pilasters: false,
    breaks: (2, 6),
};
const HOTEL: Theme = Theme {
    name: "hotel",
    floors: (4, 8),
    columns: (8, 14),
    glazing: &[Casement, Sash],
    rhythms: &[Rhythm::Alternate, Rhythm::Pairs, Rhythm::Ends],
    body: Body::Towers,
    ground: Ground::Shops,
    attic: Attic::Dormers,
    balconies: 1,
    pilasters: false,
    breaks: (1, 4),
};
const OFFICE: Theme = Theme {
    name: "office",
    floors: (5, 10),
    columns: (6, 14),
    glazing: &[Lattice, Plain],
    rhythms: &[Rhythm::Same, Rhythm::Alternate, Rhythm::Pairs],
    body: Body::Side,
    ground: Ground::Shops,
    attic: Attic::None,
    balconies: 0,
    pilasters: true,
    breaks: (2, 5),
};
const TOWNHOUSE: Theme = Theme {
    name: "townhouse",
    floors: (2, 3),
    columns: (3, 4),
    glazing: &[Plain, Sash, Shutters],
    rhythms: &[Rhythm::Same, Rhythm::Ends, Rhythm::Alternate],
    body: Body::Plain,
    ground: Ground::Door,
    attic: Attic::Dormers,
    balconies: 0,
    pilasters: false,
    breaks: (1, 2),
};
const COTTAGE: Theme = Theme {
    name: "cottage",
    floors: (1, 3),
    columns: (3, 5),
    glazing: &[Plain, Shutters],
    rhythms: &[Rhythm::Same, Rhythm::Ends, Rhythm::Middle],
    body: Body::Side,
    ground: Ground::Door,
    attic: Attic::None,
    balconies: 0,
    pilasters: false,
    breaks: (0, 1),
};
const SHOPHOUSE: Theme = Theme {
    name: "shophouse",
    floors: (1, 3),
    columns: (2, 4),
    glazing: &[Plain],
    rhythms: &[Rhythm::Same, Rhythm::Middle],
    body: Body::Plain,
    ground: Ground::Shops,
    attic: Attic::Low,
    balconies: 1,
    pilasters: false,
    breaks: (0, 1),
};
const WAREHOUSE: Theme = Theme {
    name: "warehouse",
    floors: (4, 6),
    columns: (6, 11),
    glazing: &[Lattice, Lattice, Sash],
    rhythms: &[Rhythm::Pairs, Rhythm::Alternate, Rhythm::Mirror],
    body: Body::Projection,
    ground: Ground::Arcade,
    attic: Attic::None,
    balconies: 0,
    pilasters: true,
    breaks: (2, 5),
};

/// Every theme with the number of terminals wanted: the ten of Table 1, three times, with other
/// buildings.
pub(crate) const PLAN: &[(&Theme, usize)] = &[
    (&PALACE, 1085),
    (&BOULEVARD, 523),
    (&TENEMENT, 595),
    (&HOTEL, 895),
    (&OFFICE, 536),
    (&PALACE, 1100),
    (&TOWNHOUSE, 103),
    (&COTTAGE, 71),
    (&SHOPHOUSE, 50),
    (&WAREHOUSE, 839),
    (&HOTEL, 1040),
    (&TENEMENT, 480),
    (&BOULEVARD, 640),
    (&WAREHOUSE, 860),
    (&TENEMENT, 550),
    (&OFFICE, 1000),
    (&TOWNHOUSE, 118),
    (&SHOPHOUSE, 76),
    (&COTTAGE, 55),
    (&PALACE, 800),
    (&WAREHOUSE, 980),
    (&HOTEL, 560),
    (&OFFICE, 620),
    (&BOULEVARD, 900),
    (&BOULEVARD, 500),
    (&HOTEL, 1090),
    (&TOWNHOUSE, 92),
    (&TOWNHOUSE, 66),
    (&SHOPHOUSE, 60),
    (&TENEMENT, 760),
];

const fn terrace(
    floors: (u32, u32),
    columns: (u32, u32),
    ground: Ground,
    breaks: (u32, u32),
) -> Theme {
    Theme {
        name: "terrace",
        floors,
        columns,
        glazing: &[Plain, Shutters],
        rhythms: &[Rhythm::Same, Rhythm::Ends, Rhythm::Alternate],
        body: Body::Plain,
        ground,
        attic: Attic::None,
        balconies: 1,
        pilasters: false,
        breaks,
    }
}

const TERRACES: [Theme; 4] = [
    terrace((2, 3), (3, 4), Ground::Door, (0, 1)),
    terrace((2, 4), (4, 5), Ground::Door, (0, 1)),
    terrace((3, 4), (4, 6), Ground::Shops, (1, 1)),
    terrace((1, 2), (3, 3), Ground::Door, (0, 0)),
];

/// Four facades with the same windows and few ornaments (Fig. 13).
pub(crate) const FAMILY: &[(&Theme, usize)] = &[
    (&TERRACES[0], 75),
    (&TERRACES[1], 100),
    (&TERRACES[2], 140),
    (&TERRACES[3], 52),
];

/// A boulevard house with as many floors and columns as give about this number of terminals.
pub(crate) fn scaled(terminals: usize) -> Theme {
    // About a dozen terminals to a window.
    let windows = (terminals as f64 / 12.0).max(4.0);
    let floors = (windows / 1.5).sqrt().max(1.5);
    let columns = windows / floors;
    let range = |middle: f64, least: u32| {
        let low = ((0.75 * middle) as u32).max(least);
        (low, low.max((1.25 * middle).ceil() as u32))
    };
    Theme {
        floors: range(floors, 1),
        columns: range(columns, 2),
        ..BOULEVARD
    }
}

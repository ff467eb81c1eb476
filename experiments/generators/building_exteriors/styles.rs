//! The seven styles: how often each kind of each attribute occurs in a style.

use rand::{Rng, RngExt};

use edifice_shape::{ElementStyle, RoofStyle, Special};

/// Kinds of the attributes of one house, and its elements.
#[derive(Debug, Clone)]
pub(super) struct Kinds {
    /// 0 small and 1 wide with one floor, 2 compact and 3 large with two, 4 with three.
    pub bbox: usize,
    /// 0 full, 1 medium, 2 low coverage.
    pub bcr: usize,
    /// 0 simple, 1 complex boundary.
    pub bdry: usize,
    /// 0 one floor, 1 large and 2 small upper floor, 3 three floors.
    pub arf: usize,
    /// Index into [`GARAGES`].
    pub garage: usize,
    /// 0 none, 1 front, 2 front and back, 3 back.
    pub porch: usize,
    /// 0 modest, 1 open, 2 glazed.
    pub wwr: usize,
    /// 0 symmetric, 1 mixed, 2 free.
    pub symmetry: usize,
    /// 0 all sides, 1 front and back, 2 none; one-floor houses have nothing to align.
    pub alignment: usize,
    /// Roof styles present, at least one.
    pub roofs: Vec<RoofStyle>,
    /// Window styles present, at least one.
    pub windows: Vec<ElementStyle>,
    /// Special elements present.
    pub special: Vec<Special>,
    /// True if the plan is mirrored left to right.
    pub mirrored: bool,
}

/// The place of a garage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum GaragePlace {
    /// Before the front wall, on the left.
    Front,
    /// Beside the left wall.
    Beside,
    /// Behind the back wall, on the left.
    Behind,
}

/// Kinds of garages: cars and place.
pub(super) const GARAGES: [Option<(usize, GaragePlace)>; 6] = [
    None,
    Some((1, GaragePlace::Front)),
    Some((2, GaragePlace::Front)),
    Some((1, GaragePlace::Beside)),
    Some((2, GaragePlace::Beside)),
    Some((1, GaragePlace::Behind)),
];

/// Kinds of porches.
const PORCHES: usize = 4;

impl Kinds {
    /// The kinds in the order of [`super::KINDS`]; garages and porches of mirrored plans are kinds of their own.
    pub(crate) fn numbers(&self) -> [usize; super::KINDS.len()] {
        let apart = |kind: usize, kinds: usize| match self.mirrored && kind > 0 {
            true => kind + kinds,
            false => kind,
        };
        [
            self.bbox,
            self.bcr,
            self.bdry,
            self.arf,
            apart(self.garage, GARAGES.len()),
            apart(self.porch, PORCHES),
            self.wwr,
            self.symmetry,
            self.alignment,
        ]
    }
}

/// Probabilities of the kinds, in the order of the fields of [`Kinds`]. A roof or window style of
/// probability 1 keeps the lists from being empty.
pub(super) struct Style {
    bbox: [f64; 5],
    bcr: [f64; 3],
    bdry: [f64; 2],
    arf: [f64; 4],
    garage: [f64; 6],
    porch: [f64; PORCHES],
    wwr: [f64; 3],
    symmetry: [f64; 3],
    alignment: [f64; 3],
    /// Flat, gable, hip.
    roof: [f64; 3],
    /// Sash, sliding, casement, bay, fixed.
    window: [f64; 5],
    /// Chimney, tower.
    special: [f64; 2],
    /// Garages on the right.
    mirrored: bool,
}

/// Cottage, ranch, bungalow, town house, suburban house, modern cube, Victorian.
pub(super) const STYLES: [Style; 7] = [
    Style {
        bbox: [0.9, 0.1, 0.0, 0.0, 0.0],
        bcr: [0.8, 0.2, 0.0],
        bdry: [0.9, 0.1],
        arf: [1.0, 0.0, 0.0, 0.0],
        garage: [0.60, 0.0, 0.0, 0.05, 0.0, 0.35],
        porch: [0.25, 0.65, 0.1, 0.0],
        wwr: [0.9, 0.1, 0.0],
        symmetry: [0.85, 0.15, 0.0],
        alignment: [0.0, 0.0, 1.0],
        roof: [0.0, 1.0, 0.1],
        window: [1.0, 0.1, 0.2, 0.05, 0.1],
        special: [0.8, 0.0],
        mirrored: false,
    },
    Style {
        bbox: [0.0, 1.0, 0.0, 0.0, 0.0],
        bcr: [0.1, 0.7, 0.2],
        bdry: [0.3, 0.7],
        arf: [1.0, 0.0, 0.0, 0.0],
        garage: [0.1, 0.0, 0.0, 0.3, 0.6, 0.0],
        porch: [0.1, 0.2, 0.6, 0.1],
        wwr: [0.3, 0.7, 0.0],
        symmetry: [0.1, 0.7, 0.2],
        alignment: [0.0, 0.0, 1.0],
        roof: [0.0, 0.2, 1.0],
        window: [0.1, 1.0, 0.1, 0.3, 0.4],
        special: [0.6, 0.0],
        mirrored: true,
    },
    Style {
        bbox: [0.5, 0.5, 0.0, 0.0, 0.0],
        bcr: [0.3, 0.6, 0.1],
        bdry: [0.7, 0.3],
        arf: [1.0, 0.0, 0.0, 0.0],
        garage: [0.3, 0.6, 0.0, 0.0, 0.0, 0.1],
        porch: [0.1, 0.8, 0.0, 0.1],
        wwr: [0.8, 0.2, 0.0],
        symmetry: [0.2, 0.7, 0.1],
        alignment: [0.0, 0.0, 1.0],
        roof: [0.05, 1.0, 0.5],
        window: [0.3, 0.2, 1.0, 0.4, 0.1],
        special: [0.3, 0.0],
        mirrored: false,
    },
    Style {
        bbox: [0.0, 0.0, 0.9, 0.1, 0.0],
        bcr: [0.85, 0.15, 0.0],
        bdry: [0.9, 0.1],
        arf: [0.0, 0.85, 0.15, 0.0],
        garage: [0.4, 0.1, 0.0, 0.0, 0.0, 0.5],
        porch: [0.6, 0.2, 0.0, 0.2],
        wwr: [0.6, 0.4, 0.0],
        symmetry: [0.9, 0.1, 0.0],
        alignment: [0.8, 0.2, 0.0],
        roof: [0.0, 1.0, 0.15],
        window: [1.0, 0.1, 0.6, 0.5, 0.1],
        special: [0.5, 0.05],
        mirrored: false,
    },
    Style {
        bbox: [0.0, 0.0, 0.0, 1.0, 0.0],
        bcr: [0.0, 0.25, 0.75],
        bdry: [0.1, 0.9],
        arf: [0.0, 0.3, 0.7, 0.0],
        garage: [0.0, 0.15, 0.85, 0.0, 0.0, 0.0],
        porch: [0.0, 0.3, 0.7, 0.0],
        wwr: [0.1, 0.8, 0.1],
        symmetry: [0.1, 0.5, 0.4],
        alignment: [0.2, 0.7, 0.1],
        roof: [0.0, 0.7, 1.0],
        window: [0.7, 0.3, 1.0, 0.8, 0.3],
        special: [0.9, 0.3],
        mirrored: false,
    },
    Style {
        bbox: [0.0, 0.0, 0.6, 0.4, 0.0],
        bcr: [0.5, 0.0, 0.5],
        bdry: [0.5, 0.5],
        arf: [0.0, 0.6, 0.4, 0.0],
        garage: [0.7, 0.0, 0.0, 0.3, 0.0, 0.0],
        porch: [0.2, 0.0, 0.1, 0.7],
        wwr: [0.0, 0.15, 0.85],
        symmetry: [0.1, 0.1, 0.8],
        alignment: [0.1, 0.2, 0.7],
        roof: [1.0, 0.0, 0.0],
        window: [0.0, 0.7, 0.2, 0.0, 1.0],
        special: [0.05, 0.0],
        mirrored: true,
    },
    Style {
        bbox: [0.0, 0.0, 0.0, 0.0, 1.0],
        bcr: [0.2, 0.8, 0.0],
        bdry: [0.4, 0.6],
        arf: [0.0, 0.0, 0.0, 1.0],
        garage: [0.5, 0.0, 0.0, 0.1, 0.0, 0.4],
        porch: [0.3, 0.1, 0.5, 0.1],
        wwr: [0.1, 0.6, 0.3],
        symmetry: [0.6, 0.4, 0.0],
        alignment: [0.7, 0.3, 0.0],
        roof: [0.3, 1.0, 0.3],
        window: [1.0, 0.0, 0.7, 0.9, 0.2],
        special: [0.9, 0.85],
        mirrored: false,
    },
];

/// Share of each style among the houses.
const WEIGHTS: [f64; 7] = [0.15, 0.15, 0.14, 0.15, 0.14, 0.13, 0.14];

const ROOFS: [RoofStyle; 3] = [RoofStyle::Flat, RoofStyle::Gable, RoofStyle::Hip];
const WINDOWS: [ElementStyle; 5] = [
    ElementStyle::Sash,
    ElementStyle::Sliding,
    ElementStyle::Casement,
    ElementStyle::Bay,
    ElementStyle::Fixed,
];
const SPECIAL: [Special; 2] = [Special::Chimney, Special::Tower];

pub(super) fn draw_style(rng: &mut impl Rng) -> usize {
    pick(&WEIGHTS, rng)
}

pub(super) fn draw_kinds(style: usize, rng: &mut impl Rng) -> Kinds {
    let style = &STYLES[style];
    Kinds {
        bbox: pick(&style.bbox, rng),
        bcr: pick(&style.bcr, rng),
        bdry: pick(&style.bdry, rng),
        arf: pick(&style.arf, rng),
        garage: pick(&style.garage, rng),
        porch: pick(&style.porch, rng),
        wwr: pick(&style.wwr, rng),
        symmetry: pick(&style.symmetry, rng),
        alignment: pick(&style.alignment, rng),
        roofs: present(&ROOFS, &style.roof, rng),
        windows: present(&WINDOWS, &style.window, rng),
        special: present(&SPECIAL, &style.special, rng),
        mirrored: style.mirrored,
    }
}

/// Index drawn with the given probabilities.
fn pick(probabilities: &[f64], rng: &mut impl Rng) -> usize {
    let mut left: f64 = rng.random();
    for (i, p) in probabilities.iter().enumerate() {
        left -= p;
        if left < 0.0 {
            return i;
        }
    }
    // Rounding can leave a crumb: the last possible index.
    probabilities.iter().rposition(|&p| p > 0.0).unwrap_or(0)
}

/// The items that are present, each drawn on its own.
fn present<T: Copy>(items: &[T], probabilities: &[f64], rng: &mut impl Rng) -> Vec<T> {
    let drawn = items.iter().zip(probabilities);
    let kept = drawn.filter(|(_, p)| rng.random::<f64>() < **p);
    kept.map(|(item, _)| *item).collect()
}

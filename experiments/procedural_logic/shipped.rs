//! The shipped layouts as label pictures: what the experiments run on without data.
//!
//! The 34 made layouts and facade (i) fall into two groups by family (the first word of the file
//! name): *houses* (cottage, shophouse, terrace, townhouse; facade (i) is of their size) and *blocks*
//! (boulevard, hotel, office, palace, tenement, warehouse). They are painted in the classes of the
//! real sets (`class`), and each house also stands at other sizes ([`resized`]), since a structure
//! that occurs once can neither be retrieved nor vary.

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use edifice_base::rng::stream;
use edifice_frame::layouts::FIGURE_9;
use edifice_shape::{Facade, GridError, LabelGrid, Region};

/// Families of small buildings, with facade (i).
const HOUSES: [&str; 5] = ["cottage", "shophouse", "terrace", "townhouse", FIGURE_9];

/// Seed of the other sizes.
const SEED: u64 = 1;

/// Deviation of the logarithm of all sizes along an axis, and of each single one.
const DEVIATION: [f64; 2] = [0.15, 0.1];

/// True if a layout is of the group of houses.
pub fn is_house(facade: &Facade) -> bool {
    HOUSES.iter().any(|family| facade.name.starts_with(family))
}

/// A layout with every label it has, painted without loss on the grid of its own cut lines.
///
/// # Errors
/// [`GridError::Layout`] when it is no tiling.
pub fn detailed(facade: &Facade) -> Result<LabelGrid, GridError> {
    Ok(LabelGrid::from_facade(facade, None)?.merged())
}

/// A layout in the classes of the real sets.
///
/// # Errors
/// As [`detailed`].
pub fn picture(facade: &Facade) -> Result<LabelGrid, GridError> {
    let regions = facade.regions.iter().map(|region| Region {
        label: class(region, facade).to_owned(),
        rect: region.rect,
    });
    detailed(&Facade {
        regions: regions.collect(),
        ..facade.clone()
    })
}

/// The class, as ECP2011 and Graz2012 have them, of a part: panes with their frames, blinds and
/// shutters are a window, mullions beside shop panes a shop, jambs a door, ornaments and ledges the wall.
fn class<'a>(region: &'a Region, facade: &Facade) -> &'a str {
    let beside = |label: &str| {
        let mut others = facade.regions.iter().filter(|other| other.label == label);
        others.any(|other| level(region, other))
    };
    match region.label.trim_end_matches(char::is_numeric) {
        "frame" if beside("shop") => "shop",
        "trim" if beside("door") => "door",
        "Window" | "glass" | "frame" | "blind" | "shutter" => "window",
        "awning" | "sign" => "shop",
        "dormer" => "roof",
        "Wall" | "plinth" | "base" | "pilaster" | "capital" | "trim" | "sill" | "lintel"
        | "cornice" => "wall",
        other => other,
    }
}

/// True if two regions of one height stand side by side.
fn level(one: &Region, other: &Region) -> bool {
    let (a, b) = (one.rect, other.rect);
    a.y == b.y && a.height == b.height && (a.x == b.right() || a.right() == b.x)
}

/// The same structure at another size, the `copy`-th of this facade: the distance between any two
/// neighbouring cut lines is scaled by a factor of the whole axis and one of its own, both
/// log-normal, and rounded to whole units.
pub fn resized(grid: &LabelGrid, copy: u64) -> LabelGrid {
    let rng = &mut stream(SEED, &format!("resized {}", grid.name), copy);
    LabelGrid {
        name: format!("{}_size_{copy}", grid.name),
        xs: rescaled(&grid.xs, rng),
        ys: rescaled(&grid.ys, rng),
        ..grid.clone()
    }
}

fn rescaled<R: Rng>(cuts: &[f64], rng: &mut R) -> Vec<f64> {
    let mut factor = |deviation: f64| (deviation * rng.sample::<f64, _>(StandardNormal)).exp();
    let whole = factor(DEVIATION[0]);
    let mut place = 0.0;
    let mut rescaled = vec![place];
    for pair in cuts.windows(2) {
        place += ((pair[1] - pair[0]) * whole * factor(DEVIATION[1]))
            .round()
            .max(1.0);
        rescaled.push(place);
    }
    rescaled
}

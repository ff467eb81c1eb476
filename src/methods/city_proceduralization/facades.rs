//! Facades as photographs show them: what of the window features (Sec. IV.C) a rectified picture tells without a scale, and where it
//! is dark and light.

use super::windows::{CELLS, Side, picture_features, side_features};
use edifice_shape::triangles::{CityBuilding, OrientedBox};

/// Numbers of a [`Facade`] that are told by windows.
pub(super) const WINDOWS: usize = 8;
/// Numbers of a [`Facade`].
pub const FACADE_FEATURES: usize = WINDOWS + CELLS * CELLS;

/// Logarithms of the facade's width over its height, of a window's width over that of the facade, of its height over that of the
/// facade; the gaps between windows over their width, and over their height; emptiness; intensity of the wall; and 1 where there
/// are windows, otherwise 0; then the mean greys of 4 x 4 cells less that of all, which hardly change with the light. What a facade
/// without windows does not have is not a number.
pub type Facade = [f64; FACADE_FEATURES];

/// The painted sides of a building.
pub fn facades(building: &CityBuilding) -> Vec<Facade> {
    let Some(frame) = OrientedBox::around(&building.mesh) else {
        return Vec::new();
    };
    let sides = (0..4).filter_map(|side| side_features(&building.paint, &frame, side));
    sides.map(|side| facade(&side)).collect()
}

/// A rectified photograph of a facade from edge to edge: colours, row after row from the top. `None` for one without
/// contrast.
pub fn photographed(width: usize, colours: &[[u8; 3]]) -> Option<Facade> {
    picture_features(width, colours).map(|side| facade(&side))
}

fn facade(side: &Side) -> Facade {
    let [across, up] = side.size;
    let [w, h, x, y, emptiness, intensity] = side.windows;
    let mut out = [f64::NAN; FACADE_FEATURES];
    (out[0], out[6], out[7]) = ((across / up).ln(), intensity, 0.0);
    if w > 0.0 && h > 0.0 {
        let shares = [(w / across).ln(), (h / up).ln(), x / w, y / h, emptiness];
        out[1..6].copy_from_slice(&shares);
        out[7] = 1.0;
    }
    out[WINDOWS..].copy_from_slice(&side.cells);
    out
}

//! Facades as photographs show them: what of the window features (Sec. IV.C) a rectified picture tells without a scale.

use super::windows::{WindowFeatures, picture_features, side_features};
use crate::shape::triangles::{CityBuilding, OrientedBox};

/// Numbers of a [`Facade`].
pub const FACADE_FEATURES: usize = 8;

/// Logarithms of the facade's width over its height, of a window's width over that of the facade, of its height over that of the
/// facade; the gaps between windows over their width, and over their height; emptiness; intensity of the wall; and 1 where there
/// are windows, otherwise 0. What a facade without windows does not have is not a number.
pub type Facade = [f64; FACADE_FEATURES];

/// The painted sides of a building.
pub fn facades(building: &CityBuilding) -> Vec<Facade> {
    let Some(frame) = OrientedBox::around(&building.mesh) else {
        return Vec::new();
    };
    let sides = (0..4).filter_map(|side| side_features(&building.paint, &frame, side));
    sides.map(|(size, windows)| facade(size, windows)).collect()
}

/// A rectified photograph of a facade from edge to edge: colours, row after row from the top. `None` for one without
/// contrast.
pub fn photographed(width: usize, colours: &[[u8; 3]]) -> Option<Facade> {
    picture_features(width, colours).map(|(size, windows)| facade(size, windows))
}

fn facade([across, up]: [f64; 2], windows: WindowFeatures) -> Facade {
    let [w, h, x, y, emptiness, intensity] = windows;
    let none = f64::NAN;
    match w > 0.0 && h > 0.0 {
        true => [
            (across / up).ln(),
            (w / across).ln(),
            (h / up).ln(),
            x / w,
            y / h,
            emptiness,
            intensity,
            1.0,
        ],
        false => [
            (across / up).ln(),
            none,
            none,
            none,
            none,
            none,
            intensity,
            0.0,
        ],
    }
}

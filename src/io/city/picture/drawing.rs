//! Cities to draw, and how.

use edifice_shape::triangles::City;

/// Settings of drawing cities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drawing {
    /// Width of each city's picture, in pixels.
    pub width: usize,
    /// Height, in pixels.
    pub height: usize,
    /// From where, and in which manner.
    pub view: View,
    /// Only buildings whose middle lies within so many metres of a point, in the coordinates of the reference system.
    pub around: Option<([f64; 2], f64)>,
}

/// From where cities are drawn, and in which manner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// In perspective, from the south-west and above.
    Oblique,
    /// From above, north at the top, with shadows.
    Plan,
    /// The plan of an urban designer: what is built on is dark, or has the building's colour, and everything else is white.
    FigureGround,
}

/// A city to draw.
#[derive(Debug, Clone, Copy)]
pub struct Drawn<'a> {
    /// The city.
    pub city: &'a City,
    /// A colour (sRGB) for each building; without them buildings are light, and textures are shown.
    pub colours: Option<&'a [[u8; 3]]>,
}

/// True if a building of these bounds is drawn.
pub(super) fn seen((low, high): &([f64; 3], [f64; 3]), city: &City, drawing: &Drawing) -> bool {
    let Some((at, radius)) = drawing.around else {
        return true;
    };
    let away = |k: usize| (low[k] + high[k]) / 2.0 + city.origin[k] - at[k];
    away(0).hypot(away(1)) <= radius
}

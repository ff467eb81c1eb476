//! Colours.

/// Red, green, blue, opacity (0 to 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colour {
    /// Red.
    pub r: u8,
    /// Green.
    pub g: u8,
    /// Blue.
    pub b: u8,
    /// Opacity.
    pub opacity: f64,
}

impl Colour {
    /// An opaque colour.
    pub const fn new(r: u8, g: u8, b: u8) -> Self {
        Self {
            r,
            g,
            b,
            opacity: 1.0,
        }
    }

    /// The same colour with another opacity.
    pub const fn with_opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// Between this colour (0) and another (1).
    pub fn towards(self, other: Self, t: f64) -> Self {
        let mix = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * t).round() as u8;
        Self::new(
            mix(self.r, other.r),
            mix(self.g, other.g),
            mix(self.b, other.b),
        )
    }
}

pub(super) const INK: Colour = Colour::new(0x22, 0x26, 0x2b);
pub(super) const MUTED: Colour = Colour::new(0x5f, 0x67, 0x70);
pub(super) const FRAME: Colour = Colour::new(0x9a, 0xa2, 0xab);
pub(super) const GRID: Colour = Colour::new(0xe6, 0xe9, 0xec);
pub(super) const PAPER: Colour = Colour::new(0xff, 0xff, 0xff);

/// Colour of category `i`: eight that colour-blind readers tell apart (after Okabe and Ito), then
/// lighter ones.
pub fn category(i: usize) -> Colour {
    const SET: [Colour; 8] = [
        Colour::new(0x00, 0x72, 0xb2),
        Colour::new(0xd5, 0x5e, 0x00),
        Colour::new(0x00, 0x9e, 0x73),
        Colour::new(0xcc, 0x79, 0xa7),
        Colour::new(0xe6, 0x9f, 0x00),
        Colour::new(0x56, 0xb4, 0xe9),
        Colour::new(0x6b, 0x6b, 0x6b),
        Colour::new(0x8c, 0x56, 0x4b),
    ];
    let base = SET[i % SET.len()];
    match i / SET.len() % 2 {
        0 => base,
        _ => base.towards(PAPER, 0.5),
    }
}

/// Colour of `t` (0 to 1, clamped) on a ramp from dark blue to yellow that stays ordered in grey (viridis).
pub fn ramp(t: f64) -> Colour {
    const STOPS: [Colour; 9] = [
        Colour::new(0x44, 0x01, 0x54),
        Colour::new(0x47, 0x2d, 0x7b),
        Colour::new(0x3b, 0x52, 0x8b),
        Colour::new(0x2c, 0x72, 0x8e),
        Colour::new(0x21, 0x91, 0x8c),
        Colour::new(0x28, 0xae, 0x80),
        Colour::new(0x5e, 0xc9, 0x62),
        Colour::new(0xad, 0xdc, 0x30),
        Colour::new(0xfd, 0xe7, 0x25),
    ];
    let place = t.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let below = (place as usize).min(STOPS.len() - 2);
    STOPS[below].towards(STOPS[below + 1], place - below as f64)
}

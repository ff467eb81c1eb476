//! Colours for labels: those of the ECP database for names it knows, distinct ones for others.

use std::collections::BTreeMap;

use super::label_map::{CMP_COLORS, ECP};

/// A colour for each label of a drawing, no two alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Palette {
    colors: BTreeMap<String, [u8; 3]>,
}

impl Palette {
    /// Gives every label a colour: a known one by its name, another by a hash of the name, so that
    /// it has the same colour in other drawings unless another label has taken that.
    pub fn new<'a>(labels: impl IntoIterator<Item = &'a str>) -> Self {
        let mut colors: BTreeMap<String, [u8; 3]> = BTreeMap::new();
        let labels: std::collections::BTreeSet<&str> = labels.into_iter().collect();
        let known = |label: &str| {
            let lower = label.to_lowercase();
            ECP.iter()
                .chain(&CMP_COLORS)
                .find(|(name, _)| *name == lower)
                .map(|(_, color)| *color)
        };
        let mut taken: std::collections::BTreeSet<[u8; 3]> = ECP
            .iter()
            .chain(&CMP_COLORS)
            .map(|(_, color)| *color)
            .collect();
        for label in labels {
            // Labels that differ only in case may both claim a known colour: the first gets it.
            let claimed = known(label).filter(|c| !colors.values().any(|taken| taken == c));
            let color = claimed.unwrap_or_else(|| {
                let start = hash(label);
                let tries = (0..).map(|k| spread(start.wrapping_add(k)));
                tries
                    .into_iter()
                    .find(|c| !taken.contains(c))
                    .unwrap_or([0; 3])
            });
            taken.insert(color);
            colors.insert(label.to_string(), color);
        }
        Self { colors }
    }

    /// The colour of a label; black for one that the palette was not made for.
    pub fn color(&self, label: &str) -> [u8; 3] {
        self.colors.get(label).copied().unwrap_or_default()
    }
}

/// FNV-1a.
fn hash(text: &str) -> u32 {
    text.bytes().fold(0x811c_9dc5, |h, b| {
        (h ^ u32::from(b)).wrapping_mul(0x0100_0193)
    })
}

/// A bright colour from a number: its hue by the golden ratio, so that near numbers differ.
fn spread(number: u32) -> [u8; 3] {
    let hue = (f64::from(number) * 0.618_033_988_749_895).fract() * 6.0;
    let light = [0.95, 0.8, 0.65][(number / 7 % 3) as usize];
    let channel = |shift: f64| {
        let k = (shift + hue) % 6.0;
        let value = light - light * 0.6 * k.min(4.0 - k).clamp(0.0, 1.0);
        (value * 255.0).round() as u8
    };
    [channel(5.0), channel(3.0), channel(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_known_or_distinct() {
        let names: Vec<String> = (0..500).map(|k| format!("label{k}")).collect();
        let all = || {
            names
                .iter()
                .map(String::as_str)
                .chain(["window", "Window", "wall"])
        };
        let palette = Palette::new(all());
        assert_eq!(palette.color("wall"), [255, 255, 0]);
        let distinct: std::collections::BTreeSet<_> = all().map(|l| palette.color(l)).collect();
        assert_eq!(distinct.len(), 503);
        assert_eq!(
            Palette::new(["zinc"]).color("zinc"),
            Palette::new(["zinc", "wall"]).color("zinc")
        );
    }
}

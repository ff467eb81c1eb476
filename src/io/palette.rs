//! Colours for labels: those of the ECP database for leading words it knows, distinct ones for others.

use std::collections::{BTreeMap, BTreeSet};

use super::label_map::{CMP_COLORS, ECP};

/// A colour for each label of a drawing. Labels of one known leading word share the colour of that word;
/// no two others are alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Palette {
    colors: BTreeMap<String, [u8; 3]>,
}

impl Palette {
    /// Gives every label a colour: one of a known [leading word](leading_word) that word's, another by a
    /// hash of the name, so that it has the same colour in other drawings unless another label has
    /// taken that.
    pub fn new<'a>(labels: impl IntoIterator<Item = &'a str>) -> Self {
        let mut colors: BTreeMap<String, [u8; 3]> = BTreeMap::new();
        let labels: BTreeSet<&str> = labels.into_iter().collect();
        let known = || ECP.iter().chain(&CMP_COLORS);
        let mut taken: BTreeSet<[u8; 3]> = known().map(|(_, color)| *color).collect();
        for label in labels {
            let word = leading_word(label);
            let shared = known().find(|(name, _)| *name == word);
            let color = shared.map(|(_, color)| *color).unwrap_or_else(|| {
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

    /// The labels that share a colour with others: a reader of the picture cannot tell them apart.
    pub fn shared(&self) -> Vec<Vec<&str>> {
        let mut by_color: BTreeMap<[u8; 3], Vec<&str>> = BTreeMap::new();
        for (label, color) in &self.colors {
            by_color.entry(*color).or_default().push(label);
        }
        by_color.into_values().filter(|l| l.len() > 1).collect()
    }
}

/// The leading word of a label in lower case: its first letters, up to another character or a capital
/// after a small letter. `Wall1`, `wall_left` and `WallLeft` are walls.
pub fn leading_word(label: &str) -> String {
    let mut word = String::new();
    let mut small = false;
    for c in label.chars() {
        if !c.is_alphabetic() || (small && c.is_uppercase()) {
            break;
        }
        small = c.is_lowercase();
        word.extend(c.to_lowercase());
    }
    word
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
        let all = || names.iter().map(String::as_str).chain(["window", "wall"]);
        let palette = Palette::new(all());
        assert_eq!(palette.color("wall"), [255, 255, 0]);
        let distinct: BTreeSet<_> = all().map(|l| palette.color(l)).collect();
        assert_eq!(distinct.len(), 502);
        assert!(palette.shared().is_empty());
        assert_eq!(
            Palette::new(["zinc"]).color("zinc"),
            Palette::new(["zinc", "wall"]).color("zinc")
        );
    }

    #[test]
    fn labels_have_the_colour_of_their_leading_word() {
        let words = [
            ("Wall1", "wall"),
            ("Window_2", "window"),
            ("WINDOW", "window"),
            ("balcony.left", "balcony"),
            ("doorLeft", "door"),
            ("2nd", ""),
            ("Wände", "wände"),
        ];
        for (label, word) in words {
            assert_eq!(leading_word(label), word);
        }
        let labels = ["Wall1", "Wall2", "Window_2", "wallpaper", "window"];
        let palette = Palette::new(labels);
        let [wall, other, window, paper, same] = labels.map(|l| palette.color(l));
        assert_eq!((wall, other), ([255, 255, 0], [255, 255, 0]));
        assert_eq!((window, same), ([255, 0, 0], [255, 0, 0]));
        assert!(paper != wall && paper != window);
        assert_eq!(
            palette.shared(),
            [vec!["Window_2", "window"], vec!["Wall1", "Wall2"]]
        );
    }
}

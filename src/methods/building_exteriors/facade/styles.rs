//! The styles of windows that a facade is to have, the main one first.

use edifice_shape::ElementStyle;

/// Window styles in the order of their attributes.
pub(super) const WINDOWS: [ElementStyle; 5] = [
    ElementStyle::Sash,
    ElementStyle::Sliding,
    ElementStyle::Casement,
    ElementStyle::Bay,
    ElementStyle::Fixed,
];

/// The styles that are wanted, the main one first: bays are never the main one unless alone.
pub(super) fn wanted(flags: [bool; 5]) -> Vec<ElementStyle> {
    let mut styles: Vec<ElementStyle> = WINDOWS
        .into_iter()
        .zip(flags)
        .filter(|(_, flag)| *flag)
        .map(|(style, _)| style)
        .collect();
    styles.sort_by_key(|s| *s == ElementStyle::Bay);
    styles
}

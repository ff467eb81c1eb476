//! Masks that depend on the facade alone: those of the published benchmark.
//!
//! A mask by a seed is another one where a facade has another name or its elements another order in the file. A frozen mask
//! is drawn by the [digest](Digest) of the content instead, so that everybody hides the same elements of the same facade,
//! whatever the file is called, however it lists its elements, and in whatever unit it is written.

use super::layout::{Element, Layout};
use super::partial::PartialLayout;
use super::sights::{Hidden, Sight};
use super::task::Task;
use edifice_base::rng::{Stream, stream};
use edifice_shape::Rect;

/// Parts of the outline's width and height to which places are rounded, so that units and rounding in files make no difference.
const PARTS: f64 = 1e5;
/// Offset and prime of FNV-1a, 64 bits.
const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0100_0000_01b3;

/// The content of a layout: its elements in the order of the digest, and the digest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Digest {
    /// Indices of the elements: by label, then by left, lower, right and upper edge.
    pub order: Vec<usize>,
    /// FNV-1a, 64 bits, of the labels and the rounded edges in that order.
    pub value: u64,
}

impl Digest {
    /// The digest of elements in an outline of `width` by `height`, both above zero.
    pub fn new(width: f64, height: f64, elements: &[(&str, Rect)]) -> Self {
        let part = |value: f64, of: f64| (value / of * PARTS).round() as i64;
        let key = |index: usize| {
            let (label, r) = &elements[index];
            let x = [part(r.x, width), part(r.right(), width)];
            let y = [part(r.y, height), part(r.top(), height)];
            (*label, [x[0], y[0], x[1], y[1]])
        };
        let mut order: Vec<usize> = (0..elements.len()).collect();
        order.sort_by_key(|&index| key(index));
        let mut value = OFFSET;
        let mut add = |bytes: &[u8]| {
            for byte in bytes {
                value = (value ^ u64::from(*byte)).wrapping_mul(PRIME);
            }
        };
        for &index in &order {
            let (label, edges) = key(index);
            add(label.as_bytes());
            add(&[0]);
            edges.iter().for_each(|edge| add(&edge.to_le_bytes()));
        }
        Self { order, value }
    }

    /// The frozen mask of a part: `split` draws it for the elements in the order of the digest, and what it hides is told in the
    /// order given.
    fn mask(
        &self,
        part: &str,
        elements: &[(&str, Rect)],
        split: impl Fn(&[Rect], &mut Stream) -> Hidden,
    ) -> Hidden {
        let sorted: Vec<Rect> = self.order.iter().map(|&i| elements[i].1).collect();
        let rng = &mut stream(self.value, &format!("frozen mask/{part}"), 0);
        let (sorted, unknown) = split(&sorted, rng);
        let mut hidden = vec![false; elements.len()];
        for (&index, is_hidden) in self.order.iter().zip(sorted) {
            hidden[index] = is_hidden;
        }
        (hidden, unknown)
    }
}

impl Sight {
    /// As [`Sight::split`], by the frozen mask.
    pub fn split_frozen(self, width: f64, height: f64, elements: &[(&str, Rect)]) -> Hidden {
        let digest = Digest::new(width, height, elements);
        digest.mask(self.part(), elements, |sorted, rng| {
            self.split(width, height, sorted, rng)
        })
    }

    /// A whole layout as a partial one by the frozen mask, and the elements that it hides.
    pub fn hide_frozen(self, layout: &Layout) -> (PartialLayout, Vec<Element>) {
        let named = layout.elements.iter().map(|e| (e.class.name(), e.rect));
        let named: Vec<(&str, Rect)> = named.collect();
        let (hidden, unknown) = self.split_frozen(layout.width, layout.height, &named);
        PartialLayout::parted(layout, &hidden, unknown)
    }
}

impl Task {
    /// As [`Task::hide`], by the frozen mask: that of the [`Sight`] of the same name.
    pub fn hide_frozen(self, layout: &Layout) -> (PartialLayout, Vec<Element>) {
        Sight::of(self).hide_frozen(layout)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wall() -> Vec<(&'static str, Rect)> {
        let window = |k: u32| {
            let (column, row) = (f64::from(k % 5), f64::from(k / 5));
            (
                "window",
                Rect::new(1.0 + 3.0 * column, 4.0 + 4.0 * row, 1.5, 2.0),
            )
        };
        let mut all: Vec<(&str, Rect)> = (0..20).map(window).collect();
        all.push(("door", Rect::new(7.0, 0.0, 2.0, 3.0)));
        all
    }

    #[test]
    fn the_mask_is_that_of_the_content() {
        let elements = wall();
        for task in Task::ALL {
            let (hidden, unknown) = Sight::of(task).split_frozen(16.0, 20.0, &elements);
            assert!(
                hidden.iter().any(|h| *h) && !hidden.iter().all(|h| *h),
                "{task:?}"
            );
            // Another order of the elements, and another unit.
            let mut turned = elements.clone();
            turned.rotate_left(7);
            let (other, same) = Sight::of(task).split_frozen(16.0, 20.0, &turned);
            assert_eq!(same, unknown);
            let mut back = other.clone();
            back.rotate_right(7);
            assert_eq!(back, hidden, "{task:?}");
            let feet = elements.iter().map(|(label, r)| {
                let s = 1.0 / 0.3048;
                (
                    *label,
                    Rect::new(r.x * s, r.y * s, r.width * s, r.height * s),
                )
            });
            let feet: Vec<(&str, Rect)> = feet.collect();
            let (other, _) = Sight::of(task).split_frozen(16.0 / 0.3048, 20.0 / 0.3048, &feet);
            assert_eq!(other, hidden, "{task:?}");
        }
    }

    #[test]
    fn other_contents_have_other_digests_and_masks() {
        let elements = wall();
        let digest = Digest::new(16.0, 20.0, &elements);
        let mut masks = std::collections::BTreeSet::new();
        for k in 0..elements.len() {
            let mut changed = elements.clone();
            changed[k].1.x += 0.01;
            let other = Digest::new(16.0, 20.0, &changed);
            assert_ne!(other.value, digest.value, "{k}");
            masks.insert(Sight::of(Task::R50).split_frozen(16.0, 20.0, &changed).0);
        }
        assert!(masks.len() > 15, "{} masks", masks.len());
        let mut named = elements.clone();
        named[0].0 = "shop";
        assert_ne!(Digest::new(16.0, 20.0, &named).value, digest.value);
    }
}

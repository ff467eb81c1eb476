//! Labels for colours that a label map does not name: those of the nearest colour that it names.

use std::fmt;

use rustc_hash::FxHashMap;

use super::label_map::LabelMap;

/// Which colours of an image were not in its label map, and how far they were.
#[derive(Debug, Clone, PartialEq)]
pub struct NearestColours {
    /// Number of distinct colours that the map does not name.
    pub colours: usize,
    /// The largest distance of such a colour from the nearest one of the map: the root of the sum of the
    /// squared differences of red, green and blue, at most 441.7.
    pub distance: f64,
    /// The colour at that distance.
    pub colour: [u8; 3],
    /// Column and row from the upper left of a pixel of that colour, from 0.
    pub place: (usize, usize),
    /// The label that it took.
    pub label: String,
}

impl fmt::Display for NearestColours {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (count, [r, g, b], (x, y)) = (self.colours, self.colour, self.place);
        let are = if count == 1 {
            "colour is"
        } else {
            "colours are"
        };
        write!(
            f,
            "{count} {are} not in the label map; the furthest, [{r}, {g}, {b}] at pixel ({x}, {y}), is {:.1} from that of {}",
            self.distance, self.label
        )
    }
}

/// Labels by nearest colour, remembered by colour.
pub(super) struct NearestSearch {
    candidates: Vec<([u8; 3], u16)>,
    labels: FxHashMap<[u8; 3], u16>,
    furthest: Option<Furthest>,
}

/// The furthest colour so far.
#[derive(Clone, Copy)]
struct Furthest {
    /// Square of its distance.
    squared: u32,
    colour: [u8; 3],
    place: (usize, usize),
    label: u16,
}

impl NearestSearch {
    /// A search among the colours of labels, at least one.
    pub(crate) fn new(candidates: Vec<([u8; 3], u16)>) -> Self {
        Self {
            candidates,
            labels: FxHashMap::default(),
            furthest: None,
        }
    }

    /// The label of the candidate nearest to a colour; `place` is where the colour is met.
    pub(crate) fn label(&mut self, place: (usize, usize), colour: [u8; 3]) -> u16 {
        if let Some(&label) = self.labels.get(&colour) {
            return label;
        }
        let distances = self
            .candidates
            .iter()
            .map(|&(c, l)| (squared(c, colour), l));
        // The first of equally near ones.
        let (distance, label) = distances.min_by_key(|&(d, _)| d).unwrap_or_default();
        self.labels.insert(colour, label);
        if self.furthest.is_none_or(|f| distance > f.squared) {
            self.furthest = Some(Furthest {
                squared: distance,
                colour,
                place,
                label,
            });
        }
        label
    }

    /// The report on all colours that were looked up; `None` if there was none.
    pub(crate) fn found(&self, map: &LabelMap) -> Option<NearestColours> {
        let Furthest {
            squared,
            colour,
            place,
            label,
        } = self.furthest?;
        Some(NearestColours {
            colours: self.labels.len(),
            distance: f64::from(squared).sqrt(),
            colour,
            place,
            label: map.names().nth(label.into())?.to_owned(),
        })
    }
}

fn squared(a: [u8; 3], b: [u8; 3]) -> u32 {
    let differences = a.iter().zip(b).map(|(&a, b)| u32::from(a.abs_diff(b)));
    differences.map(|d| d * d).sum()
}

//! The input of a completion from an annotated layout, and the completed layout.

use std::collections::HashSet;
use std::path::Path;

use edifice_base::{Error, Result};
use edifice_shape::{AnnotatedFacade, Facade, Note, Rect, Region, is_background};
use edifice_structure_completion::completion::Completion;
use edifice_structure_completion::layout::{Class, Element, Layout};
use edifice_structure_completion::partial::PartialLayout;

/// The wishes for a completion, beside the layout.
pub struct Wanted<'a> {
    /// Width of the outline, if another.
    pub width: Option<f64>,
    /// Height of the outline, if another.
    pub height: Option<f64>,
    /// Elements of an earlier completion that stay, by their ids.
    pub pins: &'a [String],
    /// Rectangles in which no element may be added.
    pub forbidden: &'a [Rect],
}

/// A checked input.
pub struct Given {
    /// The layout without dropped elements, as it is shown and written.
    pub shown: AnnotatedFacade,
    /// The layout that is completed.
    pub partial: PartialLayout,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

impl Given {
    /// Drops elements of an earlier completion that are not pinned, changes the outline, checks what is left; the path only
    /// names the layout.
    ///
    /// # Errors
    /// [`Error::Option`] for a pin that is not there or cannot stay, or a bad outline; [`Error::Content`] for what the outline
    /// does not hold.
    pub fn new(annotated: AnnotatedFacade, wanted: &Wanted, path: &Path) -> Result<Self> {
        let mut warnings = Vec::new();
        let (mut regions, mut notes) = (Vec::new(), Vec::new());
        let mut missing: HashSet<&str> = wanted.pins.iter().map(String::as_str).collect();
        let (mut observed, mut pinned, mut others) = (Vec::new(), Vec::new(), Vec::new());
        for (region, mut note) in annotated.facade.regions.into_iter().zip(annotated.notes) {
            let is_pinned = note.id.as_deref().is_some_and(|id| missing.remove(id));
            let added = note.observed == Some(false);
            if added && !is_pinned {
                continue;
            }
            match Class::of_label(&region.label) {
                Some(class) if added => pinned.push(Element::new(class, region.rect)),
                Some(class) => observed.push(Element::new(class, region.rect)),
                None if is_background(&region.label) => {}
                None => others.push(region.label.clone()),
            }
            note.observed = Some(!added);
            regions.push(region);
            notes.push(note);
        }
        if let Some(pin) = wanted
            .pins
            .iter()
            .find(|pin| missing.contains(pin.as_str()))
        {
            return Err(Error::option(
                "--pin",
                format!("no region has the id {pin:?}"),
            ));
        }
        others.sort();
        others.dedup();
        if !others.is_empty() {
            warnings.push(format!(
                "kept, but not completed: {}; only windows, doors, balconies and shops are",
                others.join(", ")
            ));
        }
        if observed.is_empty() && pinned.is_empty() {
            warnings.push("nothing is observed: the layout is a draw from the model".into());
        }
        let (old_width, old_height) = (annotated.facade.width, annotated.facade.height);
        let width = extent("--width", wanted.width, old_width)?;
        let height = extent("--height", wanted.height, old_height)?;
        let facade = Facade::new(
            annotated.facade.name,
            annotated.facade.unit,
            width,
            height,
            regions,
        )
        .map_err(|e| Error::content(path, e))?;
        let mut unknown = annotated.unknown;
        if let Some(unknown) = &mut unknown {
            if width > old_width {
                unknown.push(Rect::new(old_width, 0.0, width - old_width, height));
            }
            if height > old_height {
                let across = old_width.min(width);
                unknown.push(Rect::new(0.0, old_height, across, height - old_height));
            }
        }
        let mut partial = PartialLayout {
            width,
            height,
            observed,
            unknown: unknown.clone(),
            forbidden: wanted.forbidden.to_vec(),
        };
        partial.check().map_err(|e| Error::content(path, e))?;
        warnings.extend(of_overlaps(&partial));
        partial = partial.without_duplicates();
        for pin in &pinned {
            if !partial.allows(pin) {
                let (name, r) = (pin.class.name(), pin.rect);
                let message = format!(
                    "the {name} at ({}, {}) cannot stay: it overlaps an observed element or a forbidden rectangle, or lies on known wall",
                    r.x, r.y
                );
                return Err(Error::option("--pin", message));
            }
            partial.observed.push(*pin);
        }
        let shown = AnnotatedFacade {
            facade,
            notes,
            unknown,
            photograph: annotated.photograph,
        };
        Ok(Self {
            shown,
            partial,
            warnings,
        })
    }

    /// The input with the elements that a completion adds, each with an id of its own.
    pub fn completed(&self, completion: &Completion) -> AnnotatedFacade {
        let mut whole = self.shown.clone();
        let taken: HashSet<String> = whole.notes.iter().filter_map(|n| n.id.clone()).collect();
        let mut free = (1..)
            .map(|k| format!("added_{k}"))
            .filter(|id| !taken.contains(id));
        let label = |class: Class| {
            // As the input calls it.
            let named = self.shown.facade.regions.iter().map(|r| r.label.as_str());
            let mut own = named.filter(|label| Class::of_label(label) == Some(class));
            own.next().unwrap_or(class.name()).to_string()
        };
        for added in &completion.added {
            whole.facade.regions.push(Region {
                label: label(added.element.class),
                rect: added.element.rect,
            });
            whole.notes.push(Note {
                id: free.next(),
                observed: Some(false),
                probability: Some(added.probability.clamp(0.0, 1.0)),
                reason: Some(added.reason.text().to_string()),
            });
        }
        whole
    }

    /// The completed layout as the method sees it.
    pub fn layout(&self, completion: &Completion) -> Layout {
        let added = completion.added.iter().map(|a| a.element);
        Layout {
            name: self.shown.facade.name.clone(),
            width: self.partial.width,
            height: self.partial.height,
            elements: self.partial.observed.iter().copied().chain(added).collect(),
        }
    }
}

/// A note for the user on observed elements that overlap; `None` if none do.
fn of_overlaps(partial: &PartialLayout) -> Option<String> {
    let overlaps = partial.overlaps();
    let first = overlaps.first()?;
    let name = |k: usize| format!("{k} ({})", partial.observed[k].class.name());
    let twice = overlaps.iter().filter(|o| o.twice).count();
    Some(format!(
        "{} pairs of observed elements overlap, the first {} and {}; all are kept, {twice} of them count as one element",
        overlaps.len(),
        name(first.first),
        name(first.second),
    ))
}

fn extent(option: &str, wanted: Option<f64>, own: f64) -> Result<f64> {
    match wanted {
        Some(value) if !(value.is_finite() && value > 0.0) => Err(Error::option(
            option,
            format!("{value} is not a positive number"),
        )),
        wanted => Ok(wanted.unwrap_or(own)),
    }
}

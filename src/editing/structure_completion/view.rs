//! The view of a facade that is being completed, as a page shows it.

use serde_json::{Value, json};

use super::Sketch;
use super::edits::reference;
use edifice_io::palette::leading_word;
use edifice_shape::{AnnotatedFacade, Rect};
use edifice_structure_completion::layout::Class;

/// Labels that are completed.
const LABELS: [&str; 4] = ["window", "door", "balcony", "shop"];

/// Everything there is to show.
pub(super) fn view(sketch: &Sketch) -> Value {
    let facade = &sketch.layout.facade;
    let answers: Vec<Value> = sketch
        .answers
        .iter()
        .map(|(layout, completion)| {
            json!({
                "mass": completion.mass, "score": completion.score, "added": completion.added.len(),
                "elements": elements(layout, &sketch.pins),
            })
        })
        .collect();
    let unknown = sketch.layout.unknown.as_ref();
    let picture = sketch.layout.photograph.as_ref();
    json!({
        "photograph": picture.map(|p| format!("{:016x}", p.id())),
        "original": sketch.original.as_ref().map(|o| o.shown()),
        "unit": facade.unit, "width": facade.width, "height": facade.height,
        "elements": elements(&sketch.layout, &sketch.pins),
        "unknown": unknown.map(|u| u.iter().map(corners).collect::<Vec<_>>()),
        "forbid": sketch.forbidden.iter().map(corners).collect::<Vec<_>>(),
        "answers": answers, "chosen": sketch.chosen, "labels": LABELS,
    })
}

fn corners(r: &Rect) -> [f64; 4] {
    [r.x, r.y, r.width, r.height]
}

fn elements(layout: &AnnotatedFacade, pins: &[String]) -> Vec<Value> {
    let each = layout.facade.regions.iter().zip(&layout.notes).enumerate();
    each.map(|(k, (region, note))| {
        let r = region.rect;
        let class = Class::of_label(&region.label).map(Class::name);
        json!({
            "id": reference(note, k), "label": region.label,
            "class": class.map_or_else(|| leading_word(&region.label), str::to_owned),
            "x": r.x, "y": r.y, "width": r.width, "height": r.height,
            "observed": note.observed != Some(false), "probability": note.probability, "reason": note.reason,
            "pinned": note.id.as_ref().is_some_and(|id| pins.contains(id)),
        })
    })
    .collect()
}

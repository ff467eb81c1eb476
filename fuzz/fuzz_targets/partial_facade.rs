//! Partial layouts with unknown rectangles: no panic; what is read is written and read back the same, and
//! checked before it is completed.
#![no_main]

use edifice::io::facade_json;
use edifice::methods::structure_completion::layout::{Class, Element};
use edifice::methods::structure_completion::method::{Method, complete};
use edifice::methods::structure_completion::model::Model;
use edifice::methods::structure_completion::partial::PartialLayout;
use edifice::rng::stream;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(annotated) = facade_json::parse_annotated(bytes, "fuzz".as_ref()) else {
        return;
    };
    let text = facade_json::annotated_to_string(&annotated);
    let again = facade_json::parse_annotated(text.as_bytes(), "fuzz".as_ref());
    assert_eq!(again.expect("written by us"), annotated);
    let elements = annotated.facade.regions.iter().filter_map(|r| {
        let class = Class::of_label(&r.label)?;
        Some(Element::new(class, r.rect))
    });
    let partial = PartialLayout {
        width: annotated.facade.width,
        height: annotated.facade.height,
        observed: elements.take(40).collect(),
        unknown: annotated.unknown.clone(),
        forbidden: Vec::new(),
    };
    if partial.check().is_ok() && partial.has_unknown() {
        let model = Model::of_spacing(Vec::new());
        for method in [Method::Lattice, Method::Mirror, Method::LowRank] {
            for completion in complete(method, &partial, &model, 1, &mut stream(1, "fuzz", 0)) {
                assert!(completion.added.iter().all(|a| partial.allows(&a.element)));
            }
        }
    }
});

//! Facades that the editor of completions offers to begin with, as files.

/// A facade without any element.
pub(super) const EMPTY: &str = r#"{ "format": "edifice/facade", "version": 1, "name": "sketch", "unit": "m",
  "width": 15.0, "height": 12.0, "regions": [] }"#;

/// Three windows and a door.
pub(super) const FOUR: &str = r#"{ "format": "edifice/facade", "version": 1, "name": "four_elements", "unit": "m",
  "width": 15.0, "height": 12.0, "regions": [
    { "label": "window", "x": 1.5, "y": 4.2, "width": 1.2, "height": 1.7, "id": "w1", "observed": true },
    { "label": "window", "x": 4.1, "y": 4.2, "width": 1.2, "height": 1.7, "id": "w2", "observed": true },
    { "label": "window", "x": 1.5, "y": 7.4, "width": 1.2, "height": 1.7, "id": "w3", "observed": true },
    { "label": "door", "x": 6.8, "y": 0.0, "width": 1.4, "height": 2.5, "id": "d1", "observed": true } ] }"#;

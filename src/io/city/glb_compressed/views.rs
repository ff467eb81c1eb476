//! Buffer views as they are compressed and written.

use serde_json::json;

use super::super::glb::{Glb, INDICES, VERTICES};
use super::super::meshopt_views::EXTENSION;

/// The version of the codec that the extension asks for; the level is of later versions.
pub(super) const VERSION: Option<i32> = Some(0);
pub(super) const LEVEL: i32 = 2;

/// Views as they are written.
pub(super) struct Views<'a> {
    pub(super) file: &'a mut Glb,
    /// Bytes of the views before, without compression.
    fallback: usize,
}

/// The coding of a view: mode, filter and target.
pub(super) type Coding = (&'static str, Option<&'static str>, Option<u32>);

pub(super) const VERTEX: Coding = ("ATTRIBUTES", None, Some(VERTICES));
/// Numbers that are no attributes of corners.
pub(super) const PROPERTIES: Coding = ("ATTRIBUTES", None, None);
pub(super) const OCTAHEDRAL: Coding = ("ATTRIBUTES", Some("OCTAHEDRAL"), Some(VERTICES));
pub(super) const EXPONENTIAL: Coding = ("ATTRIBUTES", Some("EXPONENTIAL"), None);
pub(super) const QUATERNION: Coding = ("ATTRIBUTES", Some("QUATERNION"), None);
pub(super) const TRIANGLES: Coding = ("TRIANGLES", None, Some(INDICES));

impl<'a> Views<'a> {
    pub(super) fn new(file: &'a mut Glb) -> Self {
        Self { file, fallback: 0 }
    }

    /// Bytes of all views, without compression.
    pub(super) fn fallback(&self) -> usize {
        self.fallback
    }

    /// Writes a view of `count` elements of `stride` bytes, of which `bytes` is the code.
    pub(super) fn write(
        &mut self,
        view: usize,
        count: usize,
        stride: usize,
        bytes: &[u8],
        (mode, filter, target): Coding,
    ) {
        // Views of properties begin at multiples of eight bytes.
        self.fallback = self.fallback.next_multiple_of(8);
        let binary = &mut self.file.binary;
        binary.resize(binary.len().next_multiple_of(4), 0);
        let mut own = json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len(),
            "byteStride": stride, "count": count, "mode": mode });
        binary.extend(bytes);
        if let Some(filter) = filter {
            own["filter"] = json!(filter);
        }
        let mut whole = json!({ "buffer": 1, "byteOffset": self.fallback, "byteLength": count * stride,
            "extensions": { EXTENSION: own } });
        if let Some(target) = target {
            whole["target"] = json!(target);
        }
        if mode == "ATTRIBUTES" {
            whole["byteStride"] = json!(stride);
        }
        self.file.views[view] = whole;
        self.fallback += count * stride;
    }
}

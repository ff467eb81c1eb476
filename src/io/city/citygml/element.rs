//! Elements of XML, by their local names.

use quick_xml::XmlVersion;
use quick_xml::events::{BytesRef, BytesStart};

/// An open element.
pub(super) struct Element {
    /// Name without prefix.
    pub(super) name: String,
    /// `gml:id`.
    pub(super) id: Option<String>,
    /// `xlink:href`, without the sign before an identifier of this file.
    pub(super) link: Option<String>,
    /// `srsName`.
    pub(super) system: Option<String>,
    /// `srsDimension`.
    pub(super) dimension: Option<usize>,
    /// `name`, of a generic attribute.
    pub(super) label: Option<String>,
    /// True if `orientation` is "-".
    pub(super) reversed: bool,
    /// Its text so far.
    pub(super) text: String,
}

impl Element {
    /// Attributes that are damaged are not there.
    pub(super) fn new(start: &BytesStart) -> Self {
        let mut out = Self {
            name: start.local_name().as_ref().to_owned(),
            id: None,
            link: None,
            system: None,
            dimension: None,
            label: None,
            reversed: false,
            text: String::new(),
        };
        for attribute in start.attributes().flatten() {
            let value = match attribute.normalized_value(XmlVersion::Implicit1_0) {
                Ok(value) => value.into_owned(),
                Err(_) => continue,
            };
            match attribute.key.local_name().as_ref() {
                "id" => out.id = Some(value),
                "href" => out.link = Some(value.trim_start_matches('#').to_owned()),
                "srsName" => out.system = Some(value),
                "srsDimension" => out.dimension = value.trim().parse().ok(),
                "name" => out.label = Some(value),
                "orientation" => out.reversed = value.trim() == "-",
                _ => {}
            }
        }
        out
    }
}

/// The text of a predefined entity; others are none.
pub(super) fn resolved(reference: &BytesRef) -> &'static str {
    match reference.as_ref() {
        "amp" => "&",
        "lt" => "<",
        "gt" => ">",
        "quot" => "\"",
        "apos" => "'",
        _ => "",
    }
}

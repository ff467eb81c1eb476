//! Cities as CityGML 2 and 3 (`.gml`, `.citygml`, also with `.gz` or `.xz`): z up, metres.
//!
//! The file is read as a stream: beside the buildings that it returns, only one building's text and surfaces are in memory. A
//! `Building` with its parts and installations is a building. Of each, the highest level of detail from 1 to 3 is read: its
//! solids, with their surfaces by reference (`xlink`) or in place, else its boundary surfaces and multi-surfaces, with doors and
//! windows. Polygons with holes are triangulated. What lies in rooms, footprints of level 0, and implicit geometry are left
//! out, and counted in the city's [notes](edifice_shape::triangles::City::notes), as are references that lead nowhere.
//!
//! Coordinates in degrees ([`system`]) are projected to metres east and north of the first corner's degree, on the GRS 80
//! ellipsoid; their order is told by the reference system: latitude first, unless their values say otherwise.

mod building;
mod element;
mod error;
pub mod system;

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;
use lzma_rust2::XzReader;
use quick_xml::Reader;
use quick_xml::events::Event;

use self::building::Draft;
use self::element::Element;
pub use self::error::CityGmlError;
use self::error::{DEEPEST, Dropped};
use self::system::System;
use super::units::in_metres;
use edifice_base::{Error, Result};
use edifice_io::file_stem;
use edifice_shape::triangles::City;

/// Most bytes of a text between two tags: a ring of ten million corners.
const MOST_TEXT: usize = 1 << 30;
/// Bytes that the stream reads at once.
const BUFFER: usize = 1 << 16;

/// Reads a file, gzipped, xz-packed or plain.
///
/// # Errors
/// Names the file and the byte that is wrong.
pub fn read(path: &Path) -> Result<City> {
    let io = |e| Error::io(path, "read", e);
    let mut file = BufReader::with_capacity(BUFFER, File::open(path).map_err(io)?);
    let start = file.fill_buf().map_err(io)?.to_vec();
    let stream: Box<dyn Read> = match &start[..] {
        [0x1f, 0x8b, ..] => Box::new(MultiGzDecoder::new(file)),
        [0xfd, b'7', b'z', b'X', b'Z', 0, ..] => Box::new(XzReader::new(file, true)),
        _ => Box::new(file),
    };
    let mut name = file_stem(path);
    for ending in [".gml", ".citygml", ".xml"] {
        if let Some(short) = name.strip_suffix(ending) {
            name = short.to_owned();
        }
    }
    from_stream(BufReader::with_capacity(BUFFER, stream), &name, path)
}

/// Parses the bytes of a file; `path` only names it in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<City> {
    from_stream(bytes, &file_stem(path), path)
}

/// Reads a stream of XML; `path` only names it in errors.
///
/// # Errors
/// As [`read`].
pub fn from_stream(stream: impl BufRead, name: &str, path: &Path) -> Result<City> {
    let mut reader = Reader::from_reader(stream);
    let mut model = Model::default();
    model.city.name = name.to_owned();
    match model.read(&mut reader) {
        Ok(()) => Ok(model.finished()),
        Err(error) => {
            let position = match error {
                CityGmlError::Xml(_) => reader.error_position(),
                _ => reader.buffer_position(),
            };
            let place = match model.draft.as_ref().filter(|d| !d.id.is_empty()) {
                Some(draft) => format!("byte {position}, building {:?}", draft.id),
                None => format!("byte {position}"),
            };
            Err(Error::input(path, place, error))
        }
    }
}

/// A file while it is read.
#[derive(Default)]
struct Model {
    city: City,
    system: System,
    /// Open elements, outermost first.
    open: Vec<Element>,
    /// The building that is open, and how many elements are around it.
    draft: Option<Draft>,
    depth: usize,
    dropped: Dropped,
    seen: bool,
}

impl Model {
    fn read(&mut self, reader: &mut Reader<impl BufRead>) -> Result<(), CityGmlError> {
        let mut buffer = Vec::new();
        loop {
            buffer.clear();
            match reader.read_event_into(&mut buffer)? {
                Event::Start(start) => {
                    let element = Element::new(&start);
                    self.start(element)?;
                }
                Event::Empty(start) => {
                    let element = Element::new(&start);
                    self.start(element)?;
                    self.end()?;
                }
                Event::Text(text) => {
                    if let Some(element) = self.open.last_mut()
                        && element.text.len() + text.len() <= MOST_TEXT
                    {
                        element.text.push_str(&text.xml10_content());
                    }
                }
                Event::CData(text) => {
                    if let Some(element) = self.open.last_mut() {
                        element.text.push_str(&text.xml10_content());
                    }
                }
                Event::GeneralRef(reference) => {
                    if let Some(element) = self.open.last_mut() {
                        element.text.push_str(element::resolved(&reference));
                    }
                }
                Event::End(_) => self.end()?,
                Event::Eof => break,
                _ => {}
            }
        }
        match self.open.pop() {
            Some(element) => Err(CityGmlError::Truncated(element.name)),
            None if !self.seen => Err(CityGmlError::NoModel(String::new())),
            None => Ok(()),
        }
    }

    fn start(&mut self, element: Element) -> Result<(), CityGmlError> {
        if self.open.len() >= DEEPEST {
            return Err(CityGmlError::TooDeep);
        }
        if self.open.is_empty() {
            if element.name != "CityModel" || self.seen {
                return Err(CityGmlError::NoModel(element.name));
            }
            self.seen = true;
        }
        if let Some(name) = &element.system {
            self.system.name(name);
        }
        match &mut self.draft {
            Some(draft) => draft.start(&element, &self.open, &mut self.dropped),
            None if element.name == "Building" => {
                self.draft = Some(Draft::new(element.id.clone().unwrap_or_default()));
                self.depth = self.open.len();
            }
            None => {
                let member = self
                    .open
                    .last()
                    .is_some_and(|e| e.name == "cityObjectMember");
                self.dropped.others += usize::from(member);
            }
        }
        self.open.push(element);
        Ok(())
    }

    fn end(&mut self) -> Result<(), CityGmlError> {
        // The reader has checked that the end matches the start.
        let Some(element) = self.open.pop() else {
            return Ok(());
        };
        if let Some(draft) = &mut self.draft {
            draft.end(element, &self.open, &mut self.system)?;
            if self.open.len() == self.depth
                && let Some(draft) = self.draft.take()
            {
                self.finish(draft);
            }
        }
        Ok(())
    }

    /// A building that is read whole.
    fn finish(&mut self, draft: Draft) {
        let number = self.city.buildings.len() + 1;
        let mut building = draft.finish(&mut self.dropped);
        if building.mesh.triangles.is_empty() {
            self.dropped.empty += 1;
            return;
        }
        if building.id.is_empty() {
            building.id = format!("building_{number}");
        }
        self.city.buildings.push(building);
    }

    fn finished(mut self) -> City {
        self.city.reference_system = self.system.label();
        self.city.origin = self.system.origin();
        let Dropped {
            others,
            empty,
            implicit,
            rooms,
            references,
            degenerate,
        } = self.dropped;
        let notes = [
            (others, "city objects that are no buildings"),
            (
                empty,
                "buildings without surfaces of level of detail 1 to 3",
            ),
            (implicit, "implicit geometries"),
            (rooms, "rooms"),
            (references, "references to surfaces that lead nowhere"),
            (degenerate, "polygons without area"),
        ];
        let said = notes.into_iter().filter(|(n, _)| *n > 0);
        self.city.notes = said
            .map(|(n, what)| format!("left out: {n} {what}"))
            .collect();
        if self.system.is_projected_here() {
            let note = "degrees were projected to metres around the first corner".to_owned();
            self.city.notes.push(note);
        }
        in_metres(&mut self.city);
        self.city
    }
}

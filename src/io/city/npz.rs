//! Cities as NumPy archives: `V` vertices as integers in centimetres (or floats in metres), `F`
//! triangles indexed locally to each building, `voff` and `foff` offsets (buildings + 1), and optionally
//! `ids`, and `attrs` and `meta` as JSON text.

use std::io::Cursor;
use std::path::Path;

use npyz::{DType, Deserialize, NpyFile, TypeChar};
use zip::ZipArchive;
use zip::read::ZipFile;
use zip::result::ZipError;

use super::CityError;
use edifice_base::{Error, Result};
use edifice_shape::triangles::{City, CityBuilding, TriangleMesh};

/// Metres in the unit of whole-number coordinates.
const CENTIMETRE: f64 = 0.01;

/// Reads an archive.
///
/// # Errors
/// Names the file and the array that is wrong.
pub fn read(path: &Path) -> Result<City> {
    parse(edifice_base::file::read_bytes(path)?, path)
}

/// Parses the bytes of an archive; `path` only names it in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: Vec<u8>, path: &Path) -> Result<City> {
    let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|e| Error::content(path, e))?;
    let mut arrays = Arrays { archive, path };
    let (positions, unit) = arrays.positions()?;
    let triangles = arrays.integers("F")?;
    let voff = arrays.offsets("voff", positions.len() / 3)?;
    let foff = arrays.offsets("foff", triangles.len() / 3)?;
    let count = voff.len() - 1;
    let fail = |array: &str, text: String| Error::input(path, array, CityError::Format(text));
    if foff.len() != voff.len() {
        let text = format!("{} offsets, but voff has {}", foff.len(), voff.len());
        return Err(fail("foff", text));
    }
    let ids = match arrays.texts("ids")? {
        Some(ids) if ids.len() == count => ids,
        Some(ids) => return Err(fail("ids", format!("{} of {count} buildings", ids.len()))),
        None => (0..count).map(|i| i.to_string()).collect(),
    };
    let attributes: Vec<serde_json::Map<_, _>> = match arrays.json("attrs")? {
        Some(list) => serde_json::from_value(list).map_err(|e| Error::input(path, "attrs", e))?,
        None => Vec::new(),
    };
    if !attributes.is_empty() && attributes.len() != count {
        let text = format!("{} of {count} buildings", attributes.len());
        return Err(fail("attrs", text));
    }
    let mut attributes = attributes.into_iter();
    let mut buildings = Vec::with_capacity(count);
    for (b, id) in ids.into_iter().enumerate() {
        let own = &positions[3 * voff[b]..3 * voff[b + 1]];
        let own: Vec<[f64; 3]> = own
            .chunks_exact(3)
            .map(|p| [p[0] * unit, p[1] * unit, p[2] * unit])
            .collect();
        let mut mesh = TriangleMesh::default();
        for t in triangles[3 * foff[b]..3 * foff[b + 1]].chunks_exact(3) {
            if let Some(&index) = t.iter().find(|&&i| i < 0 || i as usize >= own.len()) {
                let error = CityError::Dangling {
                    index: index as u64,
                    count: own.len(),
                };
                return Err(Error::input(path, format!("F, building {id:?}"), error));
            }
            mesh.triangles.push([t[0] as u32, t[1] as u32, t[2] as u32]);
        }
        mesh.positions = own;
        buildings.push(CityBuilding {
            id,
            attributes: attributes.next().unwrap_or_default(),
            mesh,
            ..CityBuilding::default()
        });
    }
    let meta = arrays.json("meta")?.unwrap_or_default();
    let text = |key: &str| meta.get(key).and_then(|v| v.as_str()).map(str::to_owned);
    Ok(City {
        name: text("name").unwrap_or_else(|| edifice_io::file_stem(path)),
        reference_system: text("crs"),
        origin: [0.0; 3],
        buildings,
        notes: Vec::new(),
    })
}

/// A file in the archive.
type Member<'a> = ZipFile<'a, Cursor<Vec<u8>>>;

struct Arrays<'a> {
    archive: ZipArchive<Cursor<Vec<u8>>>,
    path: &'a Path,
}

impl Arrays<'_> {
    fn fail(&self, array: &str, error: impl std::fmt::Display) -> Error {
        let error = CityError::Format(error.to_string());
        Error::input(self.path, format!("array {array}"), error)
    }

    /// An array of the archive: the file of its name with the ending `.npy`; `None` when there is none.
    fn open(&mut self, array: &str) -> std::io::Result<Option<NpyFile<Member<'_>>>> {
        match self.archive.by_name(&format!("{array}.npy")) {
            Ok(file) => NpyFile::new(file).map(Some),
            Err(ZipError::FileNotFound) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }

    /// All items of an array; grows with what is read, never with what a header says.
    fn items<T: Deserialize>(&mut self, array: &str) -> Result<Vec<T>> {
        let path = self.path;
        let fail =
            |error: String| Error::input(path, format!("array {array}"), CityError::Format(error));
        let file = self.open(array).map_err(|e| fail(e.to_string()))?;
        let file = file.ok_or_else(|| fail("missing from the archive".to_owned()))?;
        let mut items = Vec::new();
        for item in file.data::<T>().map_err(|e| fail(e.to_string()))? {
            items.push(item.map_err(|e| fail(e.to_string()))?);
        }
        Ok(items)
    }

    /// An array's letter of type and its size in bytes; `None` when there is no such array.
    fn kind(&mut self, array: &str) -> Result<Option<(TypeChar, u64)>> {
        let found = self.open(array);
        let kind = found.map(|file| file.map(|f| f.dtype()));
        match kind.map_err(|e| self.fail(array, e))? {
            None => Ok(None),
            Some(DType::Plain(kind)) => Ok(Some((kind.type_char(), kind.size_field()))),
            Some(_) => Err(self.fail(array, "a record, not an array of numbers or text")),
        }
    }

    fn integers(&mut self, array: &str) -> Result<Vec<i64>> {
        macro_rules! widened {
            ($t:ty) => {
                Ok(self
                    .items::<$t>(array)?
                    .into_iter()
                    .map(i64::from)
                    .collect())
            };
        }
        match self.kind(array)? {
            Some((TypeChar::Uint, 1)) => widened!(u8),
            Some((TypeChar::Uint, 2)) => widened!(u16),
            Some((TypeChar::Uint, 4)) => widened!(u32),
            Some((TypeChar::Int, 2)) => widened!(i16),
            Some((TypeChar::Int, 4)) => widened!(i32),
            Some((TypeChar::Int, 8)) => self.items::<i64>(array),
            Some(_) => Err(self.fail(array, "not an array of integers of at most 63 bits")),
            None => Err(self.fail(array, "missing from the archive")),
        }
    }

    /// Coordinates, and how many metres they count.
    fn positions(&mut self) -> Result<(Vec<f64>, f64)> {
        match self.kind("V")? {
            Some((TypeChar::Float, 4)) => {
                let items = self.items::<f32>("V")?;
                Ok((items.into_iter().map(f64::from).collect(), 1.0))
            }
            Some((TypeChar::Float, 8)) => Ok((self.items("V")?, 1.0)),
            _ => {
                let items = self.integers("V")?;
                Ok((items.into_iter().map(|v| v as f64).collect(), CENTIMETRE))
            }
        }
    }

    /// Offsets that start at 0, never fall, and end at `end`.
    fn offsets(&mut self, array: &str, end: usize) -> Result<Vec<usize>> {
        let offsets = self.integers(array)?;
        let rising = offsets.windows(2).all(|w| w[0] <= w[1]);
        if offsets.first() != Some(&0) || offsets.last() != Some(&(end as i64)) || !rising {
            return Err(self.fail(array, format!("offsets do not rise from 0 to {end}")));
        }
        Ok(offsets.into_iter().map(|o| o as usize).collect())
    }

    fn texts(&mut self, array: &str) -> Result<Option<Vec<String>>> {
        match self.kind(array)? {
            None => Ok(None),
            Some((TypeChar::UnicodeStr | TypeChar::ByteStr, _)) => Ok(Some(self.items(array)?)),
            Some(_) => {
                let numbers = self.integers(array)?;
                Ok(Some(numbers.iter().map(i64::to_string).collect()))
            }
        }
    }

    fn json(&mut self, array: &str) -> Result<Option<serde_json::Value>> {
        let texts = self.texts(array)?.unwrap_or_default();
        let Some(text) = texts.first() else {
            return Ok(None);
        };
        let value = serde_json::from_str(text);
        value.map(Some).map_err(|e| self.fail(array, e))
    }
}

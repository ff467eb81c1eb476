//! Gzipped files: every text format may be packed, whatever its name says.

use std::io::Read;
use std::path::Path;

use flate2::read::MultiGzDecoder;

use edifice_base::{Error, Result, file};

/// Most bytes that a packed file may unpack to: 256 MB.
pub(crate) const MOST_BYTES: u64 = 1 << 28;

/// The first bytes of a gzipped file.
const MAGIC: [u8; 2] = [0x1f, 0x8b];

/// A packed file that unpacks to more than is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("unpacks to more than {} MB", .0 >> 20)]
pub(crate) struct TooLarge(pub u64);

/// Reads a whole file, unpacked if it is gzipped.
///
/// # Errors
/// [`Error::Io`] as [`file::read_bytes`]; [`Error::Content`] for a damaged or truncated archive and for
/// one that unpacks to more than 256 MB, of which no more than that is ever unpacked.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    unpacked(file::read_bytes(path)?, path)
}

/// Unpacks the bytes of a file, if they are gzipped; `path` only names the file in errors.
///
/// # Errors
/// As [`read_bytes`].
pub(crate) fn unpacked(bytes: Vec<u8>, path: &Path) -> Result<Vec<u8>> {
    unpacked_up_to(MOST_BYTES, bytes, path)
}

fn unpacked_up_to(most: u64, bytes: Vec<u8>, path: &Path) -> Result<Vec<u8>> {
    if !bytes.starts_with(&MAGIC) {
        return Ok(bytes);
    }
    let mut out = Vec::new();
    MultiGzDecoder::new(bytes.as_slice())
        .take(most + 1)
        .read_to_end(&mut out)
        .map_err(|e| Error::content(path, format!("a damaged gzip file: {e}")))?;
    match out.len() as u64 > most {
        true => Err(Error::content(path, TooLarge(most))),
        false => Ok(out),
    }
}

/// The extension that tells the format, in lower case, without a closing `.gz`.
pub fn extension(path: &Path) -> String {
    let lower = |path: &Path| {
        let extension = path.extension().unwrap_or_default();
        extension.to_string_lossy().to_lowercase()
    };
    match lower(path).as_str() {
        "gz" => lower(&path.with_extension("")),
        other => other.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    fn packed(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn packed_and_plain_bytes_are_the_same() {
        let path = "a.txt.gz".as_ref();
        assert_eq!(unpacked(b"wall".to_vec(), path).unwrap(), b"wall");
        assert_eq!(unpacked(packed(b"wall"), path).unwrap(), b"wall");
        // Archives put end to end are one, as gunzip has it.
        let two = [packed(b"wall "), packed(b"door")].concat();
        assert_eq!(unpacked(two, path).unwrap(), b"wall door");
        assert_eq!(extension("dir.x/a.facade.JSON.gz".as_ref()), "json");
        assert_eq!(extension("a.gz".as_ref()), "");
    }

    #[test]
    fn damaged_and_exploding_archives_are_refused() {
        let path: &Path = "a.txt.gz".as_ref();
        let good = packed(b"wall wall wall wall");
        let message = unpacked(good[..good.len() - 5].to_vec(), path).unwrap_err();
        assert!(message.to_string().starts_with("a.txt.gz: a damaged gzip"));
        let bomb = packed(&vec![b' '; 3 << 20]);
        assert!(bomb.len() < 1 << 16);
        let message = unpacked_up_to(2 << 20, bomb.clone(), path).unwrap_err();
        assert_eq!(message.to_string(), "a.txt.gz: unpacks to more than 2 MB");
        assert_eq!(unpacked_up_to(3 << 20, bomb, path).unwrap().len(), 3 << 20);
    }
}

//! Checksums, and packed texts.

use super::error::CompactError;

/// Most bytes of names, identifiers and attributes, unpacked.
const MOST_TEXT: u64 = 1 << 28;

pub(super) fn checksum(bytes: &[u8]) -> u32 {
    let mut crc = flate2::Crc::new();
    crc.update(bytes);
    crc.sum()
}

pub(super) fn deflated(bytes: &[u8]) -> Vec<u8> {
    use std::io::Write;
    let mut encoder = flate2::write::DeflateEncoder::new(Vec::new(), flate2::Compression::best());
    // Writing to memory does not fail.
    let _ = encoder.write_all(bytes);
    encoder.finish().unwrap_or_default()
}

pub(super) fn inflated(bytes: &[u8]) -> Result<Vec<u8>, CompactError> {
    use std::io::Read;
    let mut out = Vec::new();
    let decoder = flate2::read::DeflateDecoder::new(bytes);
    let read = decoder.take(MOST_TEXT + 1).read_to_end(&mut out);
    read.map_err(|e| CompactError::Text(e.to_string()))?;
    match out.len() as u64 > MOST_TEXT {
        true => Err(CompactError::TooLarge("bytes of text")),
        false => Ok(out),
    }
}

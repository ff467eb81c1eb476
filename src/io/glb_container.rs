//! The container of binary glTF 2.0: a header, a chunk of JSON and a chunk of bytes.

/// A file would be longer than its header can say.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{0} bytes, more than a binary glTF can hold")]
pub struct TooLong(pub u64);

/// Header, JSON chunk padded with spaces, binary chunk padded with zeros.
///
/// # Errors
/// [`TooLong`].
pub fn glb_container(mut json: Vec<u8>, mut binary: Vec<u8>) -> Result<Vec<u8>, TooLong> {
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let total = 12 + 8 + json.len() as u64 + 8 + binary.len() as u64;
    let length = u32::try_from(total).map_err(|_| TooLong(total))?;
    let mut out = Vec::with_capacity(total as usize);
    out.extend(b"glTF");
    out.extend(2u32.to_le_bytes());
    out.extend(length.to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", binary)] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_are_padded_to_four_bytes() {
        let file = glb_container(b"{\"a\":1}".to_vec(), vec![1, 2, 3, 4, 5]).unwrap();
        assert_eq!(file.len(), 12 + 8 + 8 + 8 + 8);
        assert_eq!(&file[20..28], b"{\"a\":1} ");
        assert_eq!(&file[36..], [1, 2, 3, 4, 5, 0, 0, 0]);
    }
}

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

/// Why bytes are no binary glTF.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ContainerError {
    /// Another version than 2.
    #[error("binary glTF of version {0}, expected 2")]
    Version(u32),
    /// The file ends within a chunk.
    #[error("the file ends within its header or a chunk")]
    Truncated,
    /// The first chunk is not JSON.
    #[error("the first chunk is not JSON")]
    NoJson,
}

/// The JSON and the binary chunk of a file that starts with `glTF`.
///
/// # Errors
/// [`ContainerError`].
pub fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), ContainerError> {
    let word = |bytes: &[u8], at: usize| {
        let four = bytes.get(at..at + 4).and_then(|b| b.try_into().ok());
        four.map(u32::from_le_bytes)
            .ok_or(ContainerError::Truncated)
    };
    let version = word(bytes, 4)?;
    if version != 2 {
        return Err(ContainerError::Version(version));
    }
    let mut rest = bytes.get(12..).ok_or(ContainerError::Truncated)?;
    type Chunk<'b> = Option<(&'b [u8], &'b [u8])>;
    let mut chunk = || -> Result<Chunk, ContainerError> {
        if rest.is_empty() {
            return Ok(None);
        }
        let length = word(rest, 0)? as usize;
        let kind = rest.get(4..8).ok_or(ContainerError::Truncated)?;
        let body = rest.get(8..).and_then(|b| b.get(..length));
        let body = body.ok_or(ContainerError::Truncated)?;
        rest = &rest[8 + length..];
        Ok(Some((kind, body)))
    };
    let Some((b"JSON", text)) = chunk()? else {
        return Err(ContainerError::NoJson);
    };
    let binary = chunk()?.filter(|(kind, _)| *kind == b"BIN\0");
    Ok((text, binary.map(|(_, body)| body)))
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

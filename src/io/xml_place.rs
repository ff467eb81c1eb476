//! Places in XML files, for errors.

/// `line L, column C`, both from 1, of a byte of a file; a byte beyond its end is its end.
pub(super) fn place(bytes: &[u8], position: u64) -> String {
    let position = usize::try_from(position).unwrap_or(usize::MAX);
    let before = &bytes[..position.min(bytes.len())];
    let line = 1 + before.iter().filter(|&&b| b == b'\n').count();
    let column = 1 + before.iter().rev().take_while(|&&b| b != b'\n').count();
    format!("line {line}, column {column}")
}

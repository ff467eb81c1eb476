//! The memory and the files of a command and of all that it has started.

use std::path::Path;

/// Bytes of all files below a folder; what goes while it is looked at counts as nothing.
pub(crate) fn bytes_below(folder: &Path) -> u64 {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return 0;
    };
    let sizes = entries.flatten().map(|entry| match entry.metadata() {
        Ok(about) if about.is_dir() => bytes_below(&entry.path()),
        Ok(about) => about.len(),
        Err(_) => 0,
    });
    sizes.sum()
}

/// Resident bytes of all processes of a group, by `/proc`; 0 where there is none.
pub(crate) fn resident(group: u32) -> u64 {
    /// Bytes of a page; larger ones only make the limit more generous.
    const PAGE: u64 = 4096;
    let Ok(processes) = std::fs::read_dir("/proc") else {
        return 0;
    };
    let of = |entry: std::fs::DirEntry| {
        let name = entry.file_name();
        name.to_str()?.parse::<u32>().ok()?;
        let text = std::fs::read_to_string(entry.path().join("stat")).ok()?;
        // The name of a program, in parentheses, may hold anything.
        let (_, after) = text.rsplit_once(')')?;
        let mut fields = after.split_whitespace();
        let own: u32 = fields.nth(2)?.parse().ok()?;
        let pages: u64 = fields.nth(18)?.parse().ok()?;
        (own == group).then_some(pages * PAGE)
    };
    processes.flatten().filter_map(of).sum()
}

/// Bytes of a size as Slurm writes it: `500M`, `2G`, megabytes without a letter.
pub(crate) fn bytes(size: &str) -> u64 {
    let digits = size.trim_end_matches(['K', 'M', 'G', 'T']);
    let number: u64 = digits.parse().unwrap_or(u64::MAX);
    let factor = match &size[digits.len()..] {
        "K" => 1 << 10,
        "G" => 1 << 30,
        "T" => 1 << 40,
        _ => 1 << 20,
    };
    number.saturating_mul(factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_memory() {
        assert_eq!(bytes("2G"), 2 << 30);
        assert_eq!(bytes("500M"), 500 << 20);
        assert_eq!(bytes("64"), 64 << 20);
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("a")).unwrap();
        std::fs::write(folder.path().join("a/b"), [0; 100]).unwrap();
        std::fs::write(folder.path().join("c"), [0; 10]).unwrap();
        assert_eq!(bytes_below(folder.path()), 110);
    }
}

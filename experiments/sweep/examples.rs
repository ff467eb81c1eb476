//! The sweeps that ship with the project, as part of the program: ablations of the papers, and one to begin with.

use include_dir::{Dir, include_dir};

/// `experiments/sweep/examples/` of the checkout that the program was built from.
static SWEEPS: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/examples");

/// A sweep file that ships.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Example {
    /// Its name, without `.toml`.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

impl Example {
    /// Its subject: the first line of its comment.
    pub fn about(&self) -> &'static str {
        let first = self.text.lines().next().unwrap_or_default();
        first.trim_start_matches('#').trim()
    }
}

/// All of them, by name.
pub fn examples() -> Vec<Example> {
    let mut found: Vec<Example> = SWEEPS
        .files()
        .filter_map(|file| {
            let name = file.path().file_name()?.to_str()?.strip_suffix(".toml")?;
            let text = file.contents_utf8()?;
            Some(Example { name, text })
        })
        .collect();
    found.sort_by_key(|example| example.name);
    found
}

//! The place of the real data for the tests on it.

use std::io::Write;
use std::path::{Path, PathBuf};

/// The folder of real data (`EDIFICE_DATA`, or `../shared/data`) when it holds `needed`.
///
/// Without it the test is skipped, said on standard error past the capture of the test harness.
/// With `EDIFICE_REQUIRE_DATA` set, as `.ci/run` does where there is data, that is a failure.
pub(crate) fn real_data(needed: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    let folder = std::env::var_os("EDIFICE_DATA")
        .filter(|named| !named.is_empty())
        .map_or(beside, PathBuf::from);
    let path = folder.join(needed);
    if path.exists() {
        return Some(folder);
    }
    let missing = format!("no {}; set EDIFICE_DATA", path.display());
    let required = std::env::var_os("EDIFICE_REQUIRE_DATA").is_some_and(|set| !set.is_empty());
    assert!(!required, "{missing}");
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("a test");
    // Nobody is left to tell when standard error itself is closed.
    let _ = writeln!(std::io::stderr(), "SKIPPED {test}: {missing}");
    None
}

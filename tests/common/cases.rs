//! The number of random cases of a test.

/// A quarter of `all` cases, or all of them where `EDIFICE_ALL_CASES` is set, as `.ci/full` does.
pub(crate) fn cases(all: usize) -> usize {
    match std::env::var_os("EDIFICE_ALL_CASES") {
        Some(_) => all,
        None => all.div_ceil(4),
    }
}

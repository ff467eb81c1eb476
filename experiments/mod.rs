//! The experiments: settings on one page per paper, one function per artefact.

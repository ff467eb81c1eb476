//! Readers and writers: what they take, refuse and how much memory they use.

mod convert;
mod files;
mod fuzz_seeds;
#[cfg(target_os = "linux")]
mod limits;
mod odd_tables;
mod readers;

//! The `edifice` command line.
fn main() {}

//! The `edifice` command line: parses, calls, prints; everything else is in the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    edifice_cli::run()
}

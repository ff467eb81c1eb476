//! Houses on the command line.

use clap::Subcommand;

/// Commands.
#[derive(Subcommand)]
pub enum Command {}

/// Runs the command.
pub fn run(command: Command) -> edifice::Result<()> {
    match command {}
}

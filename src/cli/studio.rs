//! `edifice studio`.

use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use edifice_base::Result;
use edifice_studio::{Settings, start};

use super::print;

/// Options of `edifice studio`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice studio
  edifice studio office_1.facade.json houses/house_0001.building.json
  edifice studio fig9.grammar.json --port 8080 --no-open --read-only

The first line on standard output is the address, with the token that opens it; Ctrl-C ends the studio. It listens on this
machine only, and its page asks nothing of any other. Files open in the editor that suits them: whole facades and grammars
(.facade.json, .grammar.json, .cga), partial facades (.facade.json), houses (.building.json), cities (.city-grammar.json, or
triangles: .npz, .obj, .glb, .gltf, .city.json, .city.jsonl).
Saving writes the file and, beside it, the edits as a shell script of edifice commands that writes the same bytes. A photograph
that is drawn over is kept in the file.")]
pub struct Args {
    /// Files to open; without any, the page begins with examples
    files: Vec<PathBuf>,
    /// Port to listen on; 0 takes a free one
    #[arg(long, default_value_t = 0)]
    port: u16,
    /// Do not open the browser
    #[arg(long)]
    no_open: bool,
    /// Never write a file
    #[arg(long)]
    read_only: bool,
}

/// Runs the command.
pub fn run(args: Args) -> Result<()> {
    let running = start(&Settings {
        files: args.files,
        port: args.port,
        read_only: args.read_only,
        ..Settings::default()
    })?;
    print::line(running.address())?;
    if !args.no_open && std::io::stdout().is_terminal() {
        open(running.address());
    }
    print::message("Ctrl-C ends the studio");
    running.serve_until_interrupted()
}

/// Opens the address in the browser, where there is a program for that; the user has the address in any case.
fn open(address: &str) {
    let program = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let command = Command::new(program)
        .arg(address)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    if command.is_err() {
        print::message("open the address above in a browser");
    }
}

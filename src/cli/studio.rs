//! `edifice studio`.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use edifice_base::{Error, Result};
use edifice_experiments::{ReportDocument, documents};
use edifice_studio::private::state_folder;
use edifice_studio::redirect::Redirect;
use edifice_studio::{Settings, start};

use super::print::{self, Json};

/// Options of `edifice studio`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice studio
  edifice studio office_1.facade.json houses/house_0001.building.json
  edifice studio photo.jpg
  edifice studio fig9.grammar.json --port 8080 --no-open --read-only
  edifice studio --report figure_16
  edifice studio --report facade_grammar/figure_15/townhouse_1

The first line on standard output is the address, with the token that opens it; Ctrl-C ends the studio. It listens on this
machine only, and its page asks nothing of any other. Files open in the editor that suits them: whole facades and grammars
(.facade.json, .grammar.json, .cga), partial facades (.facade.json), photographs of facades to draw over (.jpg, .png), houses
(.building.json), cities (.city-grammar.json, or triangles: .npz, .obj, .glb, .gltf, .city.json, .city.jsonl).
Saving writes the file and, beside it, the edits as a shell script of edifice commands that writes the same bytes; a file or a
script of somebody else is not replaced unasked. A photograph that is drawn over is kept in the file. What is not saved is kept in
the user's state folder ($XDG_STATE_HOME/edifice/studio, by default ~/.local/state/edifice/studio) and offered at the next start.

A picture of the report is named [PAPER/]ARTEFACT[/DOCUMENT]; of several documents all are opened. They are copies: the shipped
files and the report stay as they are, and saving writes into the present folder.")]
pub(crate) struct Args {
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
    /// Open the documents of a picture of the report, for example `figure_16` or `facade_grammar/figure_16/office_1`
    #[arg(long, value_name = "NAME")]
    report: Option<String>,
    /// Folder of that report, written by `edifice reproduce` [default: reports]
    #[arg(long = "in", value_name = "REPORT_DIR", requires = "report")]
    within: Option<PathBuf>,
    #[command(flatten)]
    json: Json,
}

/// Runs the command.
pub(crate) fn run(args: Args) -> Result<()> {
    let copies = match pictured(args.report.as_deref(), args.within.as_deref()) {
        // A name that names nothing is wrong usage.
        Err(error @ Error::Option { .. }) => {
            print::error(&error);
            std::process::exit(2)
        }
        read => read?,
    };
    if copies.len() > 1 {
        let count = copies.len();
        print::message(&format!(
            "opening {count} documents; NAME/DOCUMENT opens one alone"
        ));
    }
    let state = state_folder();
    let running = start(&Settings {
        files: args.files,
        copies,
        port: args.port,
        read_only: args.read_only,
        state: state.clone(),
        ..Settings::default()
    })?;
    match args.json.is_asked() {
        true => args
            .json
            .end(&serde_json::json!({ "address": running.address() }))?,
        false => print::line(running.address())?,
    }
    let wanted = !args.no_open && std::io::stdout().is_terminal();
    let redirect = state
        .filter(|_| wanted)
        .and_then(|folder| Redirect::new(&folder, running.address()).ok());
    match &redirect {
        Some(redirect) if open(redirect.path()) => {}
        _ if wanted => print::message("open the address above in a browser"),
        _ => {}
    }
    match running.count_offered() {
        0 => {}
        1 => print::message("unsaved work of 1 document is offered on the page"),
        more => print::message(&format!(
            "unsaved work of {more} documents is offered on the page"
        )),
    }
    print::message("Ctrl-C ends the studio");
    running.serve_until_interrupted(ends)
}

/// The documents of a picture of the report.
fn pictured(name: Option<&str>, folder: Option<&Path>) -> Result<Vec<ReportDocument>> {
    let Some(name) = name else {
        return Ok(Vec::new());
    };
    if let Some(folder) = folder {
        // Documents that ship need no folder, but one that is named is there.
        std::fs::read_dir(folder).map_err(|e| Error::io(folder, "read", e))?;
    }
    documents(name, folder.unwrap_or(Path::new("reports")))
}

/// Asks whether the studio is to end with unsaved work; without a terminal it ends.
fn ends(names: &[String]) -> bool {
    let kept = "what is not saved is kept and offered at the next start";
    let names = names.join(", ");
    if !std::io::stdin().is_terminal() {
        print::message(&format!("not saved: {names}; {kept}"));
        return true;
    }
    print::message(&format!(
        "\nnot saved: {names}; {kept}. End the studio? [y/N]"
    ));
    let mut answer = String::new();
    match std::io::stdin().read_line(&mut answer) {
        // The end of the input is no wish to go on.
        Ok(0) | Err(_) => true,
        Ok(_) => matches!(answer.trim(), "y" | "Y" | "yes"),
    }
}

/// Opens a file in the browser, where there is a program for that; true if it was started.
fn open(file: &Path) -> bool {
    let program = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let command = Command::new(program)
        .arg(file)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    command.is_ok()
}

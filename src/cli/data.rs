//! `edifice data`: the data sets that the field has, by name, and those of one's own.

mod croissant;
mod set;

use std::path::{Path, PathBuf};

use clap::Subcommand;
use edifice_base::{Error, Result, file};
use edifice_experiments::sweep::definition::suggestion;
use serde_json::json;

use super::print;
use set::{Found, Set};

/// Commands.
#[derive(Subcommand)]
pub(crate) enum Command {
    /// List the sets that are described, and which of them are in the data folder
    List(List),
    /// Read every file of sets and say what is missing or cannot be read
    #[command(
        after_help = "Examples:\n  edifice data check\n  edifice data check ecp2011 cmp --data datasets --json"
    )]
    Check(Check),
    /// Describe a folder of files: writes dataset.toml where there is none, and croissant.json
    #[command(
        after_help = "Example:\n  edifice data describe draws --files '*.facade.json'\n  edifice data check draws/dataset.toml"
    )]
    Describe(Describe),
}

/// Options of `list`.
#[derive(clap::Args)]
pub(crate) struct List {
    /// Folder with the real data sets; without it, the environment variable `EDIFICE_DATA`
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Print one JSON object as the last line
    #[arg(long)]
    json: bool,
}

/// Options of `check`.
#[derive(clap::Args)]
pub(crate) struct Check {
    /// Names of sets, or files dataset.toml of your own; all that are described when none is named
    sets: Vec<String>,
    /// Folder with the real data sets; without it, the environment variable `EDIFICE_DATA`
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Print one JSON object as the last line
    #[arg(long)]
    json: bool,
}

/// Options of `describe`.
#[derive(clap::Args)]
pub(crate) struct Describe {
    /// Folder of the set
    folder: PathBuf,
    /// Files of the set, below the folder, where no dataset.toml names them; repeatable
    #[arg(long, value_name = "GLOB", default_value = "*")]
    files: Vec<String>,
    /// Print one JSON object as the last line
    #[arg(long)]
    json: bool,
}

/// Runs a command.
pub(crate) fn run(command: Command) -> Result<()> {
    match command {
        Command::List(args) => list(&args),
        Command::Check(args) => check(&args),
        Command::Describe(args) => describe(&args),
    }
}

/// The data folder of an option, or of the environment.
fn folder(given: Option<&PathBuf>) -> Option<PathBuf> {
    let named = std::env::var_os("EDIFICE_DATA").filter(|value| !value.is_empty());
    given.cloned().or_else(|| named.map(PathBuf::from))
}

fn list(args: &List) -> Result<()> {
    let data = folder(args.data.as_ref());
    let mut told = Vec::new();
    for set in set::described()? {
        let found = match &data {
            Some(data) => set.find(data)?.len(),
            None => 0,
        };
        let state = match (found, set.count) {
            (0, _) => "missing".to_owned(),
            (found, wanted) => format!("{found} of {wanted} files"),
        };
        print::line(&format!(
            "{:<16}{:<10}{:<18}{}",
            set.name, set.kind, state, set.about
        ))?;
        told.push(json!({
            "name": set.name, "title": set.title, "kind": set.kind, "about": set.about, "url": set.url,
            "licence": set.licence, "citation": set.citation, "files": found, "expected": set.count,
        }));
    }
    match args.json {
        true => print::line(&json!({ "sets": told }).to_string()),
        false => Ok(()),
    }
}

/// Sets that have faults.
#[derive(Debug, thiserror::Error)]
#[error("{0} files of data sets cannot be read")]
struct Faults(usize);

fn check(args: &Check) -> Result<()> {
    let data = folder(args.data.as_ref());
    let described = set::described()?;
    let mut chosen: Vec<(Set, Option<PathBuf>)> = Vec::new();
    for name in &args.sets {
        if name.ends_with(".toml") {
            let path = Path::new(name);
            let own = path.parent().unwrap_or(Path::new("")).to_path_buf();
            chosen.push((Set::read(path)?, Some(own)));
            continue;
        }
        let Some(known) = described.iter().find(|set| set.name == *name) else {
            let near = suggestion(name, described.iter().map(|set| set.name.as_str()));
            let message = format!("no set {name:?} is described{near}");
            return Err(Error::option("SETS", message));
        };
        chosen.push((known.clone(), data.clone()));
    }
    if args.sets.is_empty() {
        chosen.extend(described.into_iter().map(|set| (set, data.clone())));
    }
    let (mut told, mut faults) = (Vec::new(), 0);
    for (set, folder) in chosen {
        let files = match &folder {
            Some(folder) => set.find(folder)?,
            None => Vec::new(),
        };
        let mut wrong = Vec::new();
        for path in &files {
            if let Err(reason) = set.check(path) {
                print::line(&format!("{}: {reason}", set.name))?;
                wrong.push(reason);
            }
        }
        let state = match files.len() {
            0 => "missing",
            count if count < set.count => "incomplete",
            _ if wrong.is_empty() => "whole",
            _ => "faulty",
        };
        print::line(&format!(
            "{}: {state}, {} of {} files, {} cannot be read{}",
            set.name,
            files.len(),
            set.count,
            wrong.len(),
            match files.is_empty() {
                true => format!("; to be had from {}", set.url),
                false => String::new(),
            }
        ))?;
        faults += wrong.len();
        told.push(json!({
            "name": set.name, "state": state, "files": files.len(), "expected": set.count, "faults": wrong,
        }));
    }
    if args.json {
        print::line(&json!({ "sets": told }).to_string())?;
    }
    match faults {
        0 => Ok(()),
        faults => Err(Error::method(Faults(faults))),
    }
}

fn describe(args: &Describe) -> Result<()> {
    let path = args.folder.join("dataset.toml");
    let set = match path.is_file() {
        true => Set::read(&path)?,
        false => {
            let set = Set::skeleton(&args.folder, &args.files)?;
            let text = toml::to_string_pretty(&set).map_err(Error::method)?;
            file::write_atomic(&path, text.as_bytes())?;
            print::message(&format!(
                "{}: written; licence, citation and address are yours to fill in",
                path.display()
            ));
            set
        }
    };
    let files: Vec<Found> = set.digests(&args.folder)?;
    let text = serde_json::to_string_pretty(&croissant::metadata(&set, &files));
    let croissant = args.folder.join("croissant.json");
    let text = text.map_err(Error::method)? + "\n";
    file::write_atomic(&croissant, text.as_bytes())?;
    print::line(&format!("{}: {} files", croissant.display(), files.len()))?;
    match args.json {
        true => print::line(
            &json!({ "set": set.name, "files": files.len(), "croissant": croissant }).to_string(),
        ),
        false => Ok(()),
    }
}

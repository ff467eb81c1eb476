//! `edifice completions` and `edifice man`.

use std::path::PathBuf;

use clap_complete::Shell;
use edifice_base::{Error, Result, file};

use super::print::{self, Json};

/// Options of `completions`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice completions bash > ~/.local/share/bash-completion/completions/edifice
  edifice completions zsh > ~/.zfunc/_edifice
  edifice completions fish > ~/.config/fish/completions/edifice.fish")]
pub(crate) struct Completions {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
    #[command(flatten)]
    json: Json,
}

/// Options of `man`.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  edifice man -o ~/.local/share/man/man1")]
pub(crate) struct Man {
    /// Folder for the pages, one a command; without it that of `edifice` is printed
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    json: Json,
}

/// Prints the completions of a shell.
pub(crate) fn completions(args: &Completions, mut command: clap::Command) -> Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut command, "edifice", &mut text);
    let text = String::from_utf8_lossy(&text);
    match args.json.is_asked() {
        true => args
            .json
            .end(&serde_json::json!({ "shell": args.shell.to_string(), "text": text })),
        false => print::line(text.trim_end()),
    }
}

/// Writes the manual pages.
pub(crate) fn man(args: &Man, command: clap::Command) -> Result<()> {
    let mut command = command.disable_help_subcommand(true);
    command.build();
    let Some(folder) = &args.output else {
        let page = page(&command)?;
        let text = String::from_utf8_lossy(&page);
        return match args.json.is_asked() {
            true => args.json.end(&serde_json::json!({ "text": text })),
            false => print::line(&text),
        };
    };
    std::fs::create_dir_all(folder).map_err(|e| Error::io(folder, "create", e))?;
    let mut open = vec![("edifice".to_owned(), command)];
    let mut files = Vec::new();
    while let Some((name, command)) = open.pop() {
        for inner in command.get_subcommands() {
            open.push((format!("{name}-{}", inner.get_name()), inner.clone()));
        }
        let named = command.name(name.clone().leak() as &str);
        let path = folder.join(format!("{name}.1"));
        file::write_atomic(&path, &page(&named)?)?;
        files.push(path);
    }
    print::message(&format!("{} pages in {}", files.len(), folder.display()));
    args.json.end(&serde_json::json!({ "files": files }))
}

/// The page of a command.
fn page(command: &clap::Command) -> Result<Vec<u8>> {
    let mut text = Vec::new();
    let page = clap_mangen::Man::new(command.clone());
    page.render(&mut text)
        .map_err(|e| Error::io("manual".as_ref(), "write", e))?;
    Ok(text)
}

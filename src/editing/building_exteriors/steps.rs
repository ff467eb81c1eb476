//! The commands of houses.

use std::sync::Arc;

use super::super::script::Shell;
use super::super::work::Work;
use super::super::{Applied, CommandError, answer, count_of_answers};
use super::{
    House, Wishes, edit, given, shipped_database, shipped_model, text, variations, view, wished,
    words,
};
use edifice_base::{Error, Result};
use edifice_building_exteriors::house::Options;

/// Most answers at once.
const MOST: usize = 12;

impl House {
    pub(super) fn edit(&self, texts: &[String], suggest: bool, seed: u64) -> Result<Applied> {
        let edits = text::parse_all(texts)?;
        let database = shipped_database()?;
        let learned = match suggest {
            true => Some(shipped_model()?),
            false => None,
        };
        let made = edit(
            &self.building,
            &edits,
            learned,
            database,
            &Options::default(),
            seed,
        );
        let made = made.map_err(Error::method)?;
        let locked = view::touched(&self.building, &edits, &made.building);
        let mut shell = Shell::new(["building", "edit", "<"]);
        for word in words(&edits) {
            shell = shell.arg(word);
        }
        if suggest {
            shell = shell.arg("--suggest");
        }
        let shell = in_folder(shell, seed).gives("", Some(self.file()));
        let mut said = texts.join(", ");
        if suggest {
            said.push_str(", the rest suggested");
        }
        Ok(Applied {
            state: Arc::new(self.made(made, locked)),
            said,
            shell,
            warnings: Vec::new(),
        })
    }

    pub(super) fn variations(&self, count: usize, seed: u64) -> Result<Applied> {
        let count = count_of_answers(count, MOST)?;
        let options = Options::default();
        let answers = variations(&self.building, count, shipped_database()?, &options, seed);
        let answers = answers.map_err(Error::method)?;
        let found = answers.len();
        let mut warnings = Vec::new();
        if found < count {
            warnings.push(format!(
                "{found} of {count} houses: the search found no more"
            ));
        }
        let shell = Shell::new(["building", "variations", "<"]).option("--count", count);
        Ok(Applied {
            state: Arc::new(Self {
                answers,
                chosen: None,
                ..self.clone()
            }),
            said: format!("{found} other plans with the same attributes"),
            shell: in_folder(shell, seed),
            warnings,
        })
    }

    pub(super) fn wish(
        &self,
        texts: Vec<String>,
        style: Option<usize>,
        keep: bool,
        seed: u64,
        work: &Work,
    ) -> Result<Applied> {
        // A style says of all columns what they are.
        let keep = keep && style.is_none();
        let wishes = Wishes {
            given: given(&texts)?,
            style,
            keep,
        };
        if texts.is_empty() && style.is_none() {
            return Err(CommandError::Nothing.into());
        }
        let known = (shipped_model()?, shipped_database()?);
        let options = Options::default();
        let made =
            wished(&self.building, &wishes, known, &options, seed, work).map_err(Error::method)?;
        let mut shell = Shell::new(["building", "wish", "<"]);
        for text in &texts {
            shell = shell.option("--given", text);
        }
        if let Some(style) = style {
            shell = shell.option("--style", style);
        }
        if keep {
            shell = shell.arg("--keep");
        }
        let mut said = style.map_or(String::new(), |s| format!("style {s} "));
        said.push_str(&texts.join(", "));
        let boxes = made.building.boxes.len();
        Ok(Applied {
            state: Arc::new(Self {
                wishes: texts,
                style,
                keep,
                ..self.made(made, vec![false; boxes])
            }),
            said: format!("wish {}", said.trim_end()),
            shell: in_folder(shell, seed).gives("", Some(self.file())),
            warnings: Vec::new(),
        })
    }

    pub(super) fn choose(&self, wanted: usize) -> Result<Applied> {
        let chosen = answer(&self.answers, wanted)?.clone();
        let state = Self {
            answers: self.answers.clone(),
            chosen: Some(wanted),
            ..self.made(chosen.clone(), vec![false; chosen.building.boxes.len()])
        };
        Ok(Applied {
            shell: Shell::default().gives("", Some(state.file())),
            state: Arc::new(state),
            said: format!("take plan {wanted}"),
            warnings: Vec::new(),
        })
    }
}

/// The options that all commands that make houses share.
fn in_folder(shell: Shell, seed: u64) -> Shell {
    let shell = shell.option("--seed", seed).option("--format", "json");
    let output = Shell::new(["--output", ">"]).words;
    Shell {
        words: [shell.words, output].concat(),
        ..shell
    }
}

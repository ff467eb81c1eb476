//! The options that the user wrote, apart from those that have their default.

use std::collections::BTreeSet;

use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches};
use edifice_base::{Error, Result};

/// The options written on the command line. It is the first field of what it is flattened into, as later fields find the
/// options before them gone.
pub(crate) struct Given(BTreeSet<String>);

impl Given {
    /// Refuses the first of some options (by the names of their fields) that was written.
    ///
    /// # Errors
    /// [`Error::Option`] with `reason`.
    pub(crate) fn refuse(&self, options: &[&str], reason: &str) -> Result<()> {
        match options.iter().find(|name| self.0.contains(**name)) {
            Some(name) => Err(Error::option(
                format!("--{}", name.replace('_', "-")),
                reason,
            )),
            None => Ok(()),
        }
    }
}

impl FromArgMatches for Given {
    fn from_arg_matches(matches: &ArgMatches) -> std::result::Result<Self, clap::Error> {
        let ids = matches.ids().map(clap::Id::as_str);
        let written = |id: &&str| matches.value_source(id) == Some(ValueSource::CommandLine);
        Ok(Self(ids.filter(written).map(str::to_owned).collect()))
    }

    fn update_from_arg_matches(
        &mut self,
        matches: &ArgMatches,
    ) -> std::result::Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for Given {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}

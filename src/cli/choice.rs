//! Options whose value is one of a few names.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

/// A name, its line in the help, and the value that it stands for. A name with an empty line is read but not listed: an older
/// name of the same value.
pub(crate) type Choice<T> = (&'static str, &'static str, T);

/// Reads one of the names; the help of the option lists them.
pub(crate) fn one_of<T>(choices: &'static [Choice<T>]) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let names = choices.iter().map(|(name, help, _)| {
        let value = PossibleValue::new(*name);
        match help.is_empty() {
            true => value.hide(true),
            false => value.help(*help),
        }
    });
    PossibleValuesParser::new(names).try_map(move |name| {
        let found = choices.iter().find(|choice| choice.0 == name);
        found.map(|choice| choice.2).ok_or("no such name")
    })
}

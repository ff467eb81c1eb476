//! Facades one by one, each with rules of its own.

use super::codec::{Tables, walk};
use super::coder::Counter;
use super::error::LibraryError;
use super::library::{Code, Library, no_code};
use super::rules::Rules;
use edifice_shape::Facade;

/// A code for single facades: everything that a facade has is spelled out, its rules, counts and sizes. Equal, repeated,
/// mirrored and aligned sizes within a facade are cheap here too.
#[derive(Debug, Clone)]
pub struct Separate(Library);

impl Separate {
    /// A code that knows nothing, not even labels. Lengths are multiples of `step`.
    pub fn new(unit: String, step: f64) -> Self {
        Self(Library::empty(
            unit,
            step,
            Rules::default(),
            Tables::default(),
        ))
    }

    /// A code that has learnt from the facades of a library which labels there are, how wide and high facades are, and how
    /// far each predictor within one facade is to be trusted; none of their rules, counts or sizes of parts.
    ///
    /// # Errors
    /// [`LibraryError::Invalid`] for a member that has no code.
    pub fn of(library: &Library) -> Result<Self, LibraryError> {
        let mut labels = Rules::default();
        for label in library.rules().labels() {
            labels.label(label);
        }
        let mut tables = Tables::default();
        let (mut trust, mut count_trust) = Default::default();
        for member in library.members() {
            for (table, &extent) in tables.extents.iter_mut().zip(&member.parse.extent) {
                table.change(extent, true);
            }
            let known = Some((&member.parse, library.rules()));
            let mut rules = labels.clone();
            let learnt = (&mut trust, &mut count_trust);
            walk(&mut Counter::default(), &tables, learnt, &mut rules, known)
                .ok_or_else(|| no_code(&member.name))?;
        }
        tables.trust = trust;
        tables.count_trust = count_trust;
        let unit = library.unit().to_owned();
        Ok(Self(Library::empty(unit, library.step(), labels, tables)))
    }

    /// The code of a facade.
    ///
    /// # Errors
    /// As [`Library::encode`].
    pub fn encode(&self, facade: &Facade) -> Result<Code, LibraryError> {
        self.0.encode(facade)
    }

    /// Reads a code back.
    ///
    /// # Errors
    /// As [`Library::decode`].
    pub fn decode(&self, code: &[u8], name: &str) -> Result<Facade, LibraryError> {
        self.0.decode(code, name)
    }
}

//! A library: the rules of many facades, with the distributions of their parameters.

use rand::Rng;

use super::bodies::Bodies;
use super::codec::{Tables, walk};
use super::coder::{Coder, Counter, Decoder, Drawer, Encoder};
use super::error::LibraryError;
use super::phrases::{self, Sharing};
use super::rules::Rules;
use super::sizes::SizeModel;
use super::step::step;
use super::tree::{self, Parse};
use crate::Costs;
use edifice_shape::Facade;

/// A facade that the library was made from.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Its name.
    pub name: String,
    /// Its root, extents, counts and sizes.
    pub parse: Parse,
}

/// Rules without sizes and counts that many facades share, and what they chose for both.
#[derive(Debug, Clone)]
pub struct Library {
    unit: String,
    step: f64,
    rules: Rules,
    members: Vec<Member>,
    tables: Tables,
    told_by_others: Vec<f64>,
}

/// A facade written with a library: a program that has the library reads it back, region for region.
#[derive(Debug, Clone, PartialEq)]
pub struct Code {
    /// The code in whole bytes.
    pub bytes: Vec<u8>,
    /// Bits of the choices.
    pub bits: f64,
}

impl Library {
    /// The library of some facades: tilings of one unit that full lines split. Lengths are multiples of the
    /// largest of 1, 0.5, 0.1, ... 0.001 units that fits all of them.
    ///
    /// # Errors
    /// [`LibraryError`] for no facades, different units, or a facade that has no code.
    pub fn learn(facades: &[Facade]) -> Result<Self, LibraryError> {
        let step = step(facades)?;
        Self::learn_with_step(facades, step)
    }

    /// As [`Library::learn`], with a given step.
    ///
    /// # Errors
    /// As [`Library::learn`].
    pub fn learn_with_step(facades: &[Facade], step: f64) -> Result<Self, LibraryError> {
        let first = facades.first().ok_or(LibraryError::NoFacades)?;
        let mut rules = Rules::default();
        let mut members = Vec::with_capacity(facades.len());
        for facade in facades {
            same_unit(facade, &first.unit)?;
            let parse = tree::parse(facade, step, &mut rules)?;
            members.push(Member {
                name: facade.name.clone(),
                parse,
            });
        }
        Self::from_members(first.unit.clone(), step, rules, members)
    }

    /// The library of facades that are parsed already.
    ///
    /// # Errors
    /// [`LibraryError::NoFacades`], and [`LibraryError::Invalid`] for parameters that do not fit the rules.
    pub fn from_members(
        unit: String,
        step: f64,
        rules: Rules,
        members: Vec<Member>,
    ) -> Result<Self, LibraryError> {
        Self::from_members_with(unit, step, rules, members, SizeModel::default())
    }

    /// As [`Library::from_members`], with another model of sizes.
    ///
    /// # Errors
    /// As [`Library::from_members`].
    pub fn from_members_with(
        unit: String,
        step: f64,
        rules: Rules,
        members: Vec<Member>,
        sizes: SizeModel,
    ) -> Result<Self, LibraryError> {
        if members.is_empty() {
            return Err(LibraryError::NoFacades);
        }
        for member in &members {
            tree::unfold(&member.parse, rules.rules(), |_, _, _| {})?;
        }
        let mut library = Self {
            unit,
            step,
            rules,
            members,
            tables: Tables::default(),
            told_by_others: Vec::new(),
        };
        library.tables.sizes.model = sizes;
        library.fit()?;
        Ok(library)
    }

    /// A library of no facades, as [`Separate`](super::Separate) codes with.
    pub(super) fn empty(unit: String, step: f64, rules: Rules, tables: Tables) -> Self {
        Self {
            unit,
            step,
            rules,
            members: Vec::new(),
            tables,
            told_by_others: Vec::new(),
        }
    }

    /// Fills the tables, and learns which predictors to trust: each facade is told by all others.
    fn fit(&mut self) -> Result<(), LibraryError> {
        for rule in self.rules.rules() {
            self.tables.structure.add_rule(rule);
        }
        for member in &self.members {
            self.tables.change(&member.parse, &self.rules, true);
        }
        let (mut trust, mut count_trust) = Default::default();
        for member in &self.members {
            self.tables.change(&member.parse, &self.rules, false);
            let known = Some((&member.parse, &self.rules));
            let mut rules = self.rules.clone();
            let mut counter = Counter::default();
            let walked = walk(
                &mut counter,
                &self.tables,
                (&mut trust, &mut count_trust),
                &mut rules,
                known,
            );
            self.tables.change(&member.parse, &self.rules, true);
            walked.ok_or_else(|| no_code(&member.name))?;
            self.told_by_others.push(counter.bits);
        }
        self.tables.trust = trust;
        self.tables.count_trust = count_trust;
        Ok(())
    }

    /// The unit of all lengths.
    pub fn unit(&self) -> &str {
        &self.unit
    }

    /// The length of which all lengths are multiples.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Labels and rules.
    pub fn rules(&self) -> &Rules {
        &self.rules
    }

    /// The facades that it was made from.
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// The tables of roots, counts and sizes.
    pub fn tables(&self) -> &Tables {
        &self.tables
    }

    /// Bits of each facade given the counts, sizes and roots of all others, while it is learnt whom to trust. The rules
    /// are known already: for facades that are not in the library, [`Library::bits`] is the honest number.
    pub fn told_by_others(&self) -> &[f64] {
        &self.told_by_others
    }

    /// The rules as Wu's cost counts them, with shared phrases and the bound on their choice.
    pub fn sharing(&self, costs: &Costs) -> Sharing {
        phrases::share(&Bodies::new(&self.rules), costs)
    }

    /// A facade that the library was made from, or one read or drawn.
    ///
    /// # Errors
    /// [`LibraryError::Invalid`] for parameters that do not fit the library's rules.
    pub fn facade(&self, parse: &Parse, name: &str) -> Result<Facade, LibraryError> {
        self.tiling(parse, &self.rules, name)
    }

    /// A facade with rules of its own after the library's.
    ///
    /// # Errors
    /// [`LibraryError::Invalid`] for parameters that do not fit the rules.
    pub fn tiling(&self, parse: &Parse, rules: &Rules, name: &str) -> Result<Facade, LibraryError> {
        let place = (name, self.unit.as_str());
        tree::facade(parse, rules.rules(), rules.labels(), self.step, place)
    }

    /// The code of a facade: structure, counts, sizes and extents, given the library.
    ///
    /// # Errors
    /// [`LibraryError`] for a facade of another unit, off the library's step, or that full lines do not split.
    pub fn encode(&self, facade: &Facade) -> Result<Code, LibraryError> {
        let (parse, rules) = self.parse(facade)?;
        self.encode_parse(&parse, &rules, &facade.name)
    }

    /// The code of a facade that some other parser split: rules of the library, and after them the facade's own.
    ///
    /// # Errors
    /// [`LibraryError::Invalid`] where there is no code.
    pub fn encode_parse(
        &self,
        parse: &Parse,
        rules: &Rules,
        name: &str,
    ) -> Result<Code, LibraryError> {
        let mut both = Both {
            counter: Counter::default(),
            coder: Encoder::default(),
        };
        self.walked(&mut both, Some((parse, rules)))
            .ok_or_else(|| no_code(name))?;
        Ok(Code {
            bytes: both.coder.finish(),
            bits: both.counter.bits,
        })
    }

    /// The bits that a facade costs given the library: the shorter, the more alike.
    ///
    /// # Errors
    /// As [`Library::encode`].
    pub fn bits(&self, facade: &Facade) -> Result<f64, LibraryError> {
        let (parse, rules) = self.parse(facade)?;
        let mut counter = Counter::default();
        self.walked(&mut counter, Some((&parse, &rules)))
            .ok_or_else(|| no_code(&facade.name))?;
        Ok(counter.bits)
    }

    fn walked<C: Coder>(
        &self,
        coder: &mut C,
        known: Option<(&Parse, &Rules)>,
    ) -> Option<(Parse, Rules)> {
        let mut rules = self.rules.clone();
        let (mut trust, mut count_trust) =
            (self.tables.trust.clone(), self.tables.count_trust.clone());
        let parse = walk(
            coder,
            &self.tables,
            (&mut trust, &mut count_trust),
            &mut rules,
            known,
        )?;
        Some((parse, rules))
    }

    /// Reads a code back.
    ///
    /// # Errors
    /// [`LibraryError::Invalid`] for bytes that are no code of this library.
    pub fn decode(&self, code: &[u8], name: &str) -> Result<Facade, LibraryError> {
        let (parse, rules) = self.decode_parse(code, name)?;
        self.tiling(&parse, &rules, name)
    }

    /// Reads the root, extents, counts and sizes of a code back, and the rules that they are about.
    ///
    /// # Errors
    /// As [`Library::decode`].
    pub fn decode_parse(&self, code: &[u8], name: &str) -> Result<(Parse, Rules), LibraryError> {
        self.walked(&mut Decoder::new(code), None)
            .ok_or_else(|| no_code(name))
    }

    /// Draws from the distribution of codes: a facade comes as often as its bits say.
    ///
    /// # Errors
    /// [`LibraryError::Invalid`] where what was drawn is larger than a code may be.
    pub fn draw_code<R: Rng>(&self, rng: &mut R, name: &str) -> Result<Facade, LibraryError> {
        let (parse, rules) = self
            .walked(&mut Drawer { rng }, None)
            .ok_or_else(|| no_code(name))?;
        self.tiling(&parse, &rules, name)
    }

    /// Root, extents, counts and sizes of a facade, and the rules that they are about: those of the library, and
    /// after them the facade's own.
    ///
    /// # Errors
    /// As [`Library::encode`].
    pub fn parse(&self, facade: &Facade) -> Result<(Parse, Rules), LibraryError> {
        same_unit(facade, &self.unit)?;
        let mut rules = self.rules.clone();
        let parse = tree::parse(facade, self.step, &mut rules)?;
        Ok((parse, rules))
    }

    /// True if the library has a facade with the structure of another: the same root.
    ///
    /// # Errors
    /// As [`Library::encode`].
    pub fn knows(&self, facade: &Facade) -> Result<bool, LibraryError> {
        let (parse, _) = self.parse(facade)?;
        Ok(self.tables.structure.roots().contains_key(&parse.root))
    }

    /// True if no facade of the library has the root and the counts of another one.
    ///
    /// # Errors
    /// As [`Library::encode`].
    pub fn is_new(&self, facade: &Facade) -> Result<bool, LibraryError> {
        let (parse, _) = self.parse(facade)?;
        let same = |member: &Member| {
            (member.parse.root, &member.parse.counts) == (parse.root, &parse.counts)
        };
        Ok(!self.members.iter().any(same))
    }
}

/// Counts the bits of what another coder does.
struct Both<C> {
    counter: Counter,
    coder: C,
}

impl<C: Coder> Coder for Both<C> {
    fn choose(&mut self, weights: &[f64], value: Option<usize>) -> Option<usize> {
        self.counter.choose(weights, value)?;
        self.coder.choose(weights, value)
    }
}

pub(super) fn no_code(name: &str) -> LibraryError {
    LibraryError::Invalid {
        place: name.to_owned(),
        message: "there is no such code of this library".to_owned(),
    }
}

fn same_unit(facade: &Facade, expected: &str) -> Result<(), LibraryError> {
    if facade.unit == expected {
        return Ok(());
    }
    Err(LibraryError::Unit {
        name: facade.name.clone(),
        unit: facade.unit.clone(),
        expected: expected.to_owned(),
    })
}

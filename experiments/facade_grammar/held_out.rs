//! Bits of facades that a library has not seen, beside those of rivals in the same code.

use edifice_base::{Error, Result};
use edifice_grammar::parametric::{Code, Library, Member, Parse, Separate, SizeModel};
use edifice_grammar::same_tiling;
use edifice_shape::Facade;

use edifice_frame::Parsed;
use edifice_peers as peers;

/// Bits of each held-out facade.
#[derive(Debug, Default)]
pub(crate) struct HeldOut {
    /// Given the library of the others.
    pub library: Vec<f64>,
    /// With rules of its own, labels and trust known.
    pub separate: Vec<f64>,
    /// Given procedural logic's rules of the others, in the library's code.
    pub logic: Vec<f64>,
    /// The same with a normal distribution for each parameter of a rule.
    pub logic_normal: Vec<f64>,
    /// Number of facades whose root the library has.
    pub known: usize,
}

impl HeldOut {
    /// Adds a fold: `told` is the library of `others`. Every code is read back and compared.
    ///
    /// # Errors
    /// Those of the methods, and for a code that does not give its facade back.
    pub(crate) fn add(
        &mut self,
        told: &Library,
        others: &[Facade],
        unseen: &[Facade],
    ) -> Result<()> {
        let separate = Separate::of(told).map_err(Error::method)?;
        for facade in unseen {
            let code = told.encode(facade).map_err(Error::method)?;
            let back = told.decode(&code.bytes, &facade.name);
            self.library
                .push(checked(facade, &code, back.map_err(Error::method)?)?);
            let code = separate.encode(facade).map_err(Error::method)?;
            let back = separate.decode(&code.bytes, &facade.name);
            self.separate
                .push(checked(facade, &code, back.map_err(Error::method)?)?);
            self.known += usize::from(told.knows(facade).map_err(Error::method)?);
        }
        let parsed = peers::parsed("procedural_logic", others, unseen, told.step())?;
        self.logic.extend(bits(told, &parsed, SizeModel::Shared)?);
        self.logic_normal
            .extend(bits(told, &parsed, SizeModel::Normal)?);
        Ok(())
    }
}

/// The bits of the other facades of a parser, given its rules of those that it learnt from.
fn bits(told: &Library, parsed: &Parsed, sizes: SizeModel) -> Result<Vec<f64>> {
    let member = |parse: &Parse| Member {
        name: "learnt".to_owned(),
        parse: parse.clone(),
    };
    let library = Library::from_members_with(
        told.unit().to_owned(),
        told.step(),
        parsed.rules.clone(),
        parsed.learnt.iter().map(member).collect(),
        sizes,
    );
    let library = library.map_err(Error::method)?;
    let bits = parsed.others.iter().map(|(parse, rules)| {
        let code = library
            .encode_parse(parse, rules, "held out")
            .map_err(Error::method)?;
        let facade = library.tiling(parse, rules, "held out");
        let back = library.decode(&code.bytes, "held out");
        checked(
            &facade.map_err(Error::method)?,
            &code,
            back.map_err(Error::method)?,
        )
    });
    bits.collect()
}

/// The bits of a code that gives its facade back.
fn checked(facade: &Facade, code: &Code, back: Facade) -> Result<f64> {
    match same_tiling(facade, &back) {
        true => Ok(code.bits),
        false => Err(Error::method(format!(
            "{}: the code does not give it back",
            facade.name
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_shape::{Rect, Region};

    /// Windows in a wall, all sizes the same.
    fn grid(columns: usize, rows: usize) -> Facade {
        let (width, height) = (9.0, 13.0);
        let mut regions = Vec::new();
        let mut add = |label: &str, x: f64, y: f64, w: f64, h: f64| {
            regions.push(Region {
                label: label.into(),
                rect: Rect::new(x, y, w, h),
            });
        };
        let across = width * (2 * columns + 1) as f64;
        for row in 0..=2 * rows {
            let y = height * row as f64;
            match row % 2 {
                0 => add("wall", 0.0, y, across, height),
                _ => (0..=2 * columns).for_each(|k| {
                    let label = ["wall", "window"][k % 2];
                    add(label, width * k as f64, y, width, height);
                }),
            }
        }
        let name = format!("{columns}x{rows}");
        Facade::new(name, "px", across, height * (2 * rows + 1) as f64, regions).unwrap()
    }

    #[test]
    fn grids_of_new_counts_are_short_for_a_library_and_come_back_from_every_code() {
        let others = [grid(3, 4), grid(5, 6), grid(4, 3), grid(6, 5)];
        let told = Library::learn_with_step(&others, 1.0).unwrap();
        let mut bits = HeldOut::default();
        bits.add(&told, &others, &[grid(7, 2), grid(2, 7)]).unwrap();
        assert_eq!(bits.known, 2);
        for k in 0..2 {
            let library = bits.library[k];
            assert!(library < bits.separate[k], "{bits:?}");
            assert!(library < bits.logic[k], "{bits:?}");
            assert!(bits.logic[k] < bits.logic_normal[k], "{bits:?}");
        }
    }
}

//! One placement: its symbol, turn, place and size.

use super::{MOST_PLACEMENTS, Near, Pose, Rules};
use crate::compact::error::CompactError;
use crate::compact::integers::{bits_of, plain};
use crate::compact::range_coder::Coder;
use crate::compact::rows::Footprint;
use crate::compact::steps::{SHARES, in_steps};
use edifice_grammar::instance::Placement;

impl<C: Coder> Rules<'_, C> {
    /// A placement without its parts, and with its numbers only under the axiom; with `shares`, its lengths are shares and levels.
    pub(super) fn placement(
        &mut self,
        near: Near,
        other: &Pose,
        given: Option<&Placement>,
        shares: bool,
    ) -> Result<(Placement, Pose), CompactError> {
        self.placements += 1;
        if self.placements > MOST_PLACEMENTS {
            return Err(CompactError::TooLarge("placements"));
        }
        if self.coder.exhausted() {
            return Err(CompactError::Truncated);
        }
        let unit = if shares { SHARES } else { self.steps.length };
        let own = match given {
            Some(given) => self.pose(given, unit)?,
            None => Pose::default(),
        };
        let usual = match near {
            Near::Like => self
                .coder
                .bit(&mut self.as_usual, own.symbol == other.symbol),
            // The next building often is of the same type.
            Near::Before if self.parametric => {
                let again = &mut self.again[usize::from(self.in_row)];
                self.coder.bit(again, own.symbol == other.symbol)
            }
            _ => false,
        };
        let symbol = match usual {
            true if other.symbol >= self.symbols.len() => {
                return Err(CompactError::Index("symbol"));
            }
            true => other.symbol,
            false => {
                let is_rule = own.symbol >= self.templates;
                let is_rule = self.coder.bit(&mut self.is_rule[near as usize], is_rule);
                self.number(is_rule, own.symbol)?
            }
        };
        let is_rule = symbol >= self.templates;
        let near_by = if self.in_row { 4 } else { near as usize };
        let context = near_by * 2 + usize::from(is_rule);
        let full = self.steps.turn * 360;
        let quarter = full / 4;
        let coder = &mut self.coder;
        let models = &mut self.models[context];
        // Quarter turns, then what is left, from -1/8 to 1/8 of a turn.
        let away = (own.turn - other.turn + quarter / 2).rem_euclid(full);
        let quarters = self.quarter[context].code(coder, (away / quarter) as usize) as i64;
        let rest = models
            .turn
            .code(coder, away - quarters * quarter - quarter / 2);
        let turn = (other
            .turn
            .wrapping_add(quarters * quarter)
            .wrapping_add(rest))
        .rem_euclid(full);
        let mut like = if shares { [SHARES; 3] } else { other.size };
        if quarters % 2 == 1 {
            like.swap(0, 1);
        }
        let mut at = other.at;
        if near == Near::Below {
            at[2] = at[2].wrapping_add(other.size[2]);
        }
        let symbols = self.symbols;
        let levels = match self.rows && near == Near::Before {
            true => self.levels_of.get(symbols[symbol].as_str()).copied(),
            false => None,
        };
        let numbers = match levels.filter(|&l| l > 0) {
            Some(levels) => self.numbers(&symbols[symbol], given, levels + 2)?,
            None => Vec::new(),
        };
        let mut plan = [0; 2];
        let mut told = 0;
        if let [w, d, ..] = numbers[..] {
            plan = [in_steps(w, unit)?, in_steps(d, unit)?];
            let neighbour = Footprint {
                at: [own.at[0], own.at[1]],
                turn,
                size: plan,
            };
            let (place, rest) = other.footprint().told(&neighbour, full);
            let place = self.beside[usize::from(self.in_row)].code(&mut self.coder, place);
            let models = self.rest[usize::from(self.in_row)]
                .get_mut(place)
                .ok_or(CompactError::Index("place"))?;
            let rest = [0, 1].map(|k| models[k].code(&mut self.coder, rest[k]));
            let found = other.footprint().found(&neighbour, place, rest, full);
            (at[0], at[1], told) = (found[0], found[1], 2);
        }
        let coder = &mut self.coder;
        let models = &mut self.models[context];
        for (axis, at) in at.iter_mut().enumerate().skip(told) {
            let away = own.at[axis].wrapping_sub(*at);
            *at = at.wrapping_add(models.at[axis].code(coder, away));
        }
        let mut size = [0; 3];
        let mut factor = 1.0;
        let below = matches!(near, Near::Below | Near::Like) && other.symbol < self.templates;
        let stands = below || shares;
        if is_rule {
            let given = given.map_or(1.0, |g| g.size[0]);
            if !coder.bit(&mut models.factor, given == 1.0) {
                factor = plain(coder, given);
            }
        } else if stands {
            for axis in 0..3 {
                // The height of what stands on a part says nothing of its own.
                let like = if near == Near::Below && axis == 2 && !shares {
                    0
                } else {
                    like[axis]
                };
                let change = models.change[axis].code(coder, own.size[axis].wrapping_sub(like));
                size[axis] = like.wrapping_add(change);
            }
        } else {
            size[0] = models.size[0].code(coder, own.size[0] as u64) as i64;
            let depth = models.depth.entry(bits_of(size[0] as u64)).or_default();
            size[1] = depth.code(coder, own.size[1] as u64) as i64;
            size[2] = models.size[1].code(coder, own.size[2] as u64) as i64;
        }
        let pose = Pose {
            symbol,
            at,
            turn,
            size,
            plan,
        };
        let id = given.and_then(|g| g.id.as_ref());
        let id = self.identities.id(coder, id)?;
        let attributes = given.map(|g| &g.attributes);
        let attributes = self.identities.attributes(coder, attributes)?;
        let length = |v: i64| v as f64 / unit as f64;
        let placed = Placement {
            symbol: self.symbols[symbol].clone(),
            at: at.map(length),
            turn: turn as f64 / self.steps.turn as f64,
            size: if is_rule {
                [factor; 3]
            } else {
                size.map(length)
            },
            id,
            attributes,
            parts: Vec::new(),
            numbers,
        };
        Ok((placed, pose))
    }

    /// A placement in steps, `unit` of them in a length of 1.
    pub(super) fn pose(&self, placed: &Placement, unit: i64) -> Result<Pose, CompactError> {
        let symbol = self.numbers.get(placed.symbol.as_str()).copied();
        let symbol = symbol.ok_or(CompactError::Index("symbol"))?;
        let length = |v: f64| in_steps(v, unit);
        let [x, y, z] = placed.at;
        let [w, d, h] = match symbol < self.templates {
            true => placed.size,
            false => [0.0; 3],
        };
        let turn = in_steps(placed.turn, self.steps.turn)?;
        let mut size = [length(w)?, length(d)?, length(h)?];
        if symbol < self.templates {
            size = size.map(|v| v.max(1));
        }
        Ok(Pose {
            symbol,
            at: [length(x)?, length(y)?, length(z)?],
            turn: turn.rem_euclid(360 * self.steps.turn),
            size,
            plan: [0; 2],
        })
    }
}

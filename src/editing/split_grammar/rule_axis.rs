//! The sizes that a rule writes along one axis: those of its parts, or of the columns or rows of a grid.

use super::error::GrammarEditError;
use super::place::Place;
use edifice_grammar::{Grammar, Operation, Size, Successor};
use edifice_shape::Axis;

/// The sizes that an operation writes along an axis; none where it does not split along it.
pub(super) fn along(operation: &Operation, axis: Axis) -> Vec<Size> {
    let mut copy = operation.clone();
    along_mut(&mut copy, axis).into_iter().map(|s| *s).collect()
}

/// The sizes that an operation writes along an axis, to be changed.
pub(super) fn along_mut(operation: &mut Operation, axis: Axis) -> Vec<&mut Size> {
    match operation {
        Operation::Split {
            axis: own,
            successors,
        }
        | Operation::Repeat {
            axis: own,
            successors,
        }
        | Operation::SymSplit {
            axis: own,
            successors,
            ..
        } if *own == axis => successors.iter_mut().map(|s| &mut s.size).collect(),
        Operation::RepeatAba { axis: own, a, b } if *own == axis => vec![&mut a.size, &mut b.size],
        Operation::GridSplit { columns, rows, .. } => match axis {
            Axis::X => columns.iter_mut().collect(),
            Axis::Y => rows.iter_mut().collect(),
        },
        _ => Vec::new(),
    }
}

/// Which of the sizes along an axis a successor has, counted as in [`Operation::symbols`].
pub(super) fn index_along(operation: &Operation, axis: Axis, successor: usize) -> usize {
    match (operation, axis) {
        (Operation::GridSplit { columns, .. }, Axis::X) => successor % columns.len().max(1),
        (Operation::GridSplit { columns, .. }, Axis::Y) => successor / columns.len().max(1),
        _ => successor,
    }
}

/// The number of times that the size of an index stands in a region with this number of periods.
pub(super) fn times(operation: &Operation, index: usize, periods: usize) -> f64 {
    let count = match operation {
        Operation::Split { .. } | Operation::GridSplit { .. } => 1,
        Operation::Repeat { .. } => periods,
        Operation::RepeatAba { .. } => periods + usize::from(index == 0),
        Operation::SymSplit {
            successors, center, ..
        } => match *center && index + 1 == successors.len() {
            true => 1,
            false => 2,
        },
    };
    count as f64
}

/// Sums of the absolute and of the relative sizes along an axis, in a region with this number of periods.
pub(super) fn totals(operation: &Operation, axis: Axis, periods: usize) -> [f64; 2] {
    let mut sums = [0.0, 0.0];
    for (k, size) in along(operation, axis).iter().enumerate() {
        let relative = usize::from(matches!(size, Size::Relative(_)));
        sums[relative] += times(operation, k, periods) * size.value();
    }
    sums
}

/// True if an operation puts as many periods as fit.
pub(super) fn repeats(operation: &Operation) -> bool {
    matches!(
        operation,
        Operation::Repeat { .. } | Operation::RepeatAba { .. }
    )
}

/// One axis of a rule, along which its sizes are read and changed.
pub(super) struct RuleAxis<'g> {
    rule: usize,
    place: Place,
    /// Across or up.
    pub(super) axis: Axis,
    pub(super) operation: &'g mut Operation,
}

impl<'g> RuleAxis<'g> {
    /// The axis on which a place of the rule lies.
    ///
    /// # Errors
    /// When there is no such rule, axis or place.
    pub(super) fn of(
        grammar: &'g mut Grammar,
        rule: usize,
        place: Place,
    ) -> Result<Self, GrammarEditError> {
        super::error::known(grammar, rule)?;
        let operation = &mut grammar.rules[rule].operation;
        let axis = match (&*operation, place) {
            (Operation::GridSplit { .. }, Place::Column(_)) => Ok(Axis::X),
            (Operation::GridSplit { .. }, Place::Row(_)) => Ok(Axis::Y),
            (Operation::GridSplit { .. }, Place::Part(_)) => {
                Err("name a column (c0) or a row (r0) of the grid")
            }
            (_, Place::Column(_) | Place::Row(_)) => {
                Err("only a grid has columns and rows; parts are named by a number")
            }
            (Operation::Split { axis, .. }, _)
            | (Operation::Repeat { axis, .. }, _)
            | (Operation::RepeatAba { axis, .. }, _)
            | (Operation::SymSplit { axis, .. }, _) => Ok(*axis),
        };
        let axis = axis.map_err(|hint| unfit(rule, operation, hint))?;
        let count = along(operation, axis).len();
        let part = place;
        match place.index() < count {
            true => Ok(Self {
                rule,
                place,
                axis,
                operation,
            }),
            false => Err(GrammarEditError::NoPart { rule, part, count }),
        }
    }

    pub(super) fn sizes(&self) -> Vec<f64> {
        let sizes = along(self.operation, self.axis);
        sizes.into_iter().map(Size::value).collect()
    }

    pub(super) fn error(&self, index: usize, size: f64, room: f64) -> GrammarEditError {
        GrammarEditError::Size {
            rule: self.rule,
            part: self.place.at(index),
            size,
            room,
        }
    }

    pub(super) fn set(&mut self, index: usize, size: f64) -> Result<(), GrammarEditError> {
        if !(size.is_finite() && size > 0.0) {
            return Err(self.error(index, size, self.sizes().iter().sum()));
        }
        self.change(index, |_| size);
        Ok(())
    }

    /// Another number for a size, of the same kind.
    pub(super) fn change(&mut self, index: usize, to: impl Fn(f64) -> f64) {
        if let Some(own) = along_mut(self.operation, self.axis).into_iter().nth(index) {
            match own {
                Size::Absolute(v) | Size::Relative(v) => *v = to(*v),
            }
        }
    }

    /// The number of times that an entry stands where the entries fill the region once.
    pub(super) fn times(&self, index: usize) -> f64 {
        times(self.operation, index, 1)
    }

    /// The sum of all entries, each as often as it stands.
    pub(super) fn total(&self) -> f64 {
        totals(self.operation, self.axis, 1).iter().sum()
    }

    /// Scales all entries but one so that together they take `more` than before, where they fill a region.
    pub(super) fn give_way(
        &mut self,
        but: Option<usize>,
        more: f64,
    ) -> Result<(), GrammarEditError> {
        if repeats(self.operation) {
            return Ok(());
        }
        let sizes = self.sizes();
        let others = (0..sizes.len()).filter(|k| Some(*k) != but);
        let now: f64 = { others.clone() }.map(|k| self.times(k) * sizes[k]).sum();
        let factor = (now + more) / now;
        if !(factor.is_finite() && factor > 0.0) {
            let index = but.unwrap_or(0);
            return Err(self.error(index, sizes[index], now));
        }
        for k in others {
            self.change(k, |v| v * factor);
        }
        Ok(())
    }

    /// A new entry before the one of this index: of this symbol, or a copy of that one. In a grid all cells of the new column
    /// or row.
    ///
    /// # Errors
    /// In a repeat A B A, which always has two parts.
    pub(super) fn insert(
        &mut self,
        index: usize,
        name: Option<&str>,
        size: f64,
    ) -> Result<(), GrammarEditError> {
        let kind = along(self.operation, self.axis).get(index).copied();
        let size = match kind.filter(|_| name.is_none()) {
            Some(Size::Absolute(_)) => Size::Absolute(size),
            _ => Size::Relative(size),
        };
        let named = |own: Option<&String>| name.map(str::to_owned).or(own.cloned());
        let missing = GrammarEditError::NoPart {
            rule: self.rule,
            part: self.place.at(index),
            count: self.sizes().len(),
        };
        match (&mut *self.operation, self.axis) {
            (Operation::Split { successors, .. }, _)
            | (Operation::Repeat { successors, .. }, _)
            | (Operation::SymSplit { successors, .. }, _) => {
                let own = successors.get(index).map(|s| &s.symbol);
                let symbol = named(own).ok_or(missing)?;
                successors.insert(index, Successor { symbol, size });
            }
            (Operation::RepeatAba { .. }, _) => return Err(self.always_two()),
            (Operation::GridSplit { columns, cells, .. }, Axis::X) => {
                columns.insert(index, size);
                for row in cells {
                    let symbol = named(row.get(index)).ok_or_else(|| missing.clone())?;
                    row.insert(index, symbol);
                }
            }
            (
                Operation::GridSplit {
                    columns,
                    rows,
                    cells,
                },
                Axis::Y,
            ) => {
                let own = cells.get(index).cloned();
                let row = name.map(|n| vec![n.to_owned(); columns.len()]).or(own);
                cells.insert(index, row.ok_or(missing)?);
                rows.insert(index, size);
            }
        }
        Ok(())
    }

    /// Takes an entry out.
    ///
    /// # Errors
    /// Of the last one, and in a repeat A B A.
    pub(super) fn remove(&mut self, index: usize) -> Result<(), GrammarEditError> {
        if along(self.operation, self.axis).len() == 1 {
            return Err(self.error(index, 0.0, 0.0));
        }
        match (&mut *self.operation, self.axis) {
            (Operation::Split { successors, .. }, _)
            | (Operation::Repeat { successors, .. }, _)
            | (Operation::SymSplit { successors, .. }, _) => drop(successors.remove(index)),
            (Operation::RepeatAba { .. }, _) => return Err(self.always_two()),
            (Operation::GridSplit { columns, cells, .. }, Axis::X) => {
                columns.remove(index);
                for row in cells {
                    row.remove(index);
                }
            }
            (Operation::GridSplit { rows, cells, .. }, Axis::Y) => {
                rows.remove(index);
                cells.remove(index);
            }
        }
        Ok(())
    }

    fn always_two(&self) -> GrammarEditError {
        let hint =
            "a repeat A B A always has two parts; resize them, or grow and shrink it by a period";
        unfit(self.rule, self.operation, hint)
    }
}

pub(super) fn unfit(rule: usize, operation: &Operation, hint: &'static str) -> GrammarEditError {
    GrammarEditError::Operation {
        rule,
        operation: operation.name(),
        hint,
    }
}

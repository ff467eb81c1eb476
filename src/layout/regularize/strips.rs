//! The areas along the strips between neighbouring cut lines of the other axis.

/// A stretch of one area along a strip, between cut lines `from` and `to`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Run {
    /// Background and odd shapes are served after elements.
    pub behind: bool,
    /// Label number; only runs of one label become equal.
    pub label: u16,
    /// Cut line at its start.
    pub from: usize,
    /// Cut line at its end.
    pub to: usize,
    /// Thickness of the strips with this run, summed.
    pub weight: f64,
}

/// The areas of all cells, strip by strip.
#[derive(Clone, Copy)]
pub(super) struct Strips<'a> {
    /// Area of each cell.
    pub cells: &'a [u32],
    /// True for each cell that may vanish although its area does not continue beside it.
    pub yields: &'a [bool],
    /// Cells in a strip.
    pub length: usize,
    /// Label number of each area.
    pub labels: &'a [u16],
}

impl<'a> Strips<'a> {
    /// The strips.
    pub(super) fn rows(self) -> impl Iterator<Item = &'a [u32]> {
        self.cells.chunks_exact(self.length)
    }

    /// True if the cells between lines `first` and `last` can vanish: in each strip they continue the area before them,
    /// then the area behind them; a `narrow` stretch between the two may vanish when all of it yields and no two areas
    /// of one label come to touch.
    pub(super) fn can_vanish(
        self,
        first: usize,
        last: usize,
        narrow: impl Fn(usize, usize) -> bool,
    ) -> bool {
        let yields = self.yields.chunks_exact(self.length);
        self.rows().zip(yields).all(|(row, yields)| {
            let before = first.checked_sub(1).map(|k| row[k]);
            let behind = row.get(last).copied();
            let from = (first..last)
                .find(|&k| Some(row[k]) != before)
                .unwrap_or(last);
            let to = (from..last)
                .rev()
                .find(|&k| Some(row[k]) != behind)
                .map_or(from, |k| k + 1);
            let label = |area: u32| self.labels[area as usize];
            let touch = |(a, b): (u32, u32)| a != b && label(a) == label(b);
            from == to
                || narrow(from, to)
                    && yields[from..to].iter().all(|&y| y)
                    && !before.zip(behind).is_some_and(touch)
        })
    }
}

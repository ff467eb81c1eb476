//! Storeys from the rows of marked windows.

use super::facades_error::FacadesError;
use super::marked::Mark;

/// Usual heights of a storey, and the most usual one (m).
const USUAL: [f64; 2] = [2.1, 4.6];
const COMMON: f64 = 2.8;
/// Least and greatest height of a storey (m): beyond it a house is at fault.
const SOUND: [f64; 2] = [1.8, 8.0];
/// Most storeys that the attributes describe (Appendix A.1).
const MOST: usize = 3;
/// A line between storeys lies within this share of a storey's height of where equal storeys have it.
const SHIFT: f64 = 0.095;
/// A piece of wall is at most this many storeys high.
pub(super) const TALLEST: f64 = 1.5;
/// Windows whose middles are nearer than this are in one row, and lower ones count for none (m).
const ROW: f64 = 0.9;
const LOW: f64 = 0.5;
/// Lengths nearer than this are the same (m).
const SAME: f64 = 1e-3;

/// The storeys of a house.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Storeys {
    /// Height of a storey, all alike, in metres.
    pub height: f64,
    /// The lower line of each storey over the ground, in metres, where no mark crosses it if that can be.
    pub lines: Vec<f64>,
    /// The eaves (m).
    pub eaves: f64,
}

impl Storeys {
    /// The storeys of a house with these eaves (m): of one to three equally high ones the number that cuts the fewest marks,
    /// then that of the rows of windows, then that of the most usual height.
    ///
    /// # Errors
    /// [`FacadesError::Eaves`] for eaves too low or too high for a house, [`FacadesError::Rows`] for more than three rows.
    pub(super) fn new(marks: &[Mark], eaves: f64) -> Result<Self, FacadesError> {
        let within = |range: [f64; 2], n: usize| {
            let height = eaves / n as f64;
            range[0] - SAME <= height && height <= range[1] + SAME
        };
        let rows = rows(marks);
        let usual: Vec<usize> = (1..=MOST).filter(|n| within(USUAL, *n)).collect();
        let sound = || (1..=MOST).filter(|n| within(SOUND, *n)).collect();
        let numbers: Vec<usize> = if usual.is_empty() { sound() } else { usual };
        if rows > MOST && within(USUAL, rows) {
            return Err(FacadesError::Rows { rows, eaves });
        }
        let storeys = numbers.into_iter().map(|n| Self::of(marks, eaves, n));
        let rank = |s: &Self| {
            let n = s.lines.len();
            (s.cut(marks), n.abs_diff(rows), (s.height - COMMON).abs())
        };
        let best = storeys.min_by(|a, b| {
            let (p, q) = (rank(a), rank(b));
            (p.0, p.1).cmp(&(q.0, q.1)).then(p.2.total_cmp(&q.2))
        });
        best.ok_or(FacadesError::Eaves {
            eaves,
            lowest: SOUND[0],
            highest: SOUND[1] * MOST as f64,
        })
    }

    /// `n` storeys with their lines where they cross the fewest marks.
    fn of(marks: &[Mark], eaves: f64, n: usize) -> Self {
        let height = eaves / n as f64;
        let mut lines = vec![0.0];
        for k in 1..n {
            let usual = k as f64 * height;
            let ends = marks.iter().flat_map(|m| [m.rect.y, m.rect.top()]);
            let near = ends.filter(|z| (z - usual).abs() <= SHIFT * height);
            let crossed = |z: f64| {
                let over = |m: &&Mark| m.rect.y + SAME < z && z < m.rect.top() - SAME;
                marks.iter().filter(over).count()
            };
            let best = near.chain([usual]).min_by(|a, b| {
                let far = |z: f64| (z - usual).abs();
                crossed(*a)
                    .cmp(&crossed(*b))
                    .then(far(*a).total_cmp(&far(*b)))
            });
            lines.push(best.unwrap_or(usual));
        }
        Self {
            height,
            lines,
            eaves,
        }
    }

    /// The storey in which a height over the ground is (m).
    pub(super) fn at(&self, z: f64) -> usize {
        let below = self.lines.iter().filter(|line| **line <= z + SAME);
        below.count().saturating_sub(1)
    }

    /// The upper line of a storey (m).
    pub(super) fn top(&self, storey: usize) -> f64 {
        self.lines.get(storey + 1).copied().unwrap_or(self.eaves)
    }

    /// True if a mark is in one storey, or reaches no further into the next than a piece of wall may.
    pub(super) fn holds(&self, mark: &Mark) -> bool {
        let line = self.lines[self.at(mark.rect.y)];
        mark.rect.top() <= self.eaves + SAME && mark.rect.top() - line <= TALLEST * self.height
    }

    /// Number of marks that reach over a line between storeys.
    fn cut(&self, marks: &[Mark]) -> usize {
        let over = |m: &&Mark| m.rect.top() > self.top(self.at(m.rect.y)) + SAME;
        marks.iter().filter(over).count()
    }
}

/// Number of rows of windows, at least 1.
fn rows(marks: &[Mark]) -> usize {
    let windows = marks
        .iter()
        .filter(|m| !m.is_door() && m.rect.height >= LOW);
    let mut middles: Vec<f64> = windows.map(|m| m.rect.y + m.rect.height / 2.0).collect();
    middles.sort_by(f64::total_cmp);
    let mut rows: Vec<f64> = Vec::new();
    for z in middles {
        match rows.last() {
            Some(first) if z - first < ROW => {}
            _ => rows.push(z),
        }
    }
    rows.len().max(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_shape::{Rect, Side};

    fn window(y: f64, height: f64) -> Mark {
        Mark {
            side: Side::Front,
            regions: vec![0],
            style: None,
            rect: Rect::new(1.0, y, 1.0, height),
        }
    }

    #[test]
    fn lines_lie_between_rows() {
        let two = [window(0.9, 1.3), window(3.3, 1.3)];
        let storeys = Storeys::new(&two, 5.2).unwrap();
        assert_eq!(storeys.lines, [0.0, 2.6]);
        // The upper row begins below the middle of the wall.
        let low = [window(0.9, 1.3), window(2.5, 1.3)];
        assert_eq!(Storeys::new(&low, 5.2).unwrap().lines, [0.0, 2.5]);
        // One row on a low wall, and a high hall of one row.
        assert_eq!(Storeys::new(&two[..1], 2.9).unwrap().lines.len(), 1);
        assert_eq!(Storeys::new(&two[..1], 4.4).unwrap().lines.len(), 1);
        let tall = [window(0.5, 4.0)];
        assert_eq!(Storeys::new(&tall, 5.2).unwrap().lines.len(), 2);
    }

    #[test]
    fn what_is_no_house_is_said() {
        let four: Vec<Mark> = (0..4).map(|k| window(0.9 + 2.7 * k as f64, 1.2)).collect();
        let rows = Storeys::new(&four, 10.8).unwrap_err();
        assert!(matches!(rows, FacadesError::Rows { rows: 4, .. }));
        for eaves in [1.0, 30.0] {
            let low = Storeys::new(&four[..1], eaves).unwrap_err();
            assert!(matches!(low, FacadesError::Eaves { .. }));
        }
    }
}

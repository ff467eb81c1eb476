//! Tests that a plan can be built: in one piece, without courtyards, nowhere too thin.

use super::PlanUnion;

/// The properties of a plan that decide if it can be built.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Soundness {
    /// Parts that share no stretch of boundary.
    pub parts: usize,
    /// True if a part of the outside is enclosed.
    pub courtyard: bool,
    /// Places where the plan meets itself in a point only.
    pub pinches: usize,
    /// Least extent of the inside along x or y, between two walls that face away from each other.
    pub thickness: f64,
    /// Least extent of the outside between two walls that face each other.
    pub gap: f64,
}

impl PlanUnion {
    /// Measures the plan; the empty plan has no parts and infinite extents.
    pub fn soundness(&self) -> Soundness {
        let (thickness, gap) = self.extents();
        Soundness {
            parts: self.parts(),
            courtyard: self.has_courtyard(),
            pinches: self.pinches(),
            thickness,
            gap,
        }
    }

    /// Number of parts joined by the sides of cells.
    fn parts(&self) -> usize {
        let mut seen = vec![false; self.inside.len()];
        let mut parts = 0;
        for start in 0..self.inside.len() {
            if !self.inside[start] || seen[start] {
                continue;
            }
            parts += 1;
            seen[start] = true;
            let mut queue = vec![start];
            while let Some(place) = queue.pop() {
                let column = self.column();
                for next in [place - 1, place + 1, place - column, place + column] {
                    if self.inside[next] && !seen[next] {
                        seen[next] = true;
                        queue.push(next);
                    }
                }
            }
        }
        parts
    }

    fn has_courtyard(&self) -> bool {
        let open = self.open_air();
        self.inside
            .iter()
            .zip(open)
            .any(|(inside, open)| !inside && !open)
    }

    /// Corners of cells, of which two opposite ones are inside.
    fn pinches(&self) -> usize {
        let mut pinches = 0;
        for i in 0..=self.columns() {
            for j in 0..=self.rows() {
                // Of the corner at the lower left of cell (i, j).
                let above = self.place(i, j);
                let below = above - self.column();
                let [a, b, c, d] = [below - 1, above - 1, above, below].map(|p| self.inside[p]);
                pinches += usize::from(a == c && b == d && a != b);
            }
        }
        pinches
    }

    /// Least run of inside cells and least run of outside cells between inside ones, over all rows
    /// and columns of the grid.
    fn extents(&self) -> (f64, f64) {
        let mut least = (f64::INFINITY, f64::INFINITY);
        for j in 0..self.rows() {
            let row = (0..self.columns()).map(|i| self.cell(i, j));
            runs(&self.xs, row, &mut least);
        }
        for i in 0..self.columns() {
            let column = (0..self.rows()).map(|j| self.cell(i, j));
            runs(&self.ys, column, &mut least);
        }
        least
    }
}

/// Lowers `least` to the shortest inside run and the shortest enclosed outside run of a line.
fn runs(lines: &[f64], cells: impl Iterator<Item = bool>, least: &mut (f64, f64)) {
    let mut start = 0;
    let mut last = None;
    for (k, inside) in cells.map(Some).chain([None]).enumerate() {
        if inside == last {
            continue;
        }
        let length = lines[k] - lines[start];
        match last {
            Some(true) => least.0 = least.0.min(length),
            Some(false) if start > 0 && inside.is_some() => least.1 = least.1.min(length),
            _ => {}
        }
        (start, last) = (k, inside);
    }
}

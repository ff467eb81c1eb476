//! Plans and storeys as a model reads them: kinds that many real houses share exactly are discrete, so that draws have them
//! exactly, and what is left is continuous.
//!
//! | variable | values | from attributes |
//! | --- | --- | --- |
//! | `plan` | `box`, `corners`, `recessed` | box: `bcr >= 0.985`; corners: the boundary is that of the bounding box; else recessed |
//! | `bcr` | real | missing where `plan` is `box` |
//! | `recess` | metres | `bdry sqrt(A) - 2 (bbox.w + bbox.d)` with `A = bcr bbox.w bbox.d`, where `plan` is `recessed` |
//! | `storey.single`, `storey.stacked` | metres | `bbox.h` over the number of floors, of houses with one and with more |
//! | `full.1`, `full.2` | yes, no | floor k covers the floor below it, but for 2 % |
//! | `upper.1`, `upper.2` | real | area of floor k over that of the floor below, where it is there and not full |
//!
//! Of 320 houses of Delft 41 % are boxes and 91 % have the boundary of their bounding box; of those with two floors or more
//! 53 % have a full one. A Gaussian of `bcr`, `bdry` and `arf` draws none of these: its houses have slivers instead.

use super::observation::Observation;

/// Names of the variables.
pub(super) const PLAN: &str = "plan";
pub(super) const PLANS: [&str; 3] = ["box", "corners", "recessed"];
/// Index of `recessed`.
pub(super) const RECESSED: usize = 2;
pub(super) const RECESS: &str = "recess";
pub(super) const STOREY: [&str; 2] = ["storey.single", "storey.stacked"];
pub(super) const FULL: [&str; 2] = ["full.1", "full.2"];
pub(super) const UPPER: [&str; 2] = ["upper.1", "upper.2"];

/// Coverage from which a plan is a box, length from which a boundary is longer than the bounding box's (m), and share from
/// which a floor is full.
const BOX: f64 = 0.985;
const LONGER: f64 = 0.1;
const WHOLE: f64 = 0.98;
/// Heights that a drawn storey may have (m), and usual height of one, by which floors are counted.
const STOREYS: [f64; 2] = [2.3, 4.2];
const USUAL: f64 = 2.9;
/// Least coverage drawn, shares of a drawn upper floor that is not full, and drawn lengths of recesses (m).
const COVERAGE: f64 = 0.35;
const SHARES: [f64; 2] = [0.15, 0.95];
const RECESSES: [f64; 2] = [0.8, 12.0];

impl Observation {
    /// Index of the plan in [`PLANS`], and the length of its recesses; `None` where the mass is unknown.
    fn outline(&self) -> Option<(usize, f64)> {
        let [w, d, bcr, bdry] = [0, 1, 3, 4].map(|c| self.row[c]);
        let (w, d, bcr, bdry) = (w?, d?, bcr?, bdry?);
        if bcr * w * d <= 0.0 {
            return None;
        }
        let recess = bdry * (bcr * w * d).sqrt() - 2.0 * (w + d);
        let kind = match (bcr >= BOX, recess >= LONGER) {
            (true, false) => 0,
            (false, false) => 1,
            (_, true) => RECESSED,
        };
        Some((kind, recess))
    }

    pub(super) fn plan(&self) -> Option<usize> {
        self.outline().map(|(kind, _)| kind)
    }

    /// The share of the floor below that upper floor `k` (0 or 1) covers.
    fn upper(&self, k: usize) -> Option<f64> {
        let there = self.floors.is_some_and(|f| f > k + 1);
        let below = self.row[6 + k]?;
        let own = self.row[7 + k]?;
        (there && below > 0.0).then(|| own / below)
    }

    pub(super) fn full(&self, k: usize) -> Option<bool> {
        self.upper(k).map(|share| share >= WHOLE)
    }

    /// The value of a variable of plans and storeys; `None` for other names.
    pub(super) fn shape(&self, name: &str) -> Option<Option<f64>> {
        let upper = |k: usize| self.upper(k).filter(|share| *share < WHOLE);
        let storey = |kind: usize| {
            let (h, floors) = self.row[2].zip(self.counted())?;
            (kind == usize::from(floors > 1)).then(|| h / floors as f64)
        };
        Some(match name {
            "storey.single" => storey(0),
            "storey.stacked" => storey(1),
            RECESS => self
                .outline()
                .filter(|(kind, _)| *kind == RECESSED)
                .map(|o| o.1),
            "bcr" => self.row[3].filter(|_| self.plan() != Some(0)),
            "upper.1" => upper(0),
            "upper.2" => upper(1),
            _ => return None,
        })
    }

    /// The number of floors: the known one, else as many as the height has room for.
    pub(super) fn counted(&self) -> Option<usize> {
        let by_height = |h: f64| ((h / USUAL).round() as usize).clamp(1, 3);
        self.floors.or(self.row[2].map(by_height))
    }
}

/// Drawn variables of plans and storeys.
pub(super) struct Shape {
    /// Index in [`PLANS`].
    pub plan: Option<usize>,
    pub recess: Option<f64>,
    pub storey: [Option<f64>; 2],
    pub full: [Option<bool>; 2],
    pub upper: [Option<f64>; 2],
}

impl Shape {
    /// Writes height, coverage and boundary of a house with `floors` floors whose bounding box is known.
    pub(super) fn mass(
        &self,
        row: &mut [Option<f64>],
        given: &[Option<f64>],
        floors: Option<usize>,
    ) {
        if let (None, Some(floors)) = (given[2], floors) {
            let storey = self.storey[usize::from(floors > 1)];
            let height = storey.map(|s| s.clamp(STOREYS[0], STOREYS[1]) * floors as f64);
            row[2] = height.or(row[2]);
        }
        let Some(plan) = self.plan else { return };
        if given[3].is_none() {
            row[3] = match plan {
                0 => Some(1.0),
                _ => row[3].map(|v| v.clamp(COVERAGE, BOX)),
            };
        }
        if let (None, Some(w), Some(d), Some(bcr)) = (given[4], row[0], row[1], row[3]) {
            let recess = match (plan, self.recess) {
                // A recess is no deeper than the house, however small that is.
                (RECESSED, Some(recess)) => recess.clamp(RECESSES[0], RECESSES[1]).min(d.min(w)),
                _ => 0.0,
            };
            let area = Some(bcr * w * d).filter(|area| *area > 0.0);
            row[4] = area.map(|area| (2.0 * (w + d) + recess) / area.sqrt());
        }
    }

    /// Shares of the first and the second upper floor in the whole area, of which at most `most` of the ground floor has
    /// room above it.
    pub(super) fn shares(&self, floors: usize, most: f64) -> Option<[f64; 2]> {
        let share = |k: usize| match (self.full[k], self.upper[k]) {
            (Some(true), _) => Some(1.0),
            (_, upper) => upper.map(|v| v.clamp(SHARES[0], SHARES[1])),
        };
        let first = match floors {
            1 => 0.0,
            _ => share(0)?.min(most),
        };
        let second = match floors {
            3 => first * share(1)?,
            _ => 0.0,
        };
        let all = 1.0 + first + second;
        Some([first / all, second / all])
    }
}

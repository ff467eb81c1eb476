//! Lines of a scheme moved until the measured attributes are the wanted ones.

use std::cell::Cell;

use super::scheme::{Block, GridLine, Scheme};
use super::target::MassTarget;
use super::{MASS, max_z};
use crate::attributes::mass_attributes;
use edifice_optim::least_squares::{Limits, Residuals, minimize};
use edifice_shape::Building;

/// Boxes thinner than this are pushed to grow (m), and those of a fit that has boxes thinner than rooms.
const WISHED_THICKNESS: f64 = 0.6;
pub(super) const ROOM: f64 = 2.5;
/// Lines nearer than this become one (Sec. 6.1, m).
const SNAP: f64 = 0.1;

const LIMITS: Limits = Limits {
    iterations: 60,
    step: 1.5,
    goal: 1e-12,
    difference: 1e-6,
};

/// A fitted scheme, its lines on whole millimetres.
pub(super) struct Fitted {
    pub building: Building,
    /// Its general boxes.
    pub blocks: Vec<Block>,
    pub max_z: f64,
    pub evaluations: u64,
}

struct Model<'a> {
    scheme: &'a Scheme,
    target: &'a MassTarget,
    deviations: &'a [f64],
    /// Boxes thinner than this are pushed to grow (m).
    thickness: f64,
    evaluations: Cell<u64>,
}

impl Residuals for Model<'_> {
    fn residuals(&self, x: &[f64], out: &mut Vec<f64>) {
        self.evaluations.set(self.evaluations.get() + 1);
        let building = self.scheme.building(x, self.target.floor_height);
        let measured = mass_attributes(&building);
        let wanted = self.target.wanted.iter();
        let each = measured.iter().zip(wanted).zip(self.deviations);
        out.extend(each.map(|((m, w), s)| (m - w) / s));
        let thin = self.scheme.thicknesses(x);
        out.extend(thin.map(|t| 2.0 * (self.thickness - t).max(0.0)));
    }
}

/// Fits a scheme; then, when some lines come to lie within 10 cm, once more with these made one; then, when some box is
/// narrower than a room, once more with such boxes pushed to grow: each if that reaches the attributes within `enough` too.
pub(super) fn fit(scheme: &Scheme, target: &MassTarget, deviations: &[f64], enough: f64) -> Fitted {
    let (mut x, mut kept) = once(scheme, target, deviations, WISHED_THICKNESS);
    if kept.max_z > enough {
        return kept;
    }
    let mut scheme = scheme.clone();
    let again = |scheme: &Scheme, thickness: f64, kept: &mut Fitted| {
        let (x, other) = once(scheme, target, deviations, thickness);
        let evaluations = kept.evaluations + other.evaluations;
        let is_better = other.max_z <= enough;
        if is_better {
            *kept = other;
        }
        kept.evaluations = evaluations;
        is_better.then_some(x)
    };
    if let Some(snapped) = scheme.snapped(&x, SNAP)
        && let Some(found) = again(&snapped, WISHED_THICKNESS, &mut kept)
    {
        (scheme, x) = (snapped, found);
    }
    if scheme.thicknesses(&x).any(|t| t < ROOM) {
        scheme.start = x;
        again(&scheme, ROOM, &mut kept);
    }
    kept
}

fn once(
    scheme: &Scheme,
    target: &MassTarget,
    deviations: &[f64],
    thickness: f64,
) -> (Vec<f64>, Fitted) {
    let model = Model {
        scheme,
        target,
        deviations,
        thickness,
        evaluations: Cell::new(0),
    };
    let start = scheme.start.clone();
    // Without free lines, or should argmin fail, the start is what there is.
    let fit = match start.is_empty() {
        true => None,
        false => minimize(&model, start, LIMITS, |_| {}).ok(),
    };
    let x = fit.map_or_else(|| scheme.start.clone(), |run| run.best);
    let mut rounded = scheme.clone();
    for line in rounded.lines.iter_mut().flatten() {
        if let GridLine::Fixed(at) = line {
            *at = millimetres(*at);
        }
    }
    let on_millimetres: Vec<f64> = x.iter().map(|v| millimetres(*v)).collect();
    let building = rounded.building(&on_millimetres, target.floor_height);
    let measured = mass_attributes(&building);
    let fitted = Fitted {
        max_z: max_z(&measured, &target.wanted[..MASS], deviations),
        building,
        blocks: scheme.blocks(&x, target.floor_height),
        evaluations: model.evaluations.get() + 1,
    };
    (x, fitted)
}

pub(super) fn millimetres(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

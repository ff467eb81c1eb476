//! Lines of a scheme moved until the measured attributes are the wanted ones.

use std::cell::Cell;

use super::scheme::{Block, Line, Scheme};
use super::target::MassTarget;
use super::{MASS, max_z};
use crate::attributes::mass_attributes;
use edifice_base::unwatched;
use edifice_optim::least_squares::{Limits, Residuals, minimize};
use edifice_shape::Building;

/// Boxes thinner than this are pushed to grow (m).
const WISHED_THICKNESS: f64 = 0.6;
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
        out.extend(thin.map(|t| 2.0 * (WISHED_THICKNESS - t).max(0.0)));
    }
}

/// Fits a scheme; then, when some lines come to lie within 10 cm, once more with these made one, if that
/// reaches the attributes within `enough` too.
pub(super) fn fit(scheme: &Scheme, target: &MassTarget, deviations: &[f64], enough: f64) -> Fitted {
    let (x, first) = once(scheme, target, deviations);
    if first.max_z > enough {
        return first;
    }
    let Some(snapped) = scheme.snapped(&x, SNAP) else {
        return first;
    };
    let (_, second) = once(&snapped, target, deviations);
    let evaluations = first.evaluations + second.evaluations;
    let kept = if second.max_z <= enough {
        second
    } else {
        first
    };
    Fitted {
        evaluations,
        ..kept
    }
}

fn once(scheme: &Scheme, target: &MassTarget, deviations: &[f64]) -> (Vec<f64>, Fitted) {
    let model = Model {
        scheme,
        target,
        deviations,
        evaluations: Cell::new(0),
    };
    let start = scheme.start.clone();
    // Without free lines, or should argmin fail, the start is what there is.
    let fit = match start.is_empty() {
        true => None,
        false => minimize(&model, start, LIMITS, &unwatched).ok(),
    };
    let x = fit.map_or_else(|| scheme.start.clone(), |run| run.best);
    let mut rounded = scheme.clone();
    for line in rounded.lines.iter_mut().flatten() {
        if let Line::Fixed(at) = line {
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

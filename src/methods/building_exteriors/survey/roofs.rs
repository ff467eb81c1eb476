//! Kind, eaves and pitch of the roof of each box, by least squares on the heights.

use super::boxes::Level;
use super::heights::{HeightMap, Sample};
use edifice_shape::{BoxStyle, MassBox, Ridge, Roof, RoofStyle};

/// Rounds over all boxes.
const ROUNDS: usize = 3;
/// A kind of roof beyond flat and gable must lower the mean error to this share.
const GAIN: f64 = 0.9;
/// Lowest eave (m), and flattest and steepest pitch of a sloped roof (tangents of 5 and 70 degrees).
const LOWEST: f64 = 2.0;
const SLOPES: [f64; 2] = [0.0875, 2.75];
/// Mean error (m) below which a flat roof is taken as it is.
const FLAT: f64 = 0.12;

/// Kinds that are tried.
const KINDS: [(RoofStyle, Ridge); 6] = [
    (RoofStyle::Flat, Ridge::X),
    (RoofStyle::Gable, Ridge::X),
    (RoofStyle::Gable, Ridge::Y),
    (RoofStyle::Hip, Ridge::X),
    (RoofStyle::Shed, Ridge::X),
    (RoofStyle::Shed, Ridge::Y),
];

/// A box with its roof.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RoofedBox {
    /// Lower and upper x, lower and upper y.
    pub plan: [f64; 4],
    /// Height of the eaves.
    pub eave: f64,
    /// Tangent of the pitch; negative for a shed that falls along its axis.
    pub slope: f64,
    kind: (RoofStyle, Ridge),
}

impl RoofedBox {
    /// Distance from the eaves at a place of the plan.
    fn distance(&self, x: f64, y: f64) -> f64 {
        let [x0, x1, y0, y1] = self.plan;
        let (dx, dy) = ((x - x0).min(x1 - x), (y - y0).min(y1 - y));
        match self.kind {
            (RoofStyle::Gable, Ridge::X) => dy,
            (RoofStyle::Gable, Ridge::Y) => dx,
            (RoofStyle::Hip, _) => dx.min(dy),
            (RoofStyle::Shed, Ridge::X) => y - y0,
            (RoofStyle::Shed, Ridge::Y) => x - x0,
            (RoofStyle::Flat | RoofStyle::Cone, _) => 0.0,
        }
    }

    fn height(&self, x: f64, y: f64) -> f64 {
        self.eave + self.slope * self.distance(x, y)
    }

    fn contains(&self, s: &Sample) -> bool {
        let [x0, x1, y0, y1] = self.plan;
        (x0..=x1).contains(&s.x) && (y0..=y1).contains(&s.y)
    }

    fn area(&self) -> f64 {
        (self.plan[1] - self.plan[0]) * (self.plan[3] - self.plan[2])
    }

    /// The box of a house, lengths to the centimetre, the pitch to a tenth of a degree.
    pub(super) fn mass_box(&self) -> MassBox {
        let round = |v: f64| (v * 100.0).round() / 100.0;
        let [x0, x1, y0, y1] = self.plan.map(round);
        let pitch = (self.slope.atan().to_degrees() * 10.0).round() / 10.0;
        MassBox {
            style: BoxStyle::Main,
            x: (x0 + x1) / 2.0,
            y: (y0 + y1) / 2.0,
            width: x1 - x0,
            depth: y1 - y0,
            height: round(self.eave),
            roof: Roof {
                style: self.kind.0,
                pitch: pitch.max(0.0),
                ridge: self.kind.1,
            },
        }
    }
}

/// Fits roofs to the boxes.
pub(super) fn fitted(levels: &[Level], map: &HeightMap) -> Vec<RoofedBox> {
    let samples: Vec<Sample> = map.samples().collect();
    let mut boxes: Vec<RoofedBox> = levels
        .iter()
        .map(|l| RoofedBox {
            plan: l.plan,
            eave: l.eave,
            slope: 0.0,
            kind: KINDS[0],
        })
        .collect();
    // At first each sample belongs to the first box over it: the highest level.
    let mut owners: Vec<Option<usize>> = samples
        .iter()
        .map(|s| boxes.iter().position(|b| b.contains(s)))
        .collect();
    for round in 0..ROUNDS {
        for (i, own) in boxes.iter_mut().enumerate() {
            let seen = owners.iter().zip(&samples);
            let seen: Vec<Sample> = seen
                .filter(|(o, _)| **o == Some(i))
                .map(|(_, s)| *s)
                .collect();
            if seen.len() >= 4 {
                *own = best(own, &seen);
            }
        }
        if round + 1 < ROUNDS {
            reach(&mut boxes, &samples);
        }
        owners = samples
            .iter()
            .map(|s| top(&boxes, s).map(|t| t.0))
            .collect();
    }
    let mut boxes = simplified(boxes, &samples);
    way_round(&mut boxes, &samples);
    boxes
}

/// The highest box over a sample and its height there.
fn top(boxes: &[RoofedBox], s: &Sample) -> Option<(usize, f64)> {
    let over = boxes.iter().enumerate().filter(|(_, b)| b.contains(s));
    over.map(|(i, b)| (i, b.height(s.x, s.y)))
        .max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Sum of the absolute differences of the heights; a sample that no box covers counts as its height.
fn error(boxes: &[RoofedBox], samples: &[Sample]) -> f64 {
    let off = |s: &Sample| (top(boxes, s).map_or(0.0, |t| t.1) - s.height).abs();
    samples.iter().map(off).sum()
}

/// The roof of the least mean error over the samples at which the box is seen.
fn best(own: &RoofedBox, samples: &[Sample]) -> RoofedBox {
    let mut found: Option<(f64, RoofedBox)> = None;
    for kind in KINDS {
        let Some(roofed) = least_squares(own, kind, samples) else {
            continue;
        };
        let n = samples.len() as f64;
        let off = samples
            .iter()
            .map(|s| (roofed.height(s.x, s.y) - s.height).abs());
        let mean = off.sum::<f64>() / n;
        let handicap = match kind.0 {
            RoofStyle::Flat => 1.0 / (1.0 + FLAT / mean.max(1e-6)),
            RoofStyle::Gable => GAIN,
            _ => 1.0,
        };
        let rank = mean * handicap;
        if found.is_none_or(|(least, _)| rank < least) {
            found = Some((rank, roofed));
        }
    }
    found.map_or(*own, |f| f.1)
}

/// Eaves and slope of one kind of roof: the line through distances and heights. `None` where the slope is out of range.
fn least_squares(
    own: &RoofedBox,
    kind: (RoofStyle, Ridge),
    samples: &[Sample],
) -> Option<RoofedBox> {
    let shaped = RoofedBox { kind, ..*own };
    let n = samples.len() as f64;
    let distances: Vec<f64> = samples.iter().map(|s| shaped.distance(s.x, s.y)).collect();
    let d = distances.iter().sum::<f64>() / n;
    let h = samples.iter().map(|s| s.height).sum::<f64>() / n;
    if kind.0 == RoofStyle::Flat {
        let mut heights: Vec<f64> = samples.iter().map(|s| s.height).collect();
        heights.sort_by(f64::total_cmp);
        let eave = heights[heights.len() / 2].max(LOWEST);
        return Some(RoofedBox {
            eave,
            slope: 0.0,
            ..shaped
        });
    }
    let (mut dd, mut dh) = (0.0, 0.0);
    for (s, own) in samples.iter().zip(&distances) {
        dd += (own - d).powi(2);
        dh += (own - d) * (s.height - h);
    }
    let slope = dh / dd;
    let turns = kind.0 == RoofStyle::Shed;
    let size = if turns { slope.abs() } else { slope };
    if dd <= 1e-9 || !(SLOPES[0]..=SLOPES[1]).contains(&size) {
        return None;
    }
    let eave = h - slope * d;
    let lowest = if slope < 0.0 {
        let [x0, x1, y0, y1] = own.plan;
        let extent = if kind.1 == Ridge::X { y1 - y0 } else { x1 - x0 };
        eave + slope * extent
    } else {
        eave
    };
    (lowest >= LOWEST).then_some(RoofedBox {
        eave,
        slope,
        ..shaped
    })
}

/// Lets a box reach to the middle of one that it leans on, where this lowers the error.
fn reach(boxes: &mut [RoofedBox], samples: &[Sample]) {
    let mut least = error(boxes, samples);
    for i in 0..boxes.len() {
        for j in 0..boxes.len() {
            if i == j {
                continue;
            }
            for side in 0..4 {
                let (axis, other) = (side / 2 * 2, 2 - side / 2 * 2);
                let (own, host) = (boxes[i].plan, boxes[j].plan);
                // The host's edge that this side of the box lies on.
                let facing = if side % 2 == 0 { axis + 1 } else { axis };
                let touches = (own[side] - host[facing]).abs() < 0.05;
                let beside = own[other] < host[other + 1] && host[other] < own[other + 1];
                if !touches || !beside {
                    continue;
                }
                boxes[i].plan[side] = (host[axis] + host[axis + 1]) / 2.0;
                let now = error(boxes, samples);
                if now < 0.99 * least {
                    least = now;
                } else {
                    boxes[i].plan[side] = own[side];
                }
            }
        }
    }
}

/// Leaves out boxes that are hardly missed: the mean error rises by less than 2 cm without them.
fn simplified(mut boxes: Vec<RoofedBox>, samples: &[Sample]) -> Vec<RoofedBox> {
    let allowed = 0.02 * samples.len() as f64;
    loop {
        let now = error(&boxes, samples);
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        order.sort_by(|&a, &b| boxes[a].area().total_cmp(&boxes[b].area()));
        let without = |i: usize| {
            let mut rest = boxes.clone();
            rest.remove(i);
            rest
        };
        let spare = order
            .into_iter()
            .find(|&i| boxes.len() > 1 && error(&without(i), samples) < now + allowed);
        match spare {
            Some(i) => {
                boxes.remove(i);
            }
            None => return boxes,
        }
    }
}

/// Turns the house by half a circle where more sheds fall along their axis than rise, and gives those that still fall
/// the best other roof.
fn way_round(boxes: &mut [RoofedBox], samples: &[Sample]) {
    let weight: f64 = boxes
        .iter()
        .filter(|b| b.kind.0 == RoofStyle::Shed)
        .map(|b| b.area() * b.slope.signum())
        .sum();
    let turned = weight < 0.0;
    let turn = |s: &Sample| Sample {
        x: -s.x,
        y: -s.y,
        ..*s
    };
    let own: Vec<Sample> = match turned {
        true => samples.iter().map(turn).collect(),
        false => samples.to_vec(),
    };
    for b in boxes.iter_mut() {
        if turned {
            let [x0, x1, y0, y1] = b.plan;
            b.plan = [-x1, -x0, -y1, -y0];
            if b.kind.0 == RoofStyle::Shed {
                let extent = if b.kind.1 == Ridge::X {
                    y1 - y0
                } else {
                    x1 - x0
                };
                b.eave += b.slope * extent;
                b.slope = -b.slope;
            }
        }
        if b.slope < 0.0 {
            let seen: Vec<Sample> = own.iter().filter(|s| b.contains(s)).copied().collect();
            let kinds = KINDS.iter().filter(|k| k.0 != RoofStyle::Shed);
            let fitted = kinds.filter_map(|k| least_squares(b, *k, &seen));
            let off = |r: &RoofedBox| {
                seen.iter()
                    .map(|s| (r.height(s.x, s.y) - s.height).abs())
                    .sum::<f64>()
            };
            if let Some(other) = fitted.min_by(|p, q| off(p).total_cmp(&off(q))) {
                *b = other;
            }
        }
    }
}

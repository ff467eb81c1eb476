//! The volume of a union of prisms by integration over the plan: an independent check of surfaces.
//!
//! Over a vertical section at `x` the union is bounded by straight lines, so that its area is a sum of trapezoids
//! between the places where something begins, ends or crosses; between two `x` where the order of these places
//! changes the area is a quadratic function of `x`, which Simpson's rule integrates exactly. Everything is plain
//! floating-point arithmetic and shares no code with the surface.

use super::Prism;
use super::exact::{Line, Plane, SLOPES, UNIT};

/// A half plane `a x + b y + c >= 0` in metres.
type Half = [f64; 3];

/// A segment across the plan.
type Segment = [[f64; 2]; 2];

struct Column {
    region: Vec<Half>,
    lower: Half,
    upper: Half,
}

/// The volume in cubic metres.
pub fn volume(prisms: &[Prism]) -> f64 {
    let columns: Vec<Column> = prisms
        .iter()
        .map(|p| Column {
            region: p.region.iter().map(half).collect(),
            lower: height(&p.lower),
            upper: height(&p.upper),
        })
        .collect();
    let segments = segments(&columns);
    let mut stops: Vec<f64> = segments.iter().flat_map(|s| [s[0][0], s[1][0]]).collect();
    for (i, s) in segments.iter().enumerate() {
        for t in &segments[i + 1..] {
            stops.extend(crossing(s, t));
        }
    }
    stops.sort_by(f64::total_cmp);
    stops.dedup_by(|next, kept| *next - *kept < 1e-9);
    stops
        .windows(2)
        .map(|w| {
            // Just inside the ends, where sections do not change by jumps.
            let at = |t: f64| section(&columns, &segments, w[0] + t * (w[1] - w[0]));
            // Gauss-Legendre with two points is exact for cubics, too.
            let r = 0.5 / 3.0_f64.sqrt();
            (w[1] - w[0]) * (at(0.5 - r) + at(0.5 + r)) / 2.0
        })
        .sum()
}

fn half(line: &Line) -> Half {
    let (a, b) = (line.a as f64, line.b as f64);
    let norm = a.hypot(b);
    [a / norm, b / norm, line.c as f64 * UNIT / norm]
}

fn height(plane: &Plane) -> Half {
    let s = SLOPES as f64;
    [
        plane.a as f64 / s,
        plane.b as f64 / s,
        plane.c as f64 * UNIT / s,
    ]
}

fn at(h: &Half, x: f64, y: f64) -> f64 {
    h[0] * x + h[1] * y + h[2]
}

/// Sides of the regions, and crossings of planes over places that two columns share.
fn segments(columns: &[Column]) -> Vec<Segment> {
    let mut found: Vec<Segment> = Vec::new();
    let mut add = |line: Half, regions: &[&Column]| {
        let norm = line[0].hypot(line[1]);
        if norm > 1e-12 {
            let line = line.map(|v| v / norm);
            found.extend(clipped(&line, regions));
        }
    };
    for (i, a) in columns.iter().enumerate() {
        for line in &a.region {
            add(*line, &[a]);
        }
        for b in &columns[i..] {
            for p in [&a.lower, &a.upper] {
                for q in [&b.lower, &b.upper] {
                    add([0, 1, 2].map(|k| p[k] - q[k]), &[a, b]);
                }
            }
        }
    }
    let round = |s: &Segment| s.map(|p| p.map(|v| (v * 1e7).round() as i64));
    found.sort_by_key(|s| round(s));
    found.dedup_by(|a, b| round(a) == round(b));
    found
}

/// The part of a line inside all regions.
fn clipped(line: &Half, regions: &[&Column]) -> Option<Segment> {
    let start = [-line[0] * line[2], -line[1] * line[2]];
    let along = [line[1], -line[0]];
    let (mut from, mut to) = (-1e6_f64, 1e6_f64);
    for h in regions.iter().flat_map(|c| &c.region) {
        let (speed, value) = (h[0] * along[0] + h[1] * along[1], at(h, start[0], start[1]));
        if speed.abs() < 1e-12 {
            if value < -1e-9 {
                return None;
            }
        } else if speed > 0.0 {
            from = from.max(-value / speed);
        } else {
            to = to.min(-value / speed);
        }
    }
    let point = |t: f64| [start[0] + t * along[0], start[1] + t * along[1]];
    (to - from > 1e-9 && to - from < 1e5).then(|| {
        let (p, q) = (point(from), point(to));
        if p[0] <= q[0] { [p, q] } else { [q, p] }
    })
}

/// The `x` where two segments cross.
fn crossing(s: &Segment, t: &Segment) -> Option<f64> {
    let d = |s: &Segment| [s[1][0] - s[0][0], s[1][1] - s[0][1]];
    let (p, q) = (d(s), d(t));
    let denominator = p[0] * q[1] - p[1] * q[0];
    if denominator.abs() < 1e-12 {
        return None;
    }
    let between = [t[0][0] - s[0][0], t[0][1] - s[0][1]];
    let u = (between[0] * q[1] - between[1] * q[0]) / denominator;
    let v = (between[0] * p[1] - between[1] * p[0]) / denominator;
    let inside = |w: f64| (-1e-9..=1.0 + 1e-9).contains(&w);
    (inside(u) && inside(v)).then(|| s[0][0] + u * p[0])
}

/// Area of the union over the line at `x`.
fn section(columns: &[Column], segments: &[Segment], x: f64) -> f64 {
    let here = segments.iter().filter(|s| s[0][0] < x && x < s[1][0]);
    let mut stops: Vec<f64> = here
        .map(|s| s[0][1] + (x - s[0][0]) / (s[1][0] - s[0][0]) * (s[1][1] - s[0][1]))
        .collect();
    stops.sort_by(f64::total_cmp);
    let mut area = 0.0;
    let mut stack: Vec<(f64, f64)> = Vec::new();
    for w in stops.windows(2) {
        let y = (w[0] + w[1]) / 2.0;
        if w[1] - w[0] < 1e-12 {
            continue;
        }
        stack.clear();
        let over = columns
            .iter()
            .filter(|c| c.region.iter().all(|h| at(h, x, y) > 0.0));
        stack.extend(over.map(|c| (at(&c.lower, x, y), at(&c.upper, x, y))));
        stack.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut length, mut top) = (0.0, f64::NEG_INFINITY);
        for &(low, high) in &stack {
            length += (high - low.max(top)).max(0.0);
            top = top.max(high);
        }
        area += length * (w[1] - w[0]);
    }
    area
}

#[cfg(test)]
mod tests {
    use super::{Segment, crossing};
    use edifice_base::rng::stream;
    use rand::RngExt;

    /// Segments drawn through a point, each so far before and behind it, cross there; cut off before it they do not cross.
    #[test]
    fn segments_through_a_point_cross_there() {
        let mut rng = stream(1, "crossing", 0);
        for case in 0..1_000 {
            let mut draw = |low: f64, high: f64| rng.random_range(low..high);
            let place = [draw(-9.0, 9.0), draw(-9.0, 9.0)];
            let turn = draw(0.0, 3.0);
            let turns = [turn, turn + draw(0.1, 3.0)];
            let mut through = |angle: f64, from: f64, to: f64| -> Segment {
                let (a, b) = (draw(from, from + 3.0), draw(to, to + 3.0));
                let point = |t: f64| [place[0] + t * angle.cos(), place[1] + t * angle.sin()];
                [point(a), point(b)]
            };
            let [s, t] = turns.map(|angle| through(angle, -3.01, 0.01));
            let short = through(turns[1], 0.01, 3.02);
            for (s, t) in [(&s, &t), (&t, &s)] {
                let x = crossing(s, t).unwrap();
                assert!((x - place[0]).abs() < 1e-9, "{case}: {x} is not {place:?}");
            }
            assert_eq!(crossing(&s, &short), None, "{case}");
            assert_eq!(crossing(&short, &s), None, "{case}");
        }
    }

    #[test]
    fn parallel_segments_do_not_cross() {
        let s = [[0.0, 0.0], [2.0, 1.0]];
        for t in [s, [[1.0, 0.5], [3.0, 1.5]], [[0.0, 1.0], [4.0, 3.0]]] {
            assert_eq!(crossing(&s, &t), None);
        }
    }
}

//! Footprints of houses as GeoJSON (RFC 7946): one polygon without holes, also as a feature or a collection of one
//! feature. A footprint must be rectilinear, at any angle; it is turned so that its longest edge runs along x and
//! shifted to the origin.
//!
//! Positions are longitude and latitude in degrees, as the format says, when the polygon is less than 0.01 wide and
//! deep; else metres, since no house is a kilometre wide.

use std::path::Path;

use serde_json::Value;

use super::json::parse_json;
use super::read_bytes;
use edifice_base::{Error, Result};
use edifice_shape::{PlanUnion, Rect};

/// Why a polygon is no footprint.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FootprintError {
    /// Another kind of object, or not exactly one polygon.
    #[error("expected one Polygon, a Feature of one or a collection of one, found {0}")]
    Kind(String),
    /// A polygon with holes: houses have no courtyards here.
    #[error("the polygon has {0} holes; a footprint has none")]
    Holes(usize),
    /// A position that is not two finite numbers.
    #[error("position {index} is not two finite numbers")]
    Position {
        /// Its place in the ring.
        index: usize,
    },
    /// Too few or too many corners.
    #[error("{corners} corners after those on straight edges are dropped, expected 4 to {MOST}")]
    Corners {
        /// Number of corners that are left.
        corners: usize,
    },
    /// Two edges cross or touch.
    #[error("edges {first} and {second} cross or touch each other")]
    Crossing {
        /// The first edge, from 0.
        first: usize,
        /// The second.
        second: usize,
    },
    /// An edge at an angle.
    #[error(
        "edge {edge} is {degrees:.1} degrees off the axes of the longest edge; a footprint must be rectilinear (within {ANGLE} degrees)"
    )]
    Angle {
        /// The edge, from 0.
        edge: usize,
        /// Its angle.
        degrees: f64,
    },
    /// A plan that is too thin or in several pieces.
    #[error("the footprint is thinner than 0.5 m, or touches itself")]
    Unsound,
    /// A plan that is too small or too large for a house.
    #[error("the footprint is {width:.1} m x {depth:.1} m, expected 4 to 60 m")]
    Size {
        /// Extent along the longest edge, in metres.
        width: f64,
        /// Extent across it, in metres.
        depth: f64,
    },
}

/// Largest angle off the axes in degrees.
const ANGLE: f64 = 2.0;
/// Most corners.
const MOST: usize = 200;
/// Extent below which positions are degrees.
const DEGREES: f64 = 0.01;
/// Metres of a degree of latitude.
const METRES: f64 = 111_195.0;
/// Corners nearer than this are one (m).
const SAME: f64 = 0.01;

type P = [f64; 2];

/// Reads a footprint as rectangles that cover it without overlap.
///
/// # Errors
/// Names the file and what is wrong.
pub fn read(path: &Path) -> Result<Vec<Rect>> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a file; `path` only names it in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Vec<Rect>> {
    let document: Value = parse_json(bytes, path)?;
    rectangles(&document).map_err(|e| Error::content(path, e))
}

fn rectangles(document: &Value) -> std::result::Result<Vec<Rect>, FootprintError> {
    let ring = straight(metres(ring(document)?));
    if !(4..=MOST).contains(&ring.len()) {
        return Err(FootprintError::Corners {
            corners: ring.len(),
        });
    }
    crossings(&ring)?;
    let ring = squared(&upright(&ring))?;
    crossings(&ring)?;
    let plan = slabs(&ring);
    let union = PlanUnion::new(&plan);
    let bounds = union.bounding_box().ok_or(FootprintError::Unsound)?;
    let fits = |extent: f64| (4.0..=60.0).contains(&extent);
    if !fits(bounds.width) || !fits(bounds.height) {
        return Err(FootprintError::Size {
            width: bounds.width,
            depth: bounds.height,
        });
    }
    let sound = union.soundness();
    let whole = sound.parts == 1 && !sound.courtyard && sound.pinches == 0;
    if !whole || sound.thickness < 0.5 {
        return Err(FootprintError::Unsound);
    }
    Ok(plan)
}

/// The outer ring of the only polygon.
fn ring(value: &Value) -> std::result::Result<Vec<P>, FootprintError> {
    let kind = value["type"].as_str().unwrap_or("no type");
    let one = |list: &Value| match list.as_array().map(Vec::as_slice) {
        Some([one]) => Ok(one.clone()),
        other => Err(FootprintError::Kind(format!(
            "{kind} of {}",
            other.map_or(0, <[Value]>::len)
        ))),
    };
    match kind {
        "FeatureCollection" => ring(&one(&value["features"])?),
        "Feature" => ring(&value["geometry"]),
        "GeometryCollection" => ring(&one(&value["geometries"])?),
        "MultiPolygon" => outer(&one(&value["coordinates"])?),
        "Polygon" => outer(&value["coordinates"]),
        other => Err(FootprintError::Kind(other.into())),
    }
}

fn outer(rings: &Value) -> std::result::Result<Vec<P>, FootprintError> {
    let rings = rings.as_array().map_or(&[][..], Vec::as_slice);
    let Some(first) = rings.first().and_then(Value::as_array) else {
        return Err(FootprintError::Kind("a Polygon without a ring".into()));
    };
    if rings.len() > 1 {
        return Err(FootprintError::Holes(rings.len() - 1));
    }
    let position = |(index, p): (usize, &Value)| {
        let number = |k: usize| p[k].as_f64().filter(|v| v.abs() < 1e9);
        match (number(0), number(1)) {
            (Some(x), Some(y)) => Ok([x, y]),
            _ => Err(FootprintError::Position { index }),
        }
    };
    first.iter().enumerate().map(position).collect()
}

/// Degrees as metres around the first position; metres as they are.
fn metres(ring: Vec<P>) -> Vec<P> {
    let extent = |axis: usize| {
        let values = ring.iter().map(|p| p[axis]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
            (l.min(v), h.max(v))
        });
        high - low
    };
    if ring.is_empty() || extent(0).max(extent(1)) >= DEGREES {
        return ring;
    }
    let [x0, y0] = ring[0];
    let across = METRES * y0.to_radians().cos();
    ring.iter()
        .map(|[x, y]| [(x - x0) * across, (y - y0) * METRES])
        .collect()
}

/// Without the repeated last corner, doubles, and corners on straight edges.
fn straight(mut ring: Vec<P>) -> Vec<P> {
    let near = |a: P, b: P| (a[0] - b[0]).hypot(a[1] - b[1]) < SAME;
    ring.dedup_by(|a, b| near(*a, *b));
    while ring.len() > 1 && near(ring[0], ring[ring.len() - 1]) {
        ring.pop();
    }
    let mut k = 0;
    while ring.len() > 3 && k < ring.len() {
        let n = ring.len();
        let (a, b, c) = (ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]);
        let (u, v) = (sub(b, a), sub(c, b));
        let lengths = u[0].hypot(u[1]) * v[0].hypot(v[1]);
        let turn = (cross(u, v) / lengths).clamp(-1.0, 1.0).asin().to_degrees();
        let ahead = u[0] * v[0] + u[1] * v[1] > 0.0;
        if ahead && turn.abs() < ANGLE {
            ring.remove(k);
            k = k.saturating_sub(1);
        } else {
            k += 1;
        }
    }
    ring
}

fn sub(a: P, b: P) -> P {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: P, b: P) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Checks that no two edges meet that are not neighbours, and that no neighbours fold back.
fn crossings(ring: &[P]) -> std::result::Result<(), FootprintError> {
    let n = ring.len();
    let edge = |k: usize| (ring[k], ring[(k + 1) % n]);
    for first in 0..n {
        for second in first + 1..n {
            let ((a, b), (c, d)) = (edge(first), edge(second));
            let beside = second == first + 1 || (first == 0 && second == n - 1);
            let meets = if beside {
                let (u, v) = if second == first + 1 {
                    (sub(b, a), sub(d, c))
                } else {
                    (sub(d, c), sub(b, a))
                };
                cross(u, v).abs() < 1e-9 && u[0] * v[0] + u[1] * v[1] < 0.0
            } else {
                meet(a, b, c, d)
            };
            if meets {
                return Err(FootprintError::Crossing { first, second });
            }
        }
    }
    Ok(())
}

fn meet(a: P, b: P, c: P, d: P) -> bool {
    let side = |p: P, q: P, r: P| cross(sub(q, p), sub(r, p));
    let within = |p: P, q: P, r: P| {
        (0..2).all(|k| r[k] >= p[k].min(q[k]) - 1e-9 && r[k] <= p[k].max(q[k]) + 1e-9)
    };
    let (s, t) = (side(a, b, c), side(a, b, d));
    let (u, v) = (side(c, d, a), side(c, d, b));
    (s * t < 0.0 && u * v < 0.0)
        || (s.abs() < 1e-9 && within(a, b, c))
        || (t.abs() < 1e-9 && within(a, b, d))
        || (u.abs() < 1e-9 && within(c, d, a))
        || (v.abs() < 1e-9 && within(c, d, b))
}

/// Turned by less than 45 degrees so that the longest edge runs along an axis: what lay in front stays in front.
fn upright(ring: &[P]) -> Vec<P> {
    let n = ring.len();
    let edges = (0..n).map(|k| sub(ring[(k + 1) % n], ring[k]));
    let longest = edges.max_by(|a, b| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1])));
    let [x, y] = longest.unwrap_or([1.0, 0.0]);
    let quarter = std::f64::consts::FRAC_PI_2;
    let angle = y.atan2(x);
    let angle = angle - (angle / quarter).round() * quarter;
    let (sin, cos) = (-angle).sin_cos();
    ring.iter()
        .map(|[x, y]| [x * cos - y * sin, x * sin + y * cos])
        .collect()
}

/// Corners on whole millimetres with edges along the axes, from the origin.
fn squared(ring: &[P]) -> std::result::Result<Vec<P>, FootprintError> {
    let n = ring.len();
    // Of each edge, whether it runs along x, and its middle across.
    let mut edges = Vec::with_capacity(n);
    for k in 0..n {
        let (a, b) = (ring[k], ring[(k + 1) % n]);
        let [x, y] = sub(b, a);
        let along_x = x.abs() >= y.abs();
        let degrees = (x.abs().min(y.abs()))
            .atan2(x.abs().max(y.abs()))
            .to_degrees();
        if degrees > ANGLE {
            return Err(FootprintError::Angle { edge: k, degrees });
        }
        let axis = usize::from(along_x);
        edges.push((along_x, (a[axis] + b[axis]) / 2.0));
    }
    let mut corners = Vec::with_capacity(n);
    for k in 0..n {
        let ((before, at), (after, to)) = (edges[(k + n - 1) % n], edges[k]);
        if before == after {
            let fold = FootprintError::Crossing {
                first: (k + n - 1) % n,
                second: k,
            };
            return Err(fold);
        }
        corners.push(if before { [to, at] } else { [at, to] });
    }
    let low = |axis: usize| {
        corners
            .iter()
            .map(|p| p[axis])
            .fold(f64::INFINITY, f64::min)
    };
    let low = [low(0), low(1)];
    let millimetres = |v: f64| (v * 1e3).round() / 1e3;
    let shifted = |p: &P| [0, 1].map(|k| millimetres(p[k] - low[k]));
    Ok(corners.iter().map(shifted).collect())
}

/// Upright slabs between neighbouring corners.
fn slabs(ring: &[P]) -> Vec<Rect> {
    let mut xs: Vec<f64> = ring.iter().map(|p| p[0]).collect();
    xs.sort_by(f64::total_cmp);
    xs.dedup();
    let n = ring.len();
    let mut plan = Vec::new();
    for pair in xs.windows(2) {
        let middle = (pair[0] + pair[1]) / 2.0;
        let edges = (0..n).map(|k| (ring[k], ring[(k + 1) % n]));
        let over = edges.filter(|(a, b)| a[0].min(b[0]) < middle && middle < a[0].max(b[0]));
        let mut ys: Vec<f64> = over.map(|(a, _)| a[1]).collect();
        ys.sort_by(f64::total_cmp);
        let inside = ys.chunks_exact(2).filter(|y| y[1] > y[0]);
        plan.extend(inside.map(|y| Rect::new(pair[0], y[0], pair[1] - pair[0], y[1] - y[0])));
    }
    plan
}

#[cfg(test)]
mod tests;

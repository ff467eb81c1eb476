//! Transfer from the database: what lies below the lowest seen row, and whole facades warped to the seen lines.

use super::fill::typical_gap;
use super::observation::{Observation, of};
use crate::layout::lines::LatticeLine;
use crate::layout::{Class, Element};
use crate::model::Example;
use edifice_shape::Rect;

/// A row of a database facade that may correspond to the lowest seen row.
#[derive(Debug, Clone, Copy)]
pub struct Below {
    /// Position of the example in the database.
    pub example: usize,
    /// Index of its row.
    pub row: usize,
    /// Weight among the rows.
    pub weight: f64,
}

/// The features by which the surroundings of two rows are compared.
struct Style {
    balconies: f64,
    wide: f64,
    columns: f64,
    aspect: f64,
    /// Window width in units of the typical column gap.
    density: f64,
}

impl Style {
    fn new(elements: &[Element], columns: &[LatticeLine], size: (f64, f64), width: f64) -> Self {
        let windows = of(elements, Class::Window).count().max(1) as f64;
        let balconies: Vec<&Element> = of(elements, Class::Balcony).collect();
        let wide = balconies
            .iter()
            .filter(|b| b.rect.width > 0.4 * width)
            .count();
        let gap = typical_gap(columns).unwrap_or(2.0 * size.0);
        Self {
            balconies: (balconies.len() as f64 / windows).min(2.0),
            wide: wide.min(2) as f64,
            columns: columns.len().max(1) as f64,
            aspect: size.0 / size.1,
            density: size.0 / gap,
        }
    }
}

/// The gap above a row, or the typical one.
fn gap_above(rows: &[LatticeLine], row: usize, height: f64) -> f64 {
    let next = rows.get(row + 1).map(|above| above.at - rows[row].at);
    next.or_else(|| typical_gap(rows)).unwrap_or(1.8 * height)
}

/// Differences that count as one: logarithm of the number of columns, balconies for a window, wide balconies,
/// logarithms of a window's aspect and of its width in units of the column gap.
const STYLE: [f64; 5] = [0.35, 0.25, 1.0, 0.25, 0.4];
/// Differences that count as one: logarithms of the space below, of the window height and of the next gap, in units of
/// the gap above; rows above.
const PLACE: [f64; 4] = [0.06, 0.1, 0.3, 3.0];
/// Squared distance at which a weight falls to 1 / e.
const FALL: f64 = 1.2;

/// The rows of a database compared with the lowest seen row of an observation: space below and window height in units of the
/// gap above, that gap in units of the next, balconies, shape of windows.
pub struct Surroundings {
    /// Position of the example, its row, squared distance without what depends on columns.
    rows: Vec<(usize, usize, f64)>,
    /// Logarithms of the number of columns and of the density of each example.
    columns: Vec<(f64, f64)>,
}

impl Surroundings {
    /// Compares the rows; none without an observed row.
    pub fn new(observation: &Observation, examples: &[(usize, &Example)]) -> Self {
        let own = Style::new(
            &observation.elements,
            &observation.columns,
            observation.size,
            observation.partial.width,
        );
        let log = |a: f64, b: f64| (a.max(1e-6) / b.max(1e-6)).ln();
        let (mut rows, mut columns) = (Vec::new(), Vec::new());
        for (position, (_, e)) in examples.iter().enumerate() {
            let other = Style::new(&e.layout.elements, &e.columns, e.size, e.layout.width);
            columns.push((other.columns.ln(), other.density.ln()));
            let Some(last) = observation.rows.first() else {
                continue;
            };
            let gap = gap_above(&observation.rows, 0, observation.size.1);
            let style = [
                (own.balconies - other.balconies) / STYLE[1],
                (own.wide - other.wide) / STYLE[2],
                log(own.aspect, other.aspect) / STYLE[3],
            ];
            let style: f64 = style.iter().map(|t| t * t).sum();
            for row in 0..e.rows.len() {
                let other = gap_above(&e.rows, row, e.size.1);
                let next = gap_above(&e.rows, row + 1, e.size.1);
                let terms = [
                    log(last.at / gap, e.rows[row].at / other) / PLACE[0],
                    log(last.size / gap, e.rows[row].size / other) / PLACE[1],
                    log(
                        gap_above(&observation.rows, 1, observation.size.1) / gap,
                        next / other,
                    ) / PLACE[2],
                    (observation.rows.len() as f64 - (e.rows.len() - row) as f64) / PLACE[3],
                ];
                let distance = style + terms.iter().map(|t| t * t).sum::<f64>();
                rows.push((position, row, distance));
            }
        }
        Self { rows, columns }
    }

    /// Rows with their weights for these columns of the observation.
    pub fn choices(&self, columns: &[LatticeLine], width: f64) -> Vec<Below> {
        let gap = typical_gap(columns).unwrap_or(2.0 * width);
        let own = ((columns.len().max(1) as f64).ln(), (width / gap).ln());
        let of_columns: Vec<f64> = (self.columns.iter())
            .map(|other| {
                let count = (own.0 - other.0) / STYLE[0];
                let density = (own.1 - other.1) / STYLE[4];
                count * count + density * density
            })
            .collect();
        let distance = |row: &(usize, usize, f64)| row.2 + of_columns[row.0];
        let least = self.rows.iter().map(distance).fold(f64::INFINITY, f64::min);
        let near = self
            .rows
            .iter()
            .filter(|row| distance(row) - least < 9.0 * FALL);
        near.map(|row| Below {
            example: row.0,
            row: row.1,
            weight: (-(distance(row) - least) / FALL).exp(),
        })
        .collect()
    }
}

/// A piecewise linear map through pairs of coordinates, increasing in both.
struct Warp(Vec<(f64, f64)>);

impl Warp {
    fn at(&self, x: f64) -> f64 {
        let pairs = &self.0;
        let k = pairs
            .partition_point(|p| p.0 <= x)
            .clamp(1, pairs.len() - 1);
        let (a, b) = (pairs[k - 1], pairs[k]);
        let slope = if b.0 > a.0 {
            (b.1 - a.1) / (b.0 - a.0)
        } else {
            1.0
        };
        a.1 + (x - a.0) * slope
    }

    /// The map of `[0, from]` to `[0, to]` through pairs of positions.
    fn new(from: f64, to: f64, mut pairs: Vec<(f64, f64)>) -> Self {
        pairs.push((0.0, 0.0));
        pairs.push((from, to));
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        pairs.dedup_by(|b, a| b.0 - a.0 < 1e-9 || b.1 - a.1 < 1e-9);
        if pairs.len() < 2 {
            pairs = vec![(0.0, 0.0), (from, to)];
        }
        Self(pairs)
    }
}

/// The column of `lines` on which an element stands.
fn column_of(lines: &[LatticeLine], x: f64, size: f64) -> Option<usize> {
    lines.iter().position(|l| (l.at - x).abs() < 0.35 * size)
}

/// The elements of an example below one of its rows, moved to below the lowest seen row of the observation: rows by the
/// ratio of the spaces below, what stands on a column to the columns that correspond, sizes by the ratio of windows.
pub fn below_elements(
    observation: &Observation,
    columns: &[LatticeLine],
    e: &Example,
    row: usize,
) -> Vec<Element> {
    let (Some(last), false) = (observation.rows.first(), columns.is_empty()) else {
        return Vec::new();
    };
    let down = last.at / e.rows[row].at;
    let (sx, sy) = (observation.size.0 / e.size.0, last.size / e.rows[row].size);
    let limit = e.rows[row].at - 0.5 * e.rows[row].size;
    let (n, own) = (columns.len(), e.columns.len());
    let counterpart = |q: usize| match n {
        1 => own / 2,
        _ => (q as f64 / (n - 1) as f64 * (own - 1) as f64).round() as usize,
    };
    let pairs: Vec<(f64, f64)> = if n == own {
        columns
            .iter()
            .zip(&e.columns)
            .map(|(q, d)| (d.at, q.at))
            .collect()
    } else {
        vec![
            (e.columns[0].at, columns[0].at),
            (e.columns[own - 1].at, columns[n - 1].at),
        ]
    };
    let across = Warp::new(e.layout.width, observation.partial.width, pairs);
    let mut found = Vec::new();
    for element in &e.layout.elements {
        let r = element.rect;
        let (x, y) = r.centre();
        if y >= limit {
            continue;
        }
        // Height above the ground scales with the space, offset from a row of windows with the windows.
        let base = e.rows[..row]
            .iter()
            .find(|l| (l.at - y).abs() < 1.2 * l.size);
        let high = r.height * sy;
        let ground = r.y < 0.5 * r.height;
        let (bottom, high) = match (element.class, base) {
            (Class::Window | Class::Balcony, Some(line)) => {
                (line.at * down + (y - line.at) * sy - high / 2.0, high)
            }
            _ if ground => (r.y * down, r.height * down),
            _ => (y * down - high / 2.0, high),
        };
        let column = column_of(&e.columns, x, e.size.0);
        let narrow = r.width < 2.0 * e.size.0;
        match (element.class, column) {
            (Class::Window | Class::Balcony | Class::Shop, Some(d)) if narrow => {
                for (q, line) in columns
                    .iter()
                    .enumerate()
                    .filter(|(q, _)| counterpart(*q) == d)
                {
                    // A line's own width holds for windows on it.
                    let wide = match element.class {
                        Class::Window => r.width * line.size / e.columns[counterpart(q)].size,
                        _ => r.width * sx,
                    };
                    let x = line.at + (x - e.columns[d].at) * sx - wide / 2.0;
                    found.push(Element::new(
                        element.class,
                        Rect::new(x, bottom, wide, high),
                    ));
                }
            }
            _ if narrow => {
                let mut at = across.at(x);
                if column.is_some() {
                    at = snapped(columns, at);
                }
                let wide = r.width * sx;
                found.push(Element::new(
                    element.class,
                    Rect::new(at - wide / 2.0, bottom, wide, high),
                ));
            }
            _ => {
                let (left, right) = (across.at(r.x), across.at(r.right()));
                found.push(Element::new(
                    element.class,
                    Rect::new(left, bottom, right - left, high),
                ));
            }
        }
    }
    found
}

/// The nearest line's position.
fn snapped(lines: &[LatticeLine], at: f64) -> f64 {
    let positions = lines.iter().map(|l| l.at);
    positions
        .min_by(|a, b| (a - at).abs().total_cmp(&(b - at).abs()))
        .unwrap_or(at)
}

/// A whole facade of the database, warped so that its lines lie on the seen ones.
#[derive(Debug, Clone)]
pub struct Warped {
    /// Its elements that may be added.
    pub elements: Vec<Element>,
    /// Logarithm of its weight.
    pub log_weight: f64,
}

/// The example warped to the observation: seen lines are assigned to its lines in order, each to a line of its own, with the
/// least sum of squared distances relative to the facade (dynamic programming). The weight falls with that
/// distance and rises with the agreement of the known parts. `None` where it has fewer lines.
pub fn warp(observation: &Observation, e: &Example) -> Option<Warped> {
    let (width, height) = (observation.partial.width, observation.partial.height);
    let (x_cost, x_pairs) = assign(&observation.columns, width, &e.columns, e.layout.width)?;
    let (y_cost, y_pairs) = assign(&observation.rows, height, &e.rows, e.layout.height)?;
    let across = Warp::new(e.layout.width, width, x_pairs);
    let up = Warp::new(e.layout.height, height, y_pairs);
    let (sx, sy) = (observation.size.0 / e.size.0, observation.size.1 / e.size.1);
    let map = |element: &Element| {
        let r = element.rect;
        let (x, y) = r.centre();
        let rect = if r.width < 2.5 * e.size.0 {
            let wide = r.width * sx;
            let (x, ground) = (across.at(x), r.y < 0.02 * e.layout.height);
            let high = if ground {
                up.at(r.top())
            } else {
                r.height * sy
            };
            let y = if ground { r.y } else { up.at(y) - high / 2.0 };
            Rect::new(x - wide / 2.0, y, wide, high)
        } else {
            let (left, right) = (across.at(r.x), across.at(r.right()));
            let high = r.height * sy;
            Rect::new(left, up.at(y) - high / 2.0, right - left, high)
        };
        Element::new(element.class, inside(rect, width, height))
    };
    let mapped: Vec<Element> = e.layout.elements.iter().map(map).collect();
    // Agreement on what is known: observed elements found, and invented ones on known wall.
    let near = |a: &Element, b: &Element| a.class == b.class && a.rect.iou(&b.rect) > 0.4;
    let found = observation
        .elements
        .iter()
        .filter(|o| mapped.iter().any(|m| near(o, m)))
        .count();
    let wrong = mapped.iter().filter(|m| {
        let (x, y) = m.rect.centre();
        !observation.partial.is_unknown(x, y) && !observation.elements.iter().any(|o| near(o, m))
    });
    let agreement =
        2.0 * found as f64 / (found + observation.elements.len() + wrong.count()).max(1) as f64;
    Some(Warped {
        elements: mapped
            .into_iter()
            .filter(|m| observation.partial.allows(m))
            .collect(),
        log_weight: 8.0 * agreement - x_cost - y_cost,
    })
}

/// The rectangle pushed and cut into the outline.
pub fn inside(r: Rect, width: f64, height: f64) -> Rect {
    let (w, h) = (r.width.min(width), r.height.min(height));
    let x = r.x.clamp(0.0, (width - w).max(0.0));
    let y = r.y.clamp(0.0, (height - h).max(0.0));
    Rect::new(x, y, w, h)
}

/// Assigns lines to distinct lines of an example in order; the cost, and pairs (example, observation).
fn assign(
    lines: &[LatticeLine],
    length: f64,
    others: &[LatticeLine],
    other_length: f64,
) -> Option<(f64, Vec<(f64, f64)>)> {
    let (n, m) = (lines.len(), others.len());
    if n > m {
        return None;
    }
    let cost = |i: usize, j: usize| {
        let difference = lines[i].at / length - others[j].at / other_length;
        (difference / 0.05).powi(2)
    };
    // best[i][j]: first i lines on the first j others.
    let mut best = vec![vec![f64::INFINITY; m + 1]; n + 1];
    best[0].fill(0.0);
    for i in 1..=n {
        for j in i..=m {
            best[i][j] = best[i][j - 1].min(best[i - 1][j - 1] + cost(i - 1, j - 1));
        }
    }
    let (mut i, mut j) = (n, m);
    let mut pairs = Vec::new();
    while i > 0 {
        if best[i][j] < best[i][j - 1] {
            pairs.push((others[j - 1].at, lines[i - 1].at));
            i -= 1;
        }
        j -= 1;
    }
    Some((best[n][m] / n.max(1) as f64, pairs))
}

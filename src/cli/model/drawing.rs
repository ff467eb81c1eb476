//! A discrete network as SVG: variables as boxes with their posteriors as bars, parents above children.

use std::collections::BTreeMap;
use std::fmt::Write;

use edifice_model::ModelError;
use edifice_model::network::{Evidence, Network};

/// Width of a box, and the gaps between boxes, in pixels.
const WIDTH: f64 = 168.0;
const GAP: f64 = 28.0;
const RISE: f64 = 56.0;
/// Heights of a box's head and of one bar.
const HEAD: f64 = 24.0;
const BAR: f64 = 16.0;
/// Categories shown of one variable, the most probable ones of more.
const SHOWN: usize = 8;
/// Characters of a name that fit.
const FIT: usize = 20;
/// Sweeps that order the boxes of a layer by their neighbours.
const SWEEPS: usize = 8;

/// One variable to draw.
struct Box {
    name: String,
    /// Category and probability.
    bars: Vec<(String, f64)>,
    /// True if it is given.
    given: bool,
    parents: Vec<usize>,
    /// Corner at the upper left.
    at: (f64, f64),
}

impl Box {
    fn height(&self) -> f64 {
        HEAD + BAR * self.bars.len() as f64 + 8.0
    }
}

/// The drawing, with the posterior of every discrete variable given evidence (`given` names what is observed).
///
/// # Errors
/// As [`Network::marginal`].
pub(super) fn svg(
    network: &Network,
    evidence: &Evidence,
    given: &[String],
) -> Result<String, ModelError> {
    let marginals = network.marginals(evidence)?.into_iter();
    let mut marginals: BTreeMap<String, Vec<f64>> =
        marginals.map(|a| (a.name, a.probabilities)).collect();
    let names: Vec<&str> = network.names().collect();
    let mut boxes = Vec::with_capacity(names.len());
    for name in &names {
        let parents = network.parents(name)?;
        let place = |p: &&str| names.iter().position(|n| n == p).unwrap_or(0);
        // A real vector has no bars.
        let probabilities = marginals.remove(*name).unwrap_or_default();
        let bars = network.categories(name)?.iter().cloned().zip(probabilities);
        let mut bars: Vec<(String, f64)> = bars.collect();
        if bars.len() > SHOWN {
            bars.sort_by(|a, b| b.1.total_cmp(&a.1));
            bars.truncate(SHOWN);
        }
        boxes.push(Box {
            name: (*name).to_owned(),
            bars,
            given: given.iter().any(|g| g == name),
            parents: parents.iter().map(place).collect(),
            at: (0.0, 0.0),
        });
    }
    let size = arrange(&mut boxes);
    Ok(draw(&boxes, size))
}

/// Places the boxes: layers by the longest path from a root, within a layer by the mean place of the neighbours. Returns
/// width and height of the whole.
fn arrange(boxes: &mut [Box]) -> (f64, f64) {
    let mut layer = vec![0; boxes.len()];
    // Longest paths settle after as many rounds as there are layers.
    loop {
        let next: Vec<usize> = boxes
            .iter()
            .map(|b| b.parents.iter().map(|&p| layer[p] + 1).max().unwrap_or(0))
            .collect();
        if next == layer {
            break;
        }
        layer = next;
    }
    let layers = layer.iter().max().map_or(0, |l| l + 1);
    let mut rows: Vec<Vec<usize>> = vec![Vec::new(); layers];
    for (i, &l) in layer.iter().enumerate() {
        rows[l].push(i);
    }
    let mut neighbours: Vec<Vec<usize>> = boxes.iter().map(|b| b.parents.clone()).collect();
    for (child, own) in boxes.iter().enumerate() {
        for &parent in &own.parents {
            neighbours[parent].push(child);
        }
    }
    let mut place: Vec<f64> = vec![0.0; boxes.len()];
    let spread = |rows: &[Vec<usize>], place: &mut [f64]| {
        for row in rows {
            for (k, &i) in row.iter().enumerate() {
                place[i] = k as f64 - (row.len() as f64 - 1.0) / 2.0;
            }
        }
    };
    spread(&rows, &mut place);
    for _ in 0..SWEEPS {
        for row in &mut rows {
            let mean = |i: usize| match neighbours[i].len() {
                0 => place[i],
                n => neighbours[i].iter().map(|&j| place[j]).sum::<f64>() / n as f64,
            };
            row.sort_by(|&a, &b| mean(a).total_cmp(&mean(b)));
        }
        spread(&rows, &mut place);
    }
    let widest = rows.iter().map(Vec::len).max().unwrap_or(1) as f64;
    let width = GAP + widest * (WIDTH + GAP);
    let mut top = GAP;
    for row in &rows {
        for &i in row {
            boxes[i].at = (width / 2.0 + place[i] * (WIDTH + GAP) - WIDTH / 2.0, top);
        }
        top += row.iter().map(|&i| boxes[i].height()).fold(0.0, f64::max) + RISE;
    }
    (width, top - RISE + GAP)
}

fn draw(boxes: &[Box], (width, height): (f64, f64)) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write!(
        out,
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0}" height="{height:.0}" viewBox="0 0 {width:.0} {height:.0}" font-family="sans-serif" font-size="11">
<defs><marker id="arrow" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto"><path d="M0 0L8 4L0 8z" fill="#8a939c"/></marker></defs>
<rect width="100%" height="100%" fill="#ffffff"/>
"##
    );
    for child in boxes {
        for parent in child.parents.iter().map(|&p| &boxes[p]) {
            let (x0, y0) = (parent.at.0 + WIDTH / 2.0, parent.at.1 + parent.height());
            let (x1, y1) = (child.at.0 + WIDTH / 2.0, child.at.1);
            let bend = (y1 - y0) / 2.0;
            let _ = writeln!(
                out,
                r##"<path d="M{x0:.1} {y0:.1}C{x0:.1} {:.1} {x1:.1} {:.1} {x1:.1} {y1:.1}" fill="none" stroke="#8a939c" marker-end="url(#arrow)"/>"##,
                y0 + bend,
                y1 - bend
            );
        }
    }
    for b in boxes {
        let (x, y) = b.at;
        let edge = if b.given { "#c4622d" } else { "#3b4a59" };
        let bar = if b.given { "#e0a37e" } else { "#9db8d2" };
        let _ = writeln!(
            out,
            r##"<g><rect x="{x:.1}" y="{y:.1}" width="{WIDTH}" height="{:.1}" rx="4" fill="#fbfcfd" stroke="{edge}"/><text x="{:.1}" y="{:.1}" font-weight="bold" fill="#1f2a35">{}</text>"##,
            b.height(),
            x + 8.0,
            y + 16.0,
            text(&b.name)
        );
        for (k, (category, p)) in b.bars.iter().enumerate() {
            let top = y + HEAD + BAR * k as f64;
            let _ = writeln!(
                out,
                r##"<rect x="{:.1}" y="{:.1}" width="{:.2}" height="{:.1}" fill="{bar}"/><text x="{:.1}" y="{:.1}" fill="#1f2a35">{}</text><text x="{:.1}" y="{:.1}" text-anchor="end" fill="#4a5663">{:.1} %</text>"##,
                x + 6.0,
                top + 1.0,
                (WIDTH - 12.0) * p,
                BAR - 3.0,
                x + 9.0,
                top + 11.0,
                text(category),
                x + WIDTH - 9.0,
                top + 11.0,
                100.0 * p
            );
        }
        out += "</g>\n";
    }
    out + "</svg>\n"
}

/// The part of a name that fits, for markup.
fn text(name: &str) -> String {
    let mut shown: String = name.chars().take(FIT).collect();
    if name.chars().count() > FIT {
        shown.push('…');
    }
    shown
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

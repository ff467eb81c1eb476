//! Templates of few triangles: quadric edge collapse (Garland and Heckbert 1997) by the library meshoptimizer.
//!
//! A template is closed first, where that can be, and then simplified within each of [`ERRORS`]. With t triangles, used n times,
//! it costs D + l t + m n t: D is the volume, in cubic metres, by which it then differs from the components that it stands for, in
//! height maps; l is the price of a triangle that is stored, and m, of one that is derived, is the least of 0 and a geometric
//! sequence with which the derived city has no more triangles than the input. Each template takes its cheapest error.

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::components::{CELLS, Component, SAMPLES};
use super::medoids::heights_apart;
use super::types::Types;
use edifice_grammar::instance::InstanceGrammar;
use edifice_shape::triangles::{TriangleMesh, filled, height_map, is_closed, stitched};
use meshopt::{SimplifyOptions, simplify_decoder};

/// Errors that are tried, in metres.
const ERRORS: [f64; 11] = [0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0, 3.2, 5.0];
/// Price of a stored triangle, some three bytes, in cubic metres.
const STORED: f64 = 6.0;
/// The least price of a derived triangle above 0, in cubic metres, and the number of prices, each twice the one before.
const FIRST_PRICE: f64 = 1e-3;
const PRICES: usize = 30;
/// Positions nearer than this are one, and corners nearer than this to an edge lie on it, in metres.
const TOUCHING: f64 = 2e-3;
/// A mesh of fewer triangles encloses nothing.
const LEAST_TRIANGLES: usize = 4;

/// On a grid of the unit box, corners this near to an edge lie on it.
const EXACT: f64 = 1e-9;

/// A template as it would be within an error.
struct Reduced {
    mesh: TriangleMesh,
    /// Differing volume, in cubic metres.
    apart: f64,
}

/// Gives the grammar's templates, one for each type, new meshes, with which it derives at most `most` triangles, with residuals and
/// without, if any error that is tried has so few. `on_grid` puts a mesh in the unit box on the grid of what is written.
pub(super) fn templates(
    grammar: &mut InstanceGrammar,
    components: &[Component],
    types: &Types,
    most: usize,
    on_grid: &(dyn Fn(&Component, TriangleMesh) -> TriangleMesh + Sync),
) {
    let counts = [true, false].map(|residuals| uses(grammar, residuals));
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); types.representatives.len()];
    for (i, used) in types.uses.iter().enumerate() {
        members[used.kind].push(i);
    }
    let options = |(&own, members): (&usize, &Vec<usize>)| -> Vec<Reduced> {
        let own = &components[own];
        let [w, d, h] = own.frame.size;
        let whole = closed(own);
        let mut out: Vec<Reduced> = Vec::new();
        for error in ERRORS {
            let mut mesh = simplified(&whole, error);
            for p in &mut mesh.positions {
                *p = [p[0] / w, p[1] / d, p[2] / h];
            }
            let mesh = stitched(&on_grid(own, mesh), EXACT);
            let fewer = |o: &Reduced| mesh.triangles.len() < o.mesh.triangles.len();
            if !out.last().is_none_or(fewer) {
                continue;
            }
            let heights = height_map(&mesh, CELLS, SAMPLES);
            let apart = members.iter().map(|&i| {
                let c = &components[i];
                c.frame.volume() * heights_apart(&heights, &c.heights, types.uses[i].quarter)
            });
            out.push(Reduced {
                apart: apart.sum(),
                mesh,
            });
        }
        out
    };
    let options: Vec<Vec<Reduced>> = types
        .representatives
        .par_iter()
        .zip(&members)
        .map(options)
        .collect();
    let mut derived_price = 0.0;
    let mut chosen = vec![0; options.len()];
    for _ in 0..PRICES {
        for (k, own) in options.iter().enumerate() {
            let n = counts[0][k].max(counts[1][k]) as f64;
            let price = STORED + derived_price * n;
            let cost = |o: &Reduced| o.apart + price * o.mesh.triangles.len() as f64;
            let cheapest = (0..own.len()).min_by(|&a, &b| cost(&own[a]).total_cmp(&cost(&own[b])));
            chosen[k] = cheapest.unwrap_or(0);
        }
        let derived = counts.iter().map(|own| -> usize {
            let each = own.iter().zip(&options).zip(&chosen);
            each.map(|((n, options), &c)| n * options[c].mesh.triangles.len())
                .sum()
        });
        if derived.max().unwrap_or(0) <= most {
            break;
        }
        derived_price = if derived_price == 0.0 {
            FIRST_PRICE
        } else {
            derived_price * 2.0
        };
    }
    for ((template, mut own), chosen) in grammar.templates.iter_mut().zip(options).zip(chosen) {
        template.mesh = own.swap_remove(chosen).mesh;
    }
}

/// How often each template stands in the city: in the parts that instances under the axiom state, with `residuals`, else in
/// those of their rules.
fn uses(grammar: &InstanceGrammar, residuals: bool) -> Vec<usize> {
    let templates = grammar.templates.iter().enumerate();
    let number: FxHashMap<&str, usize> = templates.map(|(i, t)| (t.symbol.as_str(), i)).collect();
    let rules = grammar.rules.iter();
    let rules: FxHashMap<&str, _> = rules.map(|r| (r.symbol.as_str(), r)).collect();
    let mut counts = vec![0; grammar.templates.len()];
    let mut count = |symbol: &str| {
        if let Some(&i) = number.get(symbol) {
            counts[i] += 1;
        }
    };
    let placed = rules.get(grammar.axiom.as_str());
    for placed in placed.into_iter().flat_map(|r| &r.successors) {
        if residuals && !placed.parts.is_empty() {
            let parts = placed.parts.iter().flatten();
            parts.for_each(|p| count(&p.symbol));
        } else if let Some(rule) = rules.get(placed.symbol.as_str()) {
            rule.successors.iter().for_each(|p| count(&p.symbol));
        }
    }
    counts
}

/// The mesh of a component in metres, without gaps where that can be had.
fn closed(component: &Component) -> TriangleMesh {
    let [w, d, h] = component.frame.size;
    let metres = TriangleMesh {
        positions: component
            .mesh
            .positions
            .iter()
            .map(|p| [p[0] * w, p[1] * d, p[2] * h])
            .collect(),
        triangles: component.mesh.triangles.clone(),
    };
    let met = stitched(&metres.welded(TOUCHING), TOUCHING);
    match is_closed(&met) {
        true => met,
        false => filled(&met, TOUCHING),
    }
}

/// A mesh in metres with as few triangles as an `error` in metres allows. Its corners are among those of the mesh; what is closed
/// stays so.
fn simplified(mesh: &TriangleMesh, error: f64) -> TriangleMesh {
    let narrow = |p: &[f64; 3]| p.map(|v| v as f32);
    let positions: Vec<[f32; 3]> = mesh.positions.iter().map(narrow).collect();
    let options = SimplifyOptions::ErrorAbsolute | SimplifyOptions::Prune;
    let indices = mesh.triangles.as_flattened();
    let kept = simplify_decoder(indices, &positions, 0, error as f32, options, None);
    if kept.len() < 3 * LEAST_TRIANGLES {
        return mesh.clone();
    }
    TriangleMesh {
        positions: mesh.positions.clone(),
        triangles: kept.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
    }
}

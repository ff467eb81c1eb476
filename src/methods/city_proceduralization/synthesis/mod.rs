//! New cities from a grammar's buildings, within a drawn shape (Fig. 9).
//!
//! The new city is quilted from patches of the grammar's city: groups of buildings that stand near each other are copied with the streets
//! and yards between them, and patches are chosen so that streets go on across their seams (`quilt`). The paper does not say how its new
//! cities are made.
//!
//! Whether buildings overlap is read off a grid of 1 m: inner points of a new building must find cells that no other
//! building covers. A building also brings the open ground that is nearer to it than to any other building of its city: no other may
//! stand there, so that streets and yards stay open. Buildings of a grammar overlap a little, since their shapes are those of
//! types; the few that overlap most with larger ones are not copied, except those within the walls of theirs, as a tower on its base is.

mod amount;
mod exemplar;
mod footprint;
mod groups;
mod lattice;
mod occupancy;
mod patches;
mod quilt;
mod raster;
mod shape;
mod sources;

use self::exemplar::Exemplar;
use self::quilt::quilt;
pub use self::shape::Shape;
use self::shape::rotated;
use self::sources::sources;
use super::arrangement::arrange;
use edifice_base::Watch;
use edifice_grammar::instance::{Grid, InstanceGrammar, InstanceGrammarError, InstanceRule};

/// The grid on which copies stand: centimetres and hundredths of degrees.
const GRID: Grid = Grid {
    length: 100.0,
    turn: 100.0,
};

/// A grammar over the same templates and rules whose axiom fills `shape`; buildings are named `s1`, `s2`, ....
///
/// # Errors
/// [`InstanceGrammarError`]; the grammar is checked whole first.
pub fn synthesize(
    grammar: &InstanceGrammar,
    shape: &Shape,
    seed: u64,
    watch: &Watch,
) -> Result<InstanceGrammar, InstanceGrammarError> {
    let mut successors = Vec::new();
    let (buildings, near) = sources(grammar)?;
    let city = Exemplar::new(buildings, &near);
    let copies = city.iter().flat_map(|c| {
        quilt(c, shape, seed, watch)
            .into_iter()
            .map(move |copy| (c, copy))
    });
    for (i, (city, copy)) in copies.enumerate() {
        let source = &city.buildings[copy.source];
        for placed in &source.placed {
            let mut placed = placed.clone();
            let turn = copy.turn - source.turn;
            let [x, y] = rotated(
                [placed.at[0] - source.at[0], placed.at[1] - source.at[1]],
                turn,
            );
            let round = |v: f64, steps: f64| (v * steps).round() / steps;
            placed.at = [
                round(copy.at[0] + x, GRID.length),
                round(copy.at[1] + y, GRID.length),
                // Copies stand on level ground.
                round(placed.at[2] - source.at[2], GRID.length),
            ];
            placed.turn = round((placed.turn + turn).rem_euclid(360.0), GRID.turn) % 360.0;
            placed.id = Some(format!("s{}", i + 1));
            placed.attributes.clear();
            successors.push(placed);
        }
    }
    let mut out = grammar.flat(None);
    for rule in out.rules.iter_mut().filter(|r| r.symbol == out.axiom) {
        let symbol = rule.symbol.clone();
        *rule = InstanceRule::new(symbol, 1.0, std::mem::take(&mut successors));
    }
    Ok(arrange(&out, &GRID))
}

//! Districts, blocks and rows: the tree of a city's grammar beside its flat one, and an edit that rows follow.

use std::collections::BTreeMap;

use super::data;
use edifice_base::{Error, Result, unwatched};
use edifice_city_proceduralization::morphology::{CityPlan, Square};
use edifice_city_proceduralization::{Mode, proceduralize};
use edifice_frame::Context;
use edifice_grammar::instance::{Begins, Grid, InstanceGrammar};
use edifice_io_city::compact;
use edifice_io_city::picture::{Drawing, Drawn, View, draw};
use edifice_report::{Align, Table};

/// Buildings of the edit are so many times as long along their rows.
const WIDER: f64 = 1.3;
/// The grid on which the buildings of the flat grammar lie: centimetres and hundredths of degrees.
const GRID: Grid = Grid {
    length: 100.0,
    turn: 100.0,
};
/// Colours of blocks, in turn.
const COLOURS: [[u8; 3]; 6] = [
    [0x4e, 0x79, 0xa7],
    [0xf2, 0x8e, 0x2b],
    [0x59, 0xa1, 0x4f],
    [0xe1, 0x57, 0x59],
    [0xb0, 0x7a, 0xa1],
    [0xed, 0xc9, 0x48],
];
/// Colour of a building that is a block of its own.
const ALONE: [u8; 3] = [0xd0, 0xcb, 0xc6];

/// Tells the tree of each city, its bytes beside those of the flat grammar, and how much buildings overlap when all that stand in rows
/// are made wider, in the tree and in the flat grammar.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let seed = ctx.seed();
    let side = ctx.budget().choose(150.0, 700.0, 700.0);
    let mut table = Table::new("Districts, blocks and rows of city grammars")
        .column("city", Align::Left)
        .column("measure", Align::Left)
        .numbers(["value"]);
    let mut is_drawn = false;
    for (name, city) in data::three_cities(ctx)? {
        let made = proceduralize(&city, &data::settings(Mode::Best, 4, seed), &unwatched)
            .map_err(Error::method)?;
        let tree = made.grammar;
        let flat = tree.flat(Some(&GRID));
        let begins = tree.beginnings();
        let count = |least: Begins| begins.iter().filter(|b| **b >= least).count() as f64;
        let rows = tree.rules.iter().filter(|r| r.row);
        let rows: Vec<usize> = rows.map(|r| r.successors.len()).collect();
        let bytes = |g: &InstanceGrammar| -> Result<f64> {
            Ok(compact::to_bytes(g).map_err(Error::method)?.len() as f64)
        };
        let derived = tree.derive().map_err(Error::method)?.city(&tree);
        let squares = CityPlan::new(&derived).squares(side);
        let overlap = |g: &InstanceGrammar| overlap(g, &squares);
        let factors = along_rows(&tree);
        let measures = [
            ("buildings", begins.len() as f64),
            ("districts", count(Begins::District)),
            ("blocks", count(Begins::Block)),
            ("rows", rows.len() as f64),
            (
                "share of buildings in rows",
                rows.iter().sum::<usize>() as f64 / begins.len() as f64,
            ),
            (
                "buildings of the longest row",
                rows.iter().copied().max().unwrap_or(0) as f64,
            ),
            ("bytes, flat", bytes(&flat)?),
            ("bytes, tree", bytes(&tree)?),
            ("overlap", overlap(&tree)?),
            ("overlap, wider, flat", overlap(&wider(&flat, &factors))?),
            ("overlap, wider, tree", overlap(&wider(&tree, &factors))?),
        ];
        for (measure, value) in measures {
            let key = measure.replace([' ', ','], "_").replace("__", "_");
            ctx.observe(data::row(&name, "best", "tree", &key, value, ""));
            let text = match value.fract() == 0.0 {
                true => format!("{value}"),
                false => format!("{value:.4}"),
            };
            table.row(vec![name.clone(), measure.to_owned(), text]);
        }
        // One city says it, a real one: the blocks of the made one are its motifs.
        if name == data::MADE || std::mem::replace(&mut is_drawn, true) {
            continue;
        }
        let drawing = Drawing {
            width: ctx.budget().choose(160, 320, 640),
            height: ctx.budget().choose(120, 240, 480),
            view: View::Plan,
            around: None,
        };
        let shown = Drawn {
            city: &derived,
            colours: Some(&colours(&begins)),
        };
        let picture = draw(&[shown], &drawing, &Vec::new()).map_err(Error::method)?;
        ctx.attach(
            &format!("town_plan_{name}.png"),
            &picture,
            &format!("{name}: blocks of buildings, their colours taken in turn"),
        )?;
    }
    ctx.table(&table);
    ctx.note(format!("Blocks: buildings with less than 6 m between their rectangles. Rows: buildings of one direction that share at least 3 m of wall. Bytes: the compact file with identifiers, in centimetres, of the grammar with districts, blocks and rows, and of the same buildings right under the axiom. Overlap: share of plan area under another building, in squares of {side} m; wider: each type of building of which most instances in rows lie along their row by their width is {WIDER} times as wide, others that stand in rows {WIDER} times as deep. In the tree the rest of a row moves aside; in the flat grammar each building stays where it is."));
    Ok(())
}

/// Of each type that stands in rows, the axis (0: width, 1: depth) along which most of its instances lie.
fn along_rows(tree: &InstanceGrammar) -> BTreeMap<String, usize> {
    let mut votes: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    for placed in tree
        .rules
        .iter()
        .filter(|r| r.row)
        .flat_map(|r| &r.successors)
    {
        let quarters = (placed.turn / 90.0).round() as usize;
        votes.entry(placed.symbol.clone()).or_default()[quarters % 2] += 1;
    }
    let axis = |[w, d]: [usize; 2]| usize::from(d > w);
    votes
        .into_iter()
        .map(|(symbol, v)| (symbol, axis(v)))
        .collect()
}

fn wider(grammar: &InstanceGrammar, axes: &BTreeMap<String, usize>) -> InstanceGrammar {
    let mut out = grammar.clone();
    for rule in &mut out.rules {
        if let Some(&axis) = axes.get(&rule.symbol) {
            rule.scale[axis] *= WIDER;
        }
    }
    out
}

fn overlap(grammar: &InstanceGrammar, squares: &[Square]) -> Result<f64> {
    let city = grammar.derive().map_err(Error::method)?.city(grammar);
    Ok(CityPlan::new(&city)
        .measure(squares)
        .map_or(0.0, |m| m.overlap))
}

/// The colours of buildings, in the order in which they are derived.
fn colours(begins: &[Begins]) -> Vec<[u8; 3]> {
    let mut block = 0;
    let mut blocks = Vec::new();
    for begin in begins {
        block += usize::from(*begin >= Begins::Block);
        blocks.push(block);
    }
    let alone = |k: usize| {
        let same = |other: Option<&usize>| other == Some(&blocks[k]);
        !(same(blocks.get(k + 1)) || k > 0 && same(blocks.get(k - 1)))
    };
    let colour = |k: usize| match alone(k) {
        true => ALONE,
        false => COLOURS[blocks[k] % COLOURS.len()],
    };
    (0..begins.len()).map(colour).collect()
}

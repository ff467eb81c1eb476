//! A plan as a grammar of one kind.

use super::kind::Kind;
use super::plan::{Tile, TilePlan};
use crate::composition::run;
use crate::draft::{Draft, Part, leaf};
use crate::elements::door;
use edifice_grammar::Grammar;
use edifice_shape::Axis;

impl TilePlan {
    /// The grammar of a kind; all kinds derive the same terminals.
    pub(crate) fn grammar(&self, name: &str, kind: Kind) -> Grammar {
        let mut writer = Writer::new(self);
        let width: u32 = writer.tiles[0].iter().map(|tile| tile.width).sum();
        let plinth = leaf("plinth", width, 30);
        let cornice = leaf("cornice", width, 35);
        let (columns, floors) = (0..self.sides.len(), 0..self.heights.len());
        let last = floors.end - 1;
        let parts = match kind {
            Kind::FloorsFirst => {
                let all = floors.map(|f| writer.floor(f, columns.clone())).collect();
                let all = writer.runs(Axis::Y, all);
                [vec![plinth], all, vec![cornice]].concat()
            }
            Kind::ColumnsFirst => {
                let bays = columns.map(|c| writer.bay(c)).collect();
                vec![plinth, writer.sequence("Body", Axis::X, bays), cornice]
            }
            Kind::Interleaved => {
                let ground = writer.sections(0..1, "Ground");
                let upper = writer.sections(1..floors.end, "Upper");
                vec![plinth, ground, upper, cornice]
            }
            Kind::Symmetric => vec![plinth, writer.wings(), cornice],
            Kind::Nested => {
                let ground = writer.sections(0..1, "Ground");
                let storeys = 1..last;
                let storeys = storeys.map(|f| writer.sections(f..f + 1, "Storey"));
                let storeys = storeys.collect();
                let main = writer.sequence("Main", Axis::Y, storeys);
                let top = writer.sections(last..last + 1, "TopFloor");
                let base = writer.draft.stack("Base", vec![plinth, ground]);
                let top = writer.draft.stack("Top", vec![top, cornice]);
                vec![base, main, top]
            }
        };
        let root = writer.draft.stack("Facade", parts);
        writer.draft.finish(name, &root)
    }
}

struct Writer<'a> {
    plan: &'a TilePlan,
    draft: Draft,
    /// `tiles[floor][column]`.
    tiles: Vec<Vec<Part>>,
}

impl<'a> Writer<'a> {
    fn new(plan: &'a TilePlan) -> Self {
        let mut draft = Draft::default();
        let tiles = plan.tiles.iter().zip(&plan.heights).map(|(row, &height)| {
            let tiles = row.iter().zip(&plan.sides);
            tiles
                .map(|(&what, &side)| tile(&mut draft, plan, what, side, height))
                .collect()
        });
        let tiles = tiles.collect();
        Self { plan, draft, tiles }
    }

    /// Tiles of one floor, side by side.
    fn floor(&mut self, floor: usize, columns: std::ops::Range<usize>) -> Part {
        let tiles = self.tiles[floor][columns].to_vec();
        self.sequence("Floor", Axis::X, tiles)
    }

    /// Tiles of one column, on top of each other.
    fn bay(&mut self, column: usize) -> Part {
        let tiles = self.tiles.iter().map(|row| row[column].clone()).collect();
        self.sequence("Bay", Axis::Y, tiles)
    }

    /// Some columns of some floors: floors on top of each other.
    fn block(&mut self, floors: std::ops::Range<usize>, columns: std::ops::Range<usize>) -> Part {
        let floors = floors.map(|f| self.floor(f, columns.clone())).collect();
        self.sequence("Section", Axis::Y, floors)
    }

    /// All sections of some floors, as blocks.
    fn blocks(&mut self, floors: std::ops::Range<usize>) -> Vec<Part> {
        let mut start = 0;
        let mut blocks = Vec::new();
        for &columns in &self.plan.sections {
            blocks.push(self.block(floors.clone(), start..start + columns));
            start += columns;
        }
        blocks
    }

    /// All sections of some floors, side by side.
    fn sections(&mut self, floors: std::ops::Range<usize>, name: &str) -> Part {
        let blocks = self.blocks(floors);
        self.sequence(name, Axis::X, blocks)
    }

    /// Wing, centre, wing; without a middle section, two wings.
    fn wings(&mut self) -> Part {
        let mut left = self.blocks(0..self.plan.heights.len());
        let mut centre = left.split_off(left.len() / 2);
        let right = centre.split_off(centre.len() - left.len());
        let left = self.sequence("Wing", Axis::X, left);
        let right = self.sequence("Wing", Axis::X, right);
        let parts = [vec![left], centre, vec![right]].concat();
        self.draft.row("Body", parts)
    }

    /// Parts along an axis; all of them one repeat where they have one period.
    fn sequence(&mut self, name: &str, axis: Axis, parts: Vec<Part>) -> Part {
        let (period, times) = run(&parts);
        if times > 1 && period * times as usize == parts.len() {
            return self.repeat(name, axis, parts[..period].to_vec(), times);
        }
        let parts = self.runs(axis, parts);
        match axis {
            Axis::X => self.draft.row(name, parts),
            Axis::Y => self.draft.stack(name, parts),
        }
    }

    /// The parts with each run of equal neighbours, or of pairs that alternate, made one repeat.
    fn runs(&mut self, axis: Axis, parts: Vec<Part>) -> Vec<Part> {
        let mut joined = Vec::new();
        let mut rest = &parts[..];
        while !rest.is_empty() {
            let (period, times) = run(rest);
            if times > 1 {
                joined.push(self.repeat("Run", axis, rest[..period].to_vec(), times));
                rest = &rest[period * times as usize..];
            } else {
                joined.push(rest[0].clone());
                rest = &rest[1..];
            }
        }
        joined
    }

    fn repeat(&mut self, name: &str, axis: Axis, period: Vec<Part>, times: u32) -> Part {
        match axis {
            Axis::X => self.draft.repeat(name, period, times),
            Axis::Y => self.draft.repeat_up(name, period, times),
        }
    }
}

/// A window or a door between walls.
fn tile(draft: &mut Draft, plan: &TilePlan, what: Tile, side: u32, height: u32) -> Part {
    let middle = match what {
        Tile::Window(kind, change) => plan.style.column(draft, kind, height, change),
        Tile::Door => door(draft, plan.style.column, height),
    };
    let wall = leaf("wall", side, height);
    draft.row("Tile", vec![wall.clone(), middle, wall])
}

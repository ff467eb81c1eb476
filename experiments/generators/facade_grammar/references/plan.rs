//! The plan of a reference: tiles in rows and columns, in the rhythms of a kind.

use rand::RngExt;

use super::kind::Kind;
use crate::elements::{Break, Glazing, Style};
use crate::theme::Rhythm;
use edifice_base::rng::Stream;

/// A tile's content.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Tile {
    /// A window of a kind of the style, perhaps one that breaks the rhythm.
    Window(usize, Option<Break>),
    /// A door.
    Door,
}

/// A layout before its terminals are cut.
#[derive(Debug, Clone)]
pub(crate) struct TilePlan {
    /// Sizes and kinds of windows.
    pub style: Style,
    /// Wall on each side of the window or door, by column.
    pub sides: Vec<u32>,
    /// Height of each floor, the ground floor first.
    pub heights: Vec<u32>,
    /// `tiles[floor][column]`.
    pub tiles: Vec<Vec<Tile>>,
    /// Number of columns of each section, left to right.
    pub sections: Vec<usize>,
}

/// Kinds of windows, by floor and column.
type Kinds = Vec<Vec<usize>>;

/// Windows that stand together on one facade.
const GLAZING: &[&[Glazing]] = &[
    &[Glazing::Plain, Glazing::Sash],
    &[Glazing::Plain, Glazing::Shutters],
    &[Glazing::Casement, Glazing::Transom],
    &[Glazing::Sash, Glazing::Casement, Glazing::Plain],
    &[Glazing::Lattice, Glazing::Plain],
];

/// Rhythms of a floor, or of a bay from bottom to top.
const RHYTHMS: &[Rhythm] = &[
    Rhythm::Same,
    Rhythm::Alternate,
    Rhythm::Ends,
    Rhythm::Middle,
    Rhythm::Pairs,
];

/// Rhythms that mirror themselves.
const MIRRORED: &[Rhythm] = &[Rhythm::Same, Rhythm::Ends, Rhythm::Middle, Rhythm::Mirror];

impl TilePlan {
    /// Draws a layout of a kind.
    pub(crate) fn draw(rng: &mut Stream, kind: Kind) -> Self {
        let glazing = GLAZING[rng.random_range(0..GLAZING.len())];
        let mut style = Style::draw(rng, glazing);
        if rng.random_bool(0.4) {
            style = style.with_balconies();
        }
        let mut designer = Designer {
            kinds: style.kinds(),
            side: style.gap.max(60) / 2,
            rng,
        };
        let floors = designer.rng.random_range(3..=6);
        let (sections, sides, kinds) = match kind {
            Kind::FloorsFirst => designer.floors(floors),
            Kind::ColumnsFirst => designer.bays(floors),
            Kind::Interleaved => designer.sections(floors),
            Kind::Symmetric => designer.wings(floors),
            Kind::Nested => designer.tripartite(floors),
        };
        let mut tiles: Vec<Vec<Tile>> = kinds
            .into_iter()
            .map(|floor| floor.into_iter().map(|k| Tile::Window(k, None)).collect())
            .collect();
        for column in designer.doors(kind, &sections) {
            tiles[0][column] = Tile::Door;
        }
        designer.break_rhythm(&mut tiles);
        let mut heights = vec![style.floor; floors];
        heights[0] += 20;
        if designer.rng.random_bool(0.5) {
            heights[floors - 1] -= 40;
        }
        Self {
            style,
            sides,
            heights,
            tiles,
            sections,
        }
    }
}

struct Designer<'a> {
    rng: &'a mut Stream,
    /// Number of kinds of windows.
    kinds: usize,
    /// Usual wall beside a window.
    side: u32,
}

impl Designer<'_> {
    /// Kinds of windows in one of the rhythms.
    fn rhythm(&mut self, rhythms: &[Rhythm], n: usize) -> Vec<usize> {
        let rhythm = rhythms[self.rng.random_range(0..rhythms.len())];
        let first = self.rng.random_range(0..self.kinds);
        (0..n)
            .map(|i| (first + rhythm.kind(i, n)) % self.kinds)
            .collect()
    }

    /// `count` rows of `n`; a row above the first often repeats the one before.
    fn rows(&mut self, rhythms: &[Rhythm], count: usize, n: usize) -> Kinds {
        let mut rows: Kinds = Vec::new();
        for _ in 0..count {
            let row = match rows.last() {
                Some(before) if self.rng.random_bool(0.55) => before.clone(),
                _ => self.rhythm(rhythms, n),
            };
            rows.push(row);
        }
        rows
    }

    /// Wall beside the windows of a bay or section that has its own.
    fn own_side(&mut self) -> u32 {
        self.side + 10 * self.rng.random_range(0..=2)
    }

    /// Each floor has a rhythm.
    fn floors(&mut self, floors: usize) -> (Vec<usize>, Vec<u32>, Kinds) {
        let columns = self.rng.random_range(4..=8);
        let kinds = self.rows(RHYTHMS, floors, columns);
        (thirds(columns), vec![self.side; columns], kinds)
    }

    /// Each bay has a rhythm from floor to floor; the ground floor has its own.
    fn bays(&mut self, floors: usize) -> (Vec<usize>, Vec<u32>, Kinds) {
        let columns = self.rng.random_range(4..=8);
        let bays = self.rows(RHYTHMS, columns, floors - 1);
        let mut sides = Vec::new();
        for c in 0..columns {
            let side = match sides.last() {
                Some(&side) if bays[c] == bays[c - 1] => side,
                _ => self.own_side(),
            };
            sides.push(side);
        }
        let mut kinds = vec![self.rhythm(&[Rhythm::Same], columns)];
        kinds.extend((0..floors - 1).map(|f| bays.iter().map(|bay| bay[f]).collect()));
        (thirds(columns), sides, kinds)
    }

    /// Two designs of sections, each with floors of its own, above a ground floor.
    fn sections(&mut self, floors: usize) -> (Vec<usize>, Vec<u32>, Kinds) {
        let designs: Vec<(u32, Kinds)> = (1..=2)
            .map(|least| {
                let columns = self.rng.random_range(least..=3);
                (self.own_side(), self.rows(RHYTHMS, floors - 1, columns))
            })
            .collect();
        let orders: [&[usize]; 4] = [&[0, 1, 0], &[0, 0, 1], &[0, 1, 0, 1], &[1, 0, 1]];
        let order = orders[self.rng.random_range(0..orders.len())];
        let width = |design: usize| designs[design].1[0].len();
        let sections: Vec<usize> = order.iter().map(|&d| width(d)).collect();
        let sides = order.iter().flat_map(|&d| vec![designs[d].0; width(d)]);
        let columns = sections.iter().sum();
        let mut kinds = vec![self.rhythm(&[Rhythm::Same], columns)];
        for floor in 0..floors - 1 {
            let parts = order.iter().flat_map(|&d| designs[d].1[floor].clone());
            kinds.push(parts.collect());
        }
        (sections, sides.collect(), kinds)
    }

    /// Equal wings, each its own mirror image, about a centre.
    fn wings(&mut self, floors: usize) -> (Vec<usize>, Vec<u32>, Kinds) {
        let wing = self.rng.random_range(2..=3);
        let middle = [1, 3][self.rng.random_range(0..2)];
        let of_wing = self.rows(MIRRORED, floors, wing);
        let of_middle = self.rows(MIRRORED, floors, middle);
        let centre = self.own_side();
        let mut sides = vec![self.side; wing];
        sides.extend(vec![centre; middle]);
        sides.extend(vec![self.side; wing]);
        let kinds = of_wing.iter().zip(&of_middle);
        let kinds = kinds.map(|(wing, middle)| [&wing[..], middle, wing].concat());
        (vec![wing, middle, wing], sides, kinds.collect())
    }

    /// One section several times; ground floor, storeys and top floor differ.
    fn tripartite(&mut self, floors: usize) -> (Vec<usize>, Vec<u32>, Kinds) {
        let columns = self.rng.random_range(2..=3);
        let times = self.rng.random_range(2..=3);
        let mut section = vec![self.rhythm(RHYTHMS, columns)];
        section.extend(self.rows(RHYTHMS, floors - 2, columns));
        section.push(self.rhythm(RHYTHMS, columns));
        let kinds = section.iter().map(|floor| floor.repeat(times)).collect();
        let sides = vec![self.side; columns * times];
        (vec![columns; times], sides, kinds)
    }

    /// Columns that have a door: the middle of a symmetric facade, each section of a nested one, else any.
    fn doors(&mut self, kind: Kind, sections: &[usize]) -> Vec<usize> {
        let columns: usize = sections.iter().sum();
        match kind {
            Kind::Symmetric => vec![columns / 2],
            Kind::Nested => {
                let at = self.rng.random_range(0..sections[0]);
                (0..sections.len()).map(|s| s * sections[0] + at).collect()
            }
            _ => vec![self.rng.random_range(0..columns)],
        }
    }

    /// On every second facade one window above the ground floor differs from what the rhythm asks for.
    fn break_rhythm(&mut self, tiles: &mut [Vec<Tile>]) {
        if self.rng.random_bool(0.5) {
            return;
        }
        let floor = self.rng.random_range(1..tiles.len());
        let column = self.rng.random_range(0..tiles[floor].len());
        let change = [Break::Blind, Break::Narrow, Break::Low][self.rng.random_range(0..3)];
        if let Tile::Window(_, broken) = &mut tiles[floor][column] {
            *broken = Some(change);
        }
    }
}

/// Side, middle, side.
fn thirds(columns: usize) -> Vec<usize> {
    let side = columns / 3;
    vec![side, columns - 2 * side, side]
}

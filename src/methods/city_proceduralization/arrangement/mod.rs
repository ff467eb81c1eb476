//! Districts, blocks and rows of a city: the rules between the axiom and the buildings, which do the placing.
//!
//! The paper groups types that stand near each other again and again, and its tree has one root (Sec. V); where no two buildings are
//! quite alike, nothing repeats, and the tree is flat. Here the tree is that of a town plan. Buildings of one direction with a wall in
//! common are a row; rows and buildings with less than a street between them are a block; blocks are in districts, which are halved
//! until they have few blocks. All of it is read off the rectangles that instances state, so that a city that is derived and read again has
//! the same tree.

mod blocks;
mod rectangle;
mod rows;

use self::blocks::blocks;
use self::rectangle::Rectangle;
use self::rows::rows;
use edifice_grammar::instance::{Begins, Grid, InstanceGrammar, Placement, Places};

/// A district has at most so many blocks.
const DISTRICT: usize = 48;

/// A flat grammar, whose buildings lie on a grid, with districts, blocks and rows.
pub fn arrange(grammar: &InstanceGrammar, grid: &Grid) -> InstanceGrammar {
    let mut out = grammar.clone();
    let Some(top) = out.top_mut() else {
        return out;
    };
    let mut members = std::mem::take(&mut top.successors);
    // Not by how they are listed.
    members.sort_by(compared);
    let places = Places::new(grammar);
    let plan: Vec<Rectangle> = members.iter().map(|p| rectangle(p, &places)).collect();
    let order = order(&plan);
    let mut from: Vec<Option<Placement>> = members.into_iter().map(Some).collect();
    let listed = order.iter().filter_map(|(i, _)| from[*i].take());
    top.successors = listed.collect();
    let begins: Vec<Begins> = order.iter().map(|(_, begins)| *begins).collect();
    out.arranged(&begins, grid)
}

fn compared(a: &Placement, b: &Placement) -> std::cmp::Ordering {
    let numbers = |p: &Placement| {
        let mut all = p.at.to_vec();
        all.push(p.turn);
        all.extend(&p.numbers);
        all
    };
    let (x, y) = (numbers(a), numbers(b));
    let unequal = x.iter().zip(&y).map(|(v, w)| v.total_cmp(w));
    let first = unequal.into_iter().find(|o| o.is_ne());
    first
        .unwrap_or_else(|| x.len().cmp(&y.len()))
        .then_with(|| a.symbol.cmp(&b.symbol))
}

fn rectangle(placed: &Placement, places: &Places) -> Rectangle {
    Rectangle {
        at: [placed.at[0], placed.at[1]],
        turn: placed.turn,
        half: places.sides(placed).map(|v| v / 2.0),
    }
}

/// The buildings in the order of districts, blocks and rows, and what each begins.
fn order(plan: &[Rectangle]) -> Vec<(usize, Begins)> {
    let rows = rows(plan);
    let blocks = blocks(plan, &rows);
    let first = |block: &usize| plan[rows[blocks[*block][0]][0]].at;
    let mut tour = Tour {
        plan,
        listed: Vec::with_capacity(plan.len()),
    };
    let districts = halved((0..blocks.len()).collect(), DISTRICT, &first);
    // The blocks of a town of one district stand right under the axiom.
    let block_begins = match districts.len() {
        1 => Begins::District,
        _ => Begins::Block,
    };
    for district in districts {
        let mut blocks: Vec<Vec<&[usize]>> = district
            .into_iter()
            .map(|b| blocks[b].iter().map(|&r| &rows[r][..]).collect())
            .collect();
        let mut begins = Begins::District;
        while let Some(block) = tour.nearest(&blocks, |block| tour.away_block(block)) {
            let mut rows = blocks.swap_remove(block);
            while let Some(row) = tour.nearest(&rows, |row| tour.away_row(row)) {
                tour.list(rows.swap_remove(row), begins);
                begins = Begins::Row;
            }
            begins = block_begins;
        }
    }
    tour.listed
}

/// A walk past all rows, from each to the nearest that is left, since what stands near the building before it is written in few bits.
struct Tour<'p> {
    plan: &'p [Rectangle],
    listed: Vec<(usize, Begins)>,
}

impl Tour<'_> {
    /// Metres from the building before, and a building that tells apart what is equally far.
    fn away(&self, i: usize) -> (f64, usize) {
        let far = |&(last, _): &(usize, Begins)| {
            let [p, q] = [last, i].map(|k| self.plan[k].at);
            (p[0] - q[0]).hypot(p[1] - q[1])
        };
        (self.listed.last().map_or(0.0, far), i)
    }

    /// To the nearer end of a row.
    fn away_row(&self, row: &[usize]) -> (f64, usize) {
        let ends = [row[0], row[row.len() - 1]].map(|i| self.away(i));
        if closer(&ends[1], &ends[0]).is_lt() {
            ends[1]
        } else {
            ends[0]
        }
    }

    fn away_block(&self, block: &[&[usize]]) -> (f64, usize) {
        let rows = block.iter().map(|row| self.away_row(row));
        rows.min_by(closer).unwrap_or((f64::INFINITY, 0))
    }

    fn nearest<T>(&self, things: &[T], away: impl Fn(&T) -> (f64, usize)) -> Option<usize> {
        let far: Vec<(f64, usize)> = things.iter().map(away).collect();
        (0..far.len()).min_by(|&a, &b| closer(&far[a], &far[b]))
    }

    /// Lists a row from its nearer end on.
    fn list(&mut self, row: &[usize], mut begins: Begins) {
        let from_first = self.away_row(row).1 == row[0];
        for k in 0..row.len() {
            let k = if from_first { k } else { row.len() - 1 - k };
            self.listed.push((row[k], begins));
            begins = Begins::Nothing;
        }
    }
}

fn closer(a: &(f64, usize), b: &(f64, usize)) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}

/// Halves a list across the longer side of its extent, in the middle of the order along it, until no part has more than `most`.
fn halved(mut list: Vec<usize>, most: usize, at: &impl Fn(&usize) -> [f64; 2]) -> Vec<Vec<usize>> {
    if list.len() <= most {
        return vec![list];
    }
    let extent = |axis: usize| {
        let values = || list.iter().map(|i| at(i)[axis]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let axis = usize::from(extent(1) > extent(0));
    list.sort_by(|a, b| at(a)[axis].total_cmp(&at(b)[axis]).then(a.cmp(b)));
    let second = list.split_off(list.len() / 2);
    let mut out = halved(list, most, at);
    out.extend(halved(second, most, at));
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;
    use edifice_grammar::instance::InstanceRule;
    use rand::RngExt;
    use rand::seq::SliceRandom;

    const GRID: Grid = Grid {
        length: 100.0,
        turn: 100.0,
    };

    /// Terraces of a random town and houses at random, on the grid.
    fn town(seed: u64) -> InstanceGrammar {
        let mut rng = stream(seed, "towns", 0);
        let round = |v: f64| (v * 100.0).round() / 100.0;
        let mut city = Vec::new();
        for _ in 0..rng.random_range(1..100) {
            let corner = [0, 1].map(|_| rng.random_range(-900.0..900.0));
            let turn = round(rng.random_range(0.0..359.9));
            let (sin, cos) = f64::to_radians(turn).sin_cos();
            let mut along = 0.0;
            for _ in 0..rng.random_range(1..9) {
                let [w, d] = [0, 1].map(|_| round(rng.random_range(2.0..14.0)));
                let quarter = rng.random_range(0..4);
                let numbers = if quarter % 2 == 0 { [w, d] } else { [d, w] };
                let (x, y) = (along + w / 2.0, rng.random_range(-2.0..2.0));
                let at = [corner[0] + x * cos - y * sin, corner[1] + x * sin + y * cos];
                let z = rng.random_range(0.0..5.0);
                let mut placed = Placement::new("B1", [at[0], at[1], z].map(round), 0.0, [1.0; 3]);
                placed.turn = round((turn + 90.0 * f64::from(quarter)) % 360.0) % 360.0;
                placed.numbers = vec![numbers[0], numbers[1], 6.0];
                placed.id = Some(format!("b{}", city.len()));
                city.push(placed);
                along += w + rng.random_range(-0.2..0.7);
            }
        }
        let one = Placement::new("T1", [0.0; 3], 0.0, [1.0; 3]);
        let building = InstanceRule {
            levels: 1,
            ..InstanceRule::new("B1", 1.0, vec![one])
        };
        InstanceGrammar {
            axiom: "City".to_owned(),
            templates: vec![edifice_grammar::instance::Template {
                symbol: "T1".to_owned(),
                mesh: Default::default(),
                texture: None,
            }],
            rules: vec![InstanceRule::new("City", 1.0, city), building],
            ..InstanceGrammar::default()
        }
    }

    fn by_identifier(grammar: &InstanceGrammar) -> Vec<Placement> {
        let mut all = grammar.rules[0].successors.clone();
        all.sort_by(|a, b| a.id.cmp(&b.id));
        all
    }

    #[test]
    fn a_town_that_is_arranged_becomes_flat_again() {
        let (mut rows, mut districts) = (0, 0);
        for seed in 0..200 {
            let town = town(seed);
            let tree = arrange(&town, &GRID);
            tree.check().unwrap();
            let flat = tree.flat(Some(&GRID));
            assert!(by_identifier(&flat) == by_identifier(&town), "town {seed}");
            assert!(
                flat.arranged(&tree.beginnings(), &GRID) == tree,
                "town {seed}"
            );
            // What is derived differs from it by less than half a step, so that it rounds to it.
            let (a, b) = (town.derive().unwrap(), tree.derive().unwrap());
            for (i, (id, _)) in b.buildings.iter().enumerate() {
                let k = a
                    .buildings
                    .iter()
                    .position(|(other, _)| other == id)
                    .unwrap();
                let far = [0, 1, 2].map(|x| (a.instances[k].at[x] - b.instances[i].at[x]).abs());
                assert!(far.iter().all(|f| *f < 0.0011), "{far:?}");
            }
            rows += tree.rules.iter().filter(|r| r.row).count();
            districts += usize::from(tree.rules.iter().any(|r| r.symbol.starts_with('D')));
        }
        assert!(rows > 1000 && districts > 3, "{rows} {districts}");
    }

    #[test]
    fn the_order_of_buildings_is_no_matter() {
        for seed in 0..40 {
            let mut town = town(seed);
            let tree = arrange(&town, &GRID);
            town.rules[0]
                .successors
                .shuffle(&mut stream(seed, "shuffle", 0));
            assert!(arrange(&town, &GRID) == tree, "town {seed}");
        }
    }

    #[test]
    fn a_wider_type_pushes_the_rest_of_its_row_aside() {
        let house = |k: usize| {
            let mut placed = Placement::new("B1", [6.0 * k as f64, 0.0, 0.0], 0.0, [1.0; 3]);
            placed.numbers = vec![6.0, 9.0, 6.0];
            placed.id = Some(format!("b{k}"));
            placed
        };
        let mut town = town(0);
        town.rules[0].successors = (0..5).map(house).collect();
        let mut tree = arrange(&town, &GRID);
        tree.rules[1].scale = [1.5, 1.0, 1.0];
        let places = tree.derive().unwrap();
        let along: Vec<f64> = places.instances.iter().map(|i| i.at[0]).collect();
        assert_eq!(along, [0.0, 9.0, 18.0, 27.0, 36.0]);
    }
}

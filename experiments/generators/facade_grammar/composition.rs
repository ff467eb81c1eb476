//! Floors, wings, bodies: from elements to a whole facade.

use rand::RngExt;

use super::draft::{Draft, Part, leaf};
use super::elements::{Break, Style, door, dormer, pilaster, shop};
use super::theme::{Attic, Body, Ground, Theme};
use edifice_base::rng::Stream;

/// The content of one column of one floor: the kind of window, and a break of the rhythm.
type Cell = (usize, Option<Break>);

/// Designs a facade.
pub(crate) fn compose(draft: &mut Draft, rng: &mut Stream, theme: &Theme, style: &Style) -> Part {
    let style = match theme.balconies {
        0 => style.clone(),
        _ => style.clone().with_balconies(),
    };
    let mut designer = Designer {
        draft,
        rng,
        theme,
        style: &style,
    };
    let columns = designer.between(theme.columns);
    let floors = designer.between(theme.floors);
    designer.facade(columns, floors)
}

struct Designer<'a> {
    draft: &'a mut Draft,
    rng: &'a mut Stream,
    theme: &'a Theme,
    style: &'a Style,
}

impl Designer<'_> {
    fn between(&mut self, (low, high): (u32, u32)) -> u32 {
        self.rng.random_range(low..=high)
    }

    fn facade(&mut self, columns: u32, floors: u32) -> Part {
        let height = (self.style.floor + self.style.cornice) * floors;
        let body = match self.theme.body {
            Body::Plain => self.wing(columns, floors, "Body"),
            Body::Projection => {
                let side = (columns / 3).max(1);
                let wing = self.wing(side, floors, "Wing");
                let middle = self.tall_part(columns - 2 * side, floors, height, "Projection");
                let other = match self.rng.random_bool(0.6) {
                    true => wing.clone(),
                    false => self.wing(side, floors, "Wing"),
                };
                self.draft.row("Body", vec![wing, middle, other])
            }
            Body::Towers => {
                let tower = self.tall_part(1, floors, height, "Tower");
                let middle = self.wing(columns - 2, floors, "Middle");
                self.draft.row("Body", vec![tower.clone(), middle, tower])
            }
            Body::Stair => {
                let left = self.rng.random_range(2..=columns / 2);
                let wing = self.wing(left, floors, "Wing");
                let stair = self.stair(floors, height);
                let other = self.wing(columns - left, floors, "Wing");
                self.draft.row("Body", vec![wing, stair, other])
            }
            Body::Side => {
                let bay = self.tall_part(1, floors, height, "Bay");
                let main = self.wing(columns - 1, floors, "Main");
                let parts = match self.rng.random_bool(0.5) {
                    true => vec![bay, main],
                    false => vec![main, bay],
                };
                self.draft.row("Body", parts)
            }
        };
        let width = body.width;
        let mut parts = vec![leaf("plinth", width, 30)];
        parts.push(self.ground(width, columns));
        parts.push(leaf("cornice", width, 30));
        parts.push(body);
        parts.push(leaf("cornice", width, 35));
        match self.theme.attic {
            Attic::None => parts.push(leaf("roof", width, 60)),
            Attic::Dormers => {
                let roof = self.dormers(width, columns);
                parts.push(roof);
            }
            Attic::Low => {
                let low = self.low_floor(width, columns);
                parts.push(low);
                parts.push(leaf("cornice", width, 25));
            }
        }
        self.draft.stack("Facade", parts)
    }

    /// Floors on top of each other; a floor often repeats the one below it.
    fn wing(&mut self, columns: u32, floors: u32, name: &str) -> Part {
        let plans = self.plans(columns, floors);
        let running = match self.theme.balconies {
            2 => Some(self.rng.random_range(0..floors)),
            _ => None,
        };
        let mut parts = Vec::new();
        for (f, plan) in plans.iter().enumerate() {
            let rail = if running == Some(f as u32) { 40 } else { 0 };
            let floor = self.floor(plan, self.style.floor - rail, "Floor");
            let width = floor.width;
            parts.push(leaf("balcony", width, rail));
            parts.push(floor);
            parts.push(leaf("cornice", width, self.style.cornice));
        }
        self.draft.stack(name, parts)
    }

    /// The content of each column of each floor.
    fn plans(&mut self, columns: u32, floors: u32) -> Vec<Vec<Cell>> {
        let mut plans: Vec<Vec<Cell>> = Vec::new();
        for f in 0..floors {
            let repeats = f > 0 && self.rng.random_bool(0.55);
            let plan = match plans.last() {
                Some(below) if repeats => below.clone(),
                _ => self.plan(columns),
            };
            plans.push(plan);
        }
        for _ in 0..self.between(self.theme.breaks) {
            let f = self.rng.random_range(0..floors as usize);
            let c = self.rng.random_range(0..columns as usize);
            let kinds = [Break::Blank, Break::Blind, Break::Narrow, Break::Low];
            plans[f][c].1 = Some(kinds[self.rng.random_range(0..4)]);
        }
        plans
    }

    /// One floor's kinds of windows, in one of the theme's rhythms.
    fn plan(&mut self, columns: u32) -> Vec<Cell> {
        let rhythms = self.theme.rhythms;
        let rhythm = rhythms[self.rng.random_range(0..rhythms.len())];
        let kinds = self.style.kinds();
        let first = self.rng.random_range(0..kinds);
        let n = columns as usize;
        (0..n)
            .map(|i| rhythm.kind(i, n))
            .map(|kind| ((first + kind) % kinds, None))
            .collect()
    }

    /// One floor: columns between walls; equal neighbours become a repeat, alternating ones pairs.
    fn floor(&mut self, plan: &[Cell], height: u32, name: &str) -> Part {
        let edge = 25;
        let gap = match self.theme.pilasters {
            true => {
                let side = leaf("wall", 15, height);
                let shaft = pilaster(self.draft, self.style.gap.max(60) - 30, height);
                self.draft.row("Pier", vec![side.clone(), shaft, side])
            }
            false => leaf("wall", self.style.gap.max(60), height),
        };
        let columns: Vec<Part> = plan
            .iter()
            .map(|&(kind, change)| self.style.column(self.draft, kind, height, change))
            .collect();
        let mut parts = vec![leaf("wall", edge, height), gap.clone()];
        let mut i = 0;
        while i < columns.len() {
            let (period, mut times) = run(&columns[i..]);
            // The last wall of the floor belongs to its edge, not to a period.
            if i + period * times as usize == columns.len() {
                times -= 1;
            }
            if times > 1 {
                let inner = columns[i..i + period].iter();
                let inner = inner.flat_map(|c| [c.clone(), gap.clone()]).collect();
                parts.push(self.draft.repeat("Run", inner, times));
                i += period * times as usize;
            } else {
                parts.push(columns[i].clone());
                parts.push(gap.clone());
                i += 1;
            }
        }
        parts.push(leaf("wall", edge, height));
        self.draft.row(name, parts)
    }

    /// A part of the same height with one floor fewer, so that its floors do not line up.
    fn tall_part(&mut self, columns: u32, floors: u32, height: u32, name: &str) -> Part {
        let own = if floors > 2 { floors - 1 } else { floors };
        let plan = self.plan(columns);
        let each = height / own / 5 * 5;
        let mut parts = Vec::new();
        for f in 0..own {
            let floor = match f + 1 == own {
                true => height - each * (own - 1),
                false => each,
            };
            let band = 15;
            let part = self.floor(&plan, floor - band, "HighFloor");
            let width = part.width;
            parts.push(part);
            parts.push(leaf("cornice", width, band));
        }
        self.draft.stack(name, parts)
    }

    /// A stair: windows half a floor higher than the others.
    fn stair(&mut self, floors: u32, height: u32) -> Part {
        let width = self.style.column + 40;
        let storey = self.style.floor + self.style.cornice;
        let mut parts = vec![leaf("wall", width, storey / 2)];
        for f in 0..floors {
            let last = f + 1 == floors;
            let part = if last { storey - storey / 2 } else { storey };
            let tall = (part / 2).min(130);
            let side = leaf("wall", 20, tall);
            let window = leaf("window", width - 40, tall);
            let row = self
                .draft
                .row("StairWindow", vec![side.clone(), window, side]);
            parts.push(row);
            parts.push(leaf("wall", width, part - tall));
        }
        let built: u32 = parts.iter().map(|p| p.height).sum();
        parts.push(leaf("wall", width, height - built));
        self.draft.stack("Stair", parts)
    }

    fn ground(&mut self, width: u32, columns: u32) -> Part {
        let height = self.style.floor + 20;
        match self.theme.ground {
            Ground::Door => self.ground_with_door(width, columns, height),
            Ground::Shops => {
                let count = (columns / 2).clamp(1, 4);
                self.ground_with(width, height, count, true)
            }
            Ground::Arcade => {
                let count = (columns * 2 / 3).max(2);
                self.ground_with(width, height, count, false)
            }
        }
    }

    /// Windows as above, with a door in one column.
    fn ground_with_door(&mut self, width: u32, columns: u32, height: u32) -> Part {
        let (column, gap) = (self.style.column, self.style.gap.max(60));
        let fit = ((width - 40 + gap) / (column + gap)).min(columns).max(1);
        let left = (width - fit * column - (fit - 1) * gap) / 2;
        let at = self.rng.random_range(0..fit);
        let kind = self.rng.random_range(0..self.style.kinds());
        let mut parts = vec![leaf("wall", left, height)];
        for i in 0..fit {
            let part = match i == at {
                true => door(self.draft, column, height),
                false => self.style.column(self.draft, kind, height, None),
            };
            parts.push(part);
            if i + 1 < fit {
                parts.push(leaf("wall", gap, height));
            }
        }
        let built: u32 = parts.iter().map(|p| p.width).sum();
        parts.push(leaf("wall", width - built, height));
        self.draft.row("Ground", parts)
    }

    /// Shops or arches between piers, with one door among them.
    fn ground_with(&mut self, width: u32, height: u32, count: u32, shops: bool) -> Part {
        let pier = if shops { 30 } else { 50 };
        let entrance = 150;
        let room = width - entrance - pier * (count + 2);
        let each = room / count / 5 * 5;
        let at = self.rng.random_range(0..=count);
        let awning = self.rng.random_bool(0.5);
        let panes = (each / 160).clamp(1, 3);
        let mut parts = Vec::new();
        for i in 0..=count {
            parts.push(self.pier(pier, height));
            let part = match i == at {
                true => door(self.draft, entrance, height),
                false if shops => shop(self.draft, each, height, panes, awning),
                false => self.arch(each, height),
            };
            parts.push(part);
        }
        let built: u32 = parts.iter().map(|p| p.width).sum();
        parts.push(leaf("wall", width - built, height));
        self.draft.row("Ground", parts)
    }

    fn pier(&mut self, width: u32, height: u32) -> Part {
        match self.theme.pilasters {
            true => pilaster(self.draft, width, height),
            false => leaf("wall", width, height),
        }
    }

    /// A large opening under a lintel.
    fn arch(&mut self, width: u32, height: u32) -> Part {
        let tall = height - 70;
        let frame = leaf("frame", 10, tall);
        let glass = leaf("window", width - 20, tall);
        let opening = self.draft.row("Opening", vec![frame.clone(), glass, frame]);
        let parts = vec![opening, leaf("lintel", width, 25), leaf("wall", width, 45)];
        self.draft.stack("Arch", parts)
    }

    /// Dormers, one fewer than columns, centred.
    fn dormers(&mut self, width: u32, columns: u32) -> Part {
        let (height, each) = (220, 130);
        let count = (columns - 1).clamp(1, (width - 60) / (each + 50));
        let gap = (width - count * each) / (count + 1) / 5 * 5;
        let glazing = self.theme.glazing[0];
        let dormer = dormer(self.draft, self.style, glazing, each, height);
        let gap = leaf("roof", gap, height);
        let run = self
            .draft
            .repeat("DormerRun", vec![dormer, gap.clone()], count);
        let rest = width - run.width;
        let parts = vec![leaf("roof", rest, height), run];
        self.draft.row("Roof", parts)
    }

    /// Small windows, closer than those below.
    fn low_floor(&mut self, width: u32, columns: u32) -> Part {
        let height = 130;
        let count = columns + 1;
        let each = (width / (count * 2) / 5 * 5).min(100);
        let gap = (width - count * each) / (count + 1) / 5 * 5;
        let window = leaf("window", each, 70);
        let parts = vec![leaf("wall", each, 30), window, leaf("wall", each, 30)];
        let column = self.draft.stack("LowWindow", parts);
        let gap = leaf("wall", gap, height);
        let run = self.draft.repeat("LowRun", vec![column, gap], count);
        let rest = width - run.width;
        self.draft
            .row("LowFloor", vec![leaf("wall", rest, height), run])
    }
}

/// The period (1 or 2 columns) with which the columns start over, and how often it stands there.
pub(crate) fn run(columns: &[Part]) -> (usize, u32) {
    let times = |period: usize| {
        let mut n = 1;
        while columns.len() >= (n + 1) * period
            && columns[n * period..(n + 1) * period] == columns[..period]
        {
            n += 1;
        }
        n
    };
    match times(1) {
        1 => (2, times(2) as u32),
        n => (1, n as u32),
    }
}

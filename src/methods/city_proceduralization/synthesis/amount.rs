//! Amounts of buildings, by which a new city is kept as dense as the old one.

use super::exemplar::Exemplar;
use super::footprint::CELL;

/// Some buildings of a city, counted.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Amount {
    /// Blocks; of one that is cut, the share of its buildings.
    blocks: f64,
    buildings: f64,
    /// Square metres of plan.
    pub(super) area: f64,
    /// Attached buildings, and the sums over buildings of the gap to the next block, of the side of a square as large as the plan,
    /// and of the height, in metres.
    sums: [f64; 4],
}

impl Amount {
    pub(super) fn of(city: &Exemplar, buildings: impl Iterator<Item = usize>) -> Self {
        let mut amount = Self::default();
        for b in buildings {
            let source = &city.buildings[b];
            let area = source.footprint.points() as f64 * CELL * CELL;
            let (mut attached, mut gap) = (0.0, 0.0);
            if let Some(own) = source.neighbourhood {
                amount.blocks += 1.0 / own.block_size as f64;
                attached = f64::from(u8::from(own.attached));
                gap = own.gap;
            }
            amount.buildings += 1.0;
            amount.area += area;
            let own = [attached, gap, area.sqrt(), source.height];
            amount.sums = std::array::from_fn(|k| amount.sums[k] + own[k]);
        }
        amount
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        Self {
            blocks: self.blocks + other.blocks,
            buildings: self.buildings + other.buildings,
            area: self.area + other.area,
            sums: std::array::from_fn(|k| self.sums[k] + other.sums[k]),
        }
    }

    pub(super) fn times(&self, factor: f64) -> Self {
        Self {
            blocks: self.blocks * factor,
            buildings: self.buildings * factor,
            area: self.area * factor,
            sums: self.sums.map(|v| v * factor),
        }
    }

    /// The sum of the absolute logarithms of the ratios of area, buildings, blocks a building and each other sum a building.
    pub(super) fn unlike(&self, other: &Self) -> f64 {
        let ratio = |new: f64, old: f64| ((new + 1.0) / (old + 1.0)).ln();
        let buildings = ratio(self.buildings, other.buildings);
        let a_building = |new, old| (ratio(new, old) - buildings).abs();
        let sums = self.sums.iter().zip(other.sums);
        ratio(self.area, other.area).abs()
            + buildings.abs()
            + a_building(self.blocks, other.blocks)
            + sums.map(|(&new, old)| a_building(new, old)).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn amount(blocks: f64, buildings: f64, area: f64) -> Amount {
        Amount {
            blocks,
            buildings,
            area,
            sums: [1.0, 2.0 * buildings, 3.0 * buildings, 4.0 * buildings],
        }
    }

    #[test]
    fn amounts_add_up_and_are_unlike_by_their_ratios() {
        let (one, other) = (amount(2.0, 5.0, 400.0), amount(1.0, 4.0, 300.0));
        let both = one.plus(&other);
        assert_eq!((both.blocks, both.buildings, both.area), (3.0, 9.0, 700.0));
        assert_eq!(both.sums, [2.0, 18.0, 27.0, 36.0]);
        let twice = one.times(2.0);
        assert_eq!((twice.blocks, twice.buildings), (4.0, 10.0));
        assert_eq!(one.unlike(&one), 0.0);
        // Twice the area alone, up to the one that is added to either.
        let dense = Amount { area: 800.0, ..one };
        let expected = (801.0_f64 / 401.0).ln();
        assert!((dense.unlike(&one) - expected).abs() < 1e-12);
        assert!((one.unlike(&dense) - expected).abs() < 1e-12);
    }
}

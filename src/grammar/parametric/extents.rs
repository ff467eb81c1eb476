//! Width and height of a facade in steps.
//!
//! A number is a bucket of eighths of octaves and a place in it, all places alike. The bucket is mixed from those
//! of the library, each spread over its neighbours, and from all alike.

use super::coder::Coder;
use super::tree::STEP_LIMIT;

/// Buckets in an octave.
const FINE: f64 = 8.0;

/// The bucket of each extent that was seen, for one axis.
#[derive(Debug, Clone, Default)]
pub struct ExtentTable {
    seen: Vec<f64>,
}

fn bucket(extent: u32) -> usize {
    (f64::from(extent).log2() * FINE + 1e-9).floor() as usize
}

/// First extent of each bucket, and one past the last extent.
fn starts() -> Vec<u32> {
    let buckets = bucket(STEP_LIMIT) + 1;
    let mut starts = vec![STEP_LIMIT + 1; buckets + 1];
    let mut extent = STEP_LIMIT;
    // Boundaries are found from above by the same rounding that finds the bucket of an extent.
    for k in (0..buckets).rev() {
        let low = 2f64.powf(k as f64 / FINE);
        let mut first = (low.floor() as u32).clamp(1, extent);
        while first > 1 && bucket(first - 1) >= k {
            first -= 1;
        }
        while first <= extent && bucket(first) < k {
            first += 1;
        }
        starts[k] = first;
        extent = first.saturating_sub(1).max(1);
    }
    starts
}

impl ExtentTable {
    /// Adds an extent, or takes it away.
    pub fn change(&mut self, extent: u32, more: bool) {
        let at = bucket(extent);
        if self.seen.len() <= at {
            self.seen.resize(at + 1, 0.0);
        }
        self.seen[at] = (self.seen[at] + if more { 1.0 } else { -1.0 }).max(0.0);
    }

    /// Chooses an extent.
    pub fn choose<C: Coder>(&self, coder: &mut C, value: Option<u32>) -> Option<u32> {
        let starts = starts();
        let buckets = starts.len() - 1;
        let weights: Vec<f64> = (0..buckets)
            .map(|k| {
                if starts[k] >= starts[k + 1] {
                    return 0.0;
                }
                let near = self
                    .seen
                    .iter()
                    .enumerate()
                    .map(|(l, n)| n * (-(k.abs_diff(l) as f64) / 1.2).exp());
                near.sum::<f64>() + 0.02
            })
            .collect();
        let at = coder.choose(&weights, value.map(bucket))?;
        let width = starts[at + 1] - starts[at];
        let inner = value.map(|v| (v - starts[at]) as usize);
        let inner = coder.choose(&vec![1.0; width as usize], inner)?;
        Some(starts[at] + inner as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckets_cover_every_extent_once() {
        let starts = starts();
        for extent in (1..5000).chain([65535, 65536]) {
            let k = bucket(extent);
            assert!((starts[k]..starts[k + 1]).contains(&extent), "{extent}");
        }
    }
}

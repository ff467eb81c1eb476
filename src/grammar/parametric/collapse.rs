//! Runs of equal periods as repeats.
//!
//! A string of symbols is written as items: a part costs 1, a repeat of a period of `p` symbols
//! [`REPEAT`] + [`PERIOD`] `p`. The cheapest writing is found by dynamic programming over prefixes; of equal
//! ones that with the fewest items, then that whose last item covers the most symbols, then that of the
//! shortest period. The writing depends on the string alone, so that equal strings become equal rules.

use super::rules::{Item, Symbol};

/// Cost of a repeat.
const REPEAT: f64 = 0.9;

/// Cost of each symbol in the period of a repeat.
const PERIOD: f64 = 0.6;

/// Longest period.
const LONGEST: usize = 24;

/// The items of a string, and how often the period of each repeat stands. `O(n^2 p)` comparisons at most.
pub(super) fn collapse(symbols: &[Symbol]) -> (Vec<Item>, Vec<u32>) {
    let n = symbols.len();
    // Least cost and number of items of each prefix, with the last item's period (0 a part) and count.
    let mut best: Vec<(f64, usize, usize, usize)> = vec![(f64::INFINITY, 0, 0, 0); n + 1];
    best[0] = (0.0, 0, 0, 0);
    for end in 1..=n {
        let (cost, items, ..) = best[end - 1];
        best[end] = (cost + 1.0, items + 1, 0, 1);
        for period in 1..=(end / 2).min(LONGEST) {
            let mut count = 1;
            let last = &symbols[end - period..end];
            while (count + 1) * period <= end
                && &symbols[end - (count + 1) * period..end - count * period] == last
            {
                count += 1;
                let (cost, items, ..) = best[end - count * period];
                let cost = cost + REPEAT + PERIOD * period as f64;
                let own = &mut best[end];
                let covered = if own.2 == 0 { 1 } else { own.2 * own.3 };
                let closer = (cost - own.0).abs() < 1e-9
                    && (items + 1, n - count * period, period) < (own.1, n - covered, own.2);
                if cost < own.0 - 1e-9 || closer {
                    *own = (cost, items + 1, period, count);
                }
            }
        }
    }
    let (mut items, mut counts) = (Vec::new(), Vec::new());
    let mut end = n;
    while end > 0 {
        let (_, _, period, count) = best[end];
        if period == 0 {
            items.push(Item::Part(symbols[end - 1]));
            end -= 1;
        } else {
            items.push(Item::Repeat(symbols[end - period..end].to_vec()));
            counts.push(count as u32);
            end -= period * count;
        }
    }
    items.reverse();
    counts.reverse();
    (items, counts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn string(text: &str) -> Vec<Symbol> {
        text.bytes().map(|b| Symbol::Terminal(b.into())).collect()
    }

    fn expand(items: &[Item], counts: &[u32]) -> Vec<Symbol> {
        let mut counts = counts.iter();
        let mut out = Vec::new();
        for item in items {
            let times = if item.is_repeat() {
                *counts.next().unwrap()
            } else {
                1
            };
            for _ in 0..times {
                out.extend_from_slice(item.symbols());
            }
        }
        out
    }

    #[test]
    fn alternating_parts_become_one_repeat_whatever_their_number() {
        let (short, counts) = collapse(&string("abababa"));
        assert_eq!(counts, [3]);
        let (long, counts) = collapse(&string("abababababa"));
        assert_eq!(counts, [5]);
        assert_eq!(short, long);
        assert_eq!(short.len(), 2);
    }

    /// Cost, items, symbols before the last item, its period and its count, by trying every last item of every prefix.
    fn cheapest(symbols: &[Symbol]) -> Vec<(f64, usize, usize, usize, usize)> {
        let mut best = vec![(0.0, 0, 0, 0, 1)];
        for end in 1..=symbols.len() {
            let before = best[end - 1];
            let mut ways = vec![(before.0 + 1.0, before.1 + 1, end - 1, 0, 1)];
            for period in 1..=end / 2 {
                let last = &symbols[end - period..end];
                for count in 2..=end / period {
                    let start = end - count * period;
                    if symbols[start..end].chunks(period).all(|c| c == last) {
                        let cost = best[start].0 + REPEAT + PERIOD * period as f64;
                        ways.push((cost, best[start].1 + 1, start, period, count));
                    }
                }
            }
            let least = ways.iter().map(|w| w.0).fold(f64::INFINITY, f64::min);
            ways.retain(|w| w.0 < least + 1e-9);
            best.push(*ways.iter().min_by_key(|w| (w.1, w.2, w.3)).unwrap());
        }
        best
    }

    proptest! {
        #[test]
        fn of_equal_writings_the_one_with_the_fewest_items_is_taken(text in "[abc]{1,14}") {
            let symbols = string(&text);
            let (items, _) = collapse(&symbols);
            let best = cheapest(&symbols);
            let (mut periods, mut end) = (Vec::new(), symbols.len());
            while end > 0 {
                periods.push(best[end].3.max(1));
                end = best[end].2;
            }
            periods.reverse();
            let found: Vec<usize> = items.iter().map(|i| i.symbols().len()).collect();
            prop_assert_eq!(found, periods, "{}", text);
        }

        #[test]
        fn items_write_the_string(text in "[ab]{1,30}") {
            let symbols = string(&text);
            let (items, counts) = collapse(&symbols);
            prop_assert_eq!(expand(&items, &counts), symbols);
        }
    }
}

//! Exact inference over the lines of a lattice along one axis.
//!
//! The axis `[0, length]` is cut into bins; lines lie at centres of bins. With positions `x_1 < ... < x_n`, gaps
//! `g_i = x_{i+1} - x_i` and the extent `s` of elements,
//!
//! ```text
//! p(x, n) = p(g_1 | s) p(x_1 | g_1) * prod_{i >= 2} (1 - e(r_i)) p(g_i | g_{i-1}, x_i) * e(r_n),   r_i = (length - x_i) / g_{i-1}
//! ```
//! where `e` is the probability that a line is the last one, and each factor is normalised over the bins that it can
//! choose, so that the whole is a distribution. Conditions: a line at every observed bin, none between that is not paid
//! for: an invented line at bin `b` multiplies by `evidence[b]`.
//!
//! The state of the chain is (position, previous gap). Backward sums give the normaliser, forward draws are exact and
//! independent, maxima in place of sums give the most probable lines. O(bins * gaps^2).

use rand::Rng;

use super::density::Spacing;

/// Lines along one axis, to be inferred.
#[derive(Debug, Clone, PartialEq)]
pub struct LineProblem {
    /// Length of the axis in bins.
    pub bins: usize,
    /// Extent of elements in bins.
    pub size: f64,
    /// Bins that hold an observed line, increasing.
    pub observed: Vec<usize>,
    /// Factor of an invented line in each bin.
    pub evidence: Vec<f64>,
    /// Least gap in bins.
    pub least: usize,
    /// Largest gap in bins.
    pub most: usize,
}

/// Sums or maxima over all continuations.
pub struct Chain<'a> {
    problem: &'a LineProblem,
    spacing: &'a Spacing,
    most: bool,
    /// Gaps: from `least`, this many.
    gaps: usize,
    /// `p(k' | k)` before normalization, row by row.
    ratios: Vec<f64>,
    /// Running sums of each row of `ratios`.
    running: Vec<f64>,
    /// Value of state (position, gap), divided by `exp(scale[position])`.
    values: Vec<f64>,
    scale: Vec<f64>,
}

impl<'a> Chain<'a> {
    /// Runs backward over all states; `most` for maxima, otherwise sums.
    pub fn new(problem: &'a LineProblem, spacing: &'a Spacing, most: bool) -> Self {
        let least = problem.least.max(1);
        let gaps = (problem.most.min(problem.bins) + 1).saturating_sub(least);
        let mut ratios = vec![0.0; gaps * gaps];
        let mut running = vec![0.0; gaps * gaps];
        // `ratio` is a density of the logarithm: a bin has the share 1 / gap of it.
        for k in 0..gaps {
            let mut sum = 0.0;
            for next in 0..gaps {
                let ratio = (next + least) as f64 / (k + least) as f64;
                let value = spacing.ratio.at(ratio) / (next + least) as f64;
                sum += value;
                ratios[k * gaps + next] = value;
                running[k * gaps + next] = sum;
            }
        }
        let mut chain = Self {
            problem,
            spacing,
            most,
            gaps,
            ratios,
            running,
            values: vec![0.0; problem.bins * gaps],
            scale: vec![f64::NEG_INFINITY; problem.bins],
        };
        for position in (0..problem.bins).rev() {
            chain.fill(position);
        }
        chain
    }

    fn least(&self) -> usize {
        self.problem.least.max(1)
    }

    /// Position of a bin's centre.
    fn at(bin: usize) -> f64 {
        bin as f64 + 0.5
    }

    /// Probability that the lines end at `position` after the gap with index `k`.
    fn end(&self, position: usize, k: usize) -> f64 {
        let left = self.problem.bins as f64 - Self::at(position);
        let gap = (k + self.least()) as f64;
        // Without room for another line the end is certain.
        match self.room(position) {
            0 => 1.0,
            _ => self.spacing.ending.at(left / gap),
        }
    }

    /// Number of gaps that stay within the axis after `position`.
    fn room(&self, position: usize) -> usize {
        (self.problem.bins - position)
            .saturating_sub(self.least())
            .min(self.gaps)
    }

    /// Number of gaps after `position` that pass no observed line, and whether the lines may end there.
    fn reach(&self, position: usize) -> (usize, bool) {
        let observed = &self.problem.observed;
        let next = observed.partition_point(|&o| o <= position);
        match observed.get(next) {
            None => (self.room(position), true),
            Some(&next) => {
                let reach = (next - position + 1).saturating_sub(self.least());
                (reach.min(self.room(position)), false)
            }
        }
    }

    /// Factor of a line at `bin`: 1 for an observed one, else the evidence there.
    fn factor(&self, bin: usize) -> f64 {
        match self.problem.observed.binary_search(&bin) {
            Ok(_) => 1.0,
            Err(_) => self.problem.evidence[bin],
        }
    }

    fn fill(&mut self, position: usize) {
        let (reach, may_end) = self.reach(position);
        let first = position + self.least();
        let ahead = (0..reach).map(|k| self.scale[first + k]);
        let top = ahead.fold(if may_end { 0.0 } else { f64::NEG_INFINITY }, f64::max);
        if top == f64::NEG_INFINITY {
            return;
        }
        let next: Vec<f64> = (0..reach)
            .map(|k| {
                let value = self.values[(first + k) * self.gaps + k];
                value * (self.scale[first + k] - top).exp() * self.factor(first + k)
            })
            .collect();
        let mut values = vec![0.0; self.gaps];
        for (k, value) in values.iter_mut().enumerate() {
            let end = self.end(position, k);
            if may_end {
                *value = end * (-top).exp();
            }
            if reach == 0 {
                continue;
            }
            let row = &self.ratios[k * self.gaps..(k + 1) * self.gaps];
            let share = (1.0 - end) / self.running[k * self.gaps + self.room(position) - 1];
            let terms = row.iter().zip(&next).map(|(p, v)| p * v);
            if self.most {
                *value = terms.fold(*value, |best, term| best.max(share * term));
            } else {
                *value += share * terms.sum::<f64>();
            }
        }
        let largest = values.iter().copied().fold(0.0, f64::max);
        if largest > 0.0 {
            self.scale[position] = top + largest.ln();
            for (k, value) in values.into_iter().enumerate() {
                self.values[position * self.gaps + k] = value / largest;
            }
        }
    }

    /// Weights of all starts (first position, index of the first gap), and the logarithm of their unit.
    fn starts(&self) -> (Vec<(f64, usize, usize)>, f64) {
        let (bins, least) = (self.problem.bins, self.least());
        let first_observed = self.problem.observed.first().copied().unwrap_or(bins);
        let gap_share = |k: usize| {
            let gap = (k + least) as f64;
            self.spacing.first.at(gap / self.problem.size) / gap
        };
        let fits = |k: usize| k + least < bins;
        let gap_total: f64 = (0..self.gaps).filter(|&k| fits(k)).map(gap_share).sum();
        let mut starts = Vec::new();
        for k in (0..self.gaps).filter(|&k| fits(k)) {
            let gap = (k + least) as f64;
            let border = |x: usize| self.spacing.border.at(Self::at(x) / gap) / Self::at(x);
            let positions = 0..bins - k - least;
            let total: f64 = positions.clone().map(border).sum();
            for x in positions.take_while(|&x| x <= first_observed) {
                let second = x + k + least;
                let next = self.problem.observed.partition_point(|&o| o <= x);
                let passed = self.problem.observed.get(next).is_some_and(|&o| o < second);
                if !passed && self.scale[second] > f64::NEG_INFINITY {
                    let prior = gap_share(k) / gap_total * border(x) / total;
                    let value = self.values[second * self.gaps + k];
                    let weight = prior * value * self.factor(x) * self.factor(second);
                    starts.push((weight.ln() + self.scale[second], x, k));
                }
            }
        }
        let top = starts.iter().map(|s| s.0).fold(f64::NEG_INFINITY, f64::max);
        for start in &mut starts {
            start.0 = (start.0 - top).exp();
        }
        (starts, top)
    }

    /// Logarithm of the sum (or of the largest) of the weights of all sets of lines that meet the conditions;
    /// minus infinity where there is none.
    pub fn log_value(&self) -> f64 {
        let (starts, top) = self.starts();
        let weights = starts.iter().map(|s| s.0);
        let value = match self.most {
            true => weights.fold(0.0, f64::max),
            false => weights.sum(),
        };
        top + value.ln()
    }

    /// Lines by bins: exact draws for sums, the most probable ones for maxima. Empty where no set of at least
    /// two lines meets the conditions.
    pub fn draw<R: Rng>(&self, count: usize, rng: &mut R) -> Vec<Vec<usize>> {
        let (starts, top) = self.starts();
        if top == f64::NEG_INFINITY {
            return Vec::new();
        }
        let weights: Vec<f64> = starts.iter().map(|s| s.0).collect();
        (0..count)
            .map(|_| {
                let (_, first, k) = starts[self.choose(&weights, rng)];
                self.follow(first, k, rng)
            })
            .collect()
    }

    fn choose<R: Rng>(&self, weights: &[f64], rng: &mut R) -> usize {
        if self.most {
            let best = |best: usize, index: usize| {
                if weights[index] > weights[best] {
                    index
                } else {
                    best
                }
            };
            return (0..weights.len()).fold(0, best);
        }
        super::categorical(weights, rng)
    }

    fn follow<R: Rng>(&self, first: usize, mut k: usize, rng: &mut R) -> Vec<usize> {
        let least = self.least();
        let mut lines = vec![first, first + k + least];
        loop {
            let position = lines[lines.len() - 1];
            let (reach, may_end) = self.reach(position);
            let end = self.end(position, k);
            let ahead = (0..reach).map(|next| self.scale[position + least + next]);
            let top = ahead.fold(if may_end { 0.0 } else { f64::NEG_INFINITY }, f64::max);
            let mut weights = vec![if may_end { end * (-top).exp() } else { 0.0 }];
            if reach > 0 {
                let share = (1.0 - end) / self.running[k * self.gaps + self.room(position) - 1];
                weights.extend((0..reach).map(|next| {
                    let bin = position + least + next;
                    let value = self.values[bin * self.gaps + next];
                    let unit = (self.scale[bin] - top).exp();
                    share * self.ratios[k * self.gaps + next] * value * unit * self.factor(bin)
                }));
            }
            match self.choose(&weights, rng) {
                0 => return lines,
                choice => {
                    k = choice - 1;
                    lines.push(position + least + k);
                }
            }
        }
    }
}

/// Logarithm of the weight of one set of lines, factor by factor: what the chain sums, written down once more
/// without states. Minus infinity where the conditions are not met.
pub fn log_weight(problem: &LineProblem, spacing: &Spacing, lines: &[usize]) -> f64 {
    let least = problem.least.max(1);
    let most = problem.most.min(problem.bins);
    let has = |bin: &usize| lines.binary_search(bin).is_ok();
    let gaps: Vec<usize> = lines.windows(2).map(|w| w[1] - w[0]).collect();
    if gaps.is_empty()
        || !problem.observed.iter().all(has)
        || gaps.iter().any(|g| !(least..=most).contains(g))
    {
        return f64::NEG_INFINITY;
    }
    let centre = |bin: usize| bin as f64 + 0.5;
    let first = |g: usize| spacing.first.at(g as f64 / problem.size) / g as f64;
    let border = |x: usize| spacing.border.at(centre(x) / gaps[0] as f64) / centre(x);
    let all_gaps = (least..=most).filter(|&g| g < problem.bins);
    let all_positions = 0..problem.bins - gaps[0];
    let mut log = (first(gaps[0]) / all_gaps.map(first).sum::<f64>()).ln();
    log += (border(lines[0]) / all_positions.map(border).sum::<f64>()).ln();
    for (index, &line) in lines.iter().enumerate() {
        if problem.observed.binary_search(&line).is_err() {
            log += problem.evidence[line].ln();
        }
        if index == 0 {
            continue;
        }
        let gap = gaps[index - 1] as f64;
        let open: Vec<usize> = (least..=most).filter(|g| line + g < problem.bins).collect();
        let left = problem.bins as f64 - centre(line);
        let end = if open.is_empty() {
            1.0
        } else {
            spacing.ending.at(left / gap)
        };
        let share = |g: usize| spacing.ratio.at(g as f64 / gap) / g as f64;
        log += match gaps.get(index) {
            None => end.ln(),
            Some(&next) => {
                let total: f64 = open.iter().map(|&g| share(g)).sum();
                ((1.0 - end) * share(next) / total).ln()
            }
        };
    }
    log
}

//! Axes: range, scale, ticks.

/// One axis of a chart.
#[derive(Debug, Clone, Default)]
pub struct Scale {
    label: String,
    log: bool,
    range: Option<(f64, f64)>,
    ticks: Option<Vec<(f64, String)>>,
    zero: bool,
}

impl Scale {
    /// A linear axis that fits the data.
    pub fn new(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            ..Self::default()
        }
    }

    /// A logarithmic axis; values at or below zero are left out of the picture.
    pub fn log(mut self) -> Self {
        self.log = true;
        self
    }

    /// Fixes the range.
    pub fn range(mut self, from: f64, to: f64) -> Self {
        self.range = Some((from, to));
        self
    }

    /// Starts at zero, or ends there when all values are negative.
    pub fn from_zero(mut self) -> Self {
        self.zero = true;
        self
    }

    /// Fixes the ticks and what they say.
    pub fn ticks(mut self, ticks: Vec<(f64, String)>) -> Self {
        self.ticks = Some(ticks);
        self
    }

    pub(super) fn label(&self) -> &str {
        &self.label
    }

    /// The axis over given data.
    pub(super) fn fit(&self, values: impl Iterator<Item = f64>) -> Fitted {
        let keep = |v: &f64| v.is_finite() && (!self.log || *v > 0.0);
        let (mut low, mut high) = values
            .filter(keep)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
        if low > high {
            (low, high) = if self.log { (1.0, 10.0) } else { (0.0, 1.0) };
        }
        if self.log {
            (low, high) = (low.log10(), high.log10());
        }
        if self.zero && !self.log {
            (low, high) = (low.min(0.0), high.max(0.0));
        }
        let pad = match high - low {
            d if d > 0.0 => 0.05 * d,
            _ if self.log => 0.3,
            _ => 0.5 * high.abs().max(1.0),
        };
        if !(self.zero && high == 0.0 && low < 0.0) {
            high += pad;
        }
        if !(self.zero && low == 0.0) {
            low -= pad;
        }
        if let Some((from, to)) = self.range {
            (low, high) = match self.log {
                true => (from.log10(), to.log10()),
                false => (from, to),
            };
        }
        let ticks = match &self.ticks {
            Some(ticks) => ticks
                .iter()
                .map(|(v, text)| (if self.log { v.log10() } else { *v }, text.clone()))
                .collect(),
            None if self.log => log_ticks(low, high),
            None => linear_ticks(low, high),
        };
        let slack = 1e-9 * (high - low);
        Fitted {
            log: self.log,
            low,
            high,
            ticks: ticks
                .into_iter()
                .filter(|(v, _)| *v >= low - slack && *v <= high + slack)
                .collect(),
        }
    }
}

/// An axis with its range, in the axis's own coordinate (a decimal logarithm when logarithmic).
#[derive(Debug, Clone)]
pub(crate) struct Fitted {
    log: bool,
    low: f64,
    high: f64,
    /// Place (0 to 1 after [`Fitted::share`]) and text of each tick, in the axis's own coordinate.
    ticks: Vec<(f64, String)>,
}

impl Fitted {
    /// The place of a value, 0 at the start of the axis and 1 at its end, clamped a little outside; `None` if it cannot
    /// be shown.
    pub(crate) fn place(&self, value: f64) -> Option<f64> {
        let value = match self.log {
            true if value <= 0.0 => return None,
            true => value.log10(),
            false => value,
        };
        value.is_finite().then(|| self.share(value))
    }

    fn share(&self, own: f64) -> f64 {
        ((own - self.low) / (self.high - self.low)).clamp(-0.001, 1.001)
    }

    /// Place and text of each tick.
    pub(crate) fn ticks(&self) -> impl Iterator<Item = (f64, &str)> {
        self.ticks
            .iter()
            .map(|(v, text)| (self.share(*v), text.as_str()))
    }
}

fn linear_ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let step = nice((high - low) / 5.0);
    let digits = (-step.log10().floor()).max(0.0) as usize;
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    (first..=last)
        .map(|i| {
            let value = i as f64 * step;
            (value, thousands(value, digits))
        })
        .collect()
}

/// 1, 2 or 5 times a power of ten, near `step`.
fn nice(step: f64) -> f64 {
    let power = 10f64.powf(step.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|f| f * power >= step * 0.95)
        .unwrap_or(10.0);
    factor * power
}

fn log_ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let factors: &[f64] = match high - low {
        d if d > 2.5 => &[1.0],
        d if d > 1.2 => &[1.0, 3.0],
        _ => &[1.0, 2.0, 3.0, 5.0],
    };
    let decades = low.floor() as i32..=high.ceil() as i32;
    let every = ((high - low) / 7.0).ceil().max(1.0) as i32;
    let ticks: Vec<_> = decades
        .filter(|decade| decade % every == 0)
        .flat_map(|decade| factors.iter().map(move |f| (decade, f)))
        .map(|(decade, factor)| {
            let value = factor * 10f64.powi(decade);
            (value.log10(), plain(value))
        })
        .filter(|(v, _)| *v >= low && *v <= high)
        .collect();
    match ticks.len() {
        0..=1 => linear_ticks(10f64.powf(low), 10f64.powf(high))
            .into_iter()
            .filter(|(v, _)| *v > 0.0)
            .map(|(v, text)| (v.log10(), text))
            .collect(),
        _ => ticks,
    }
}

fn plain(value: f64) -> String {
    match value {
        v if !(1e-4..1e7).contains(&v) => format!("{v:e}"),
        v if v >= 1.0 => thousands(v, 0),
        v => format!("{v:.*}", (-v.log10()).ceil() as usize),
    }
}

/// A number with thin groups of three digits from ten thousand on.
pub(super) fn thousands(value: f64, digits: usize) -> String {
    let text = format!("{:.digits$}", value.abs());
    let (whole, rest) = text
        .split_once('.')
        .map_or((text.as_str(), None), |(w, r)| (w, Some(r)));
    let mut grouped = String::new();
    for (i, c) in whole.chars().enumerate() {
        if i > 0 && whole.len() > 4 && (whole.len() - i) % 3 == 0 {
            grouped.push(',');
        }
        grouped.push(c);
    }
    let sign = match value < 0.0 && text.chars().any(|c| c.is_ascii_digit() && c != '0') {
        true => "\u{2212}",
        false => "",
    };
    match rest {
        Some(rest) => format!("{sign}{grouped}.{rest}"),
        None => format!("{sign}{grouped}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_inside_the_range() {
        let fitted = Scale::new("").fit([3.0, 47.0].into_iter());
        let texts: Vec<_> = fitted.ticks().map(|(_, t)| t.to_string()).collect();
        assert_eq!(texts, ["10", "20", "30", "40"]);
        let fitted = Scale::new("").log().fit([50.0, 20_000.0].into_iter());
        let texts: Vec<_> = fitted.ticks().map(|(_, t)| t.to_string()).collect();
        assert_eq!(texts, ["100", "1000", "10,000"]);
    }

    #[test]
    fn flat_empty_and_wild_data_still_give_an_axis() {
        for data in [vec![], vec![4.0, 4.0], vec![f64::NAN], vec![-1e300, 1e300]] {
            for scale in [
                Scale::new(""),
                Scale::new("").log(),
                Scale::new("").from_zero(),
            ] {
                let fitted = scale.fit(data.iter().copied());
                assert!(fitted.low < fitted.high);
                assert!(fitted.ticks().all(|(p, _)| (-0.01..=1.01).contains(&p)));
            }
        }
    }
}
